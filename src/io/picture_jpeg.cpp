#include "io/picture_jpeg.h"

#include <turbojpeg.h>

#include <memory>

#include "arris/error.h"
#include "io/picture_limits.h"

namespace arris {
namespace {

struct Destroy {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, Destroy>;

}  // namespace

bool is_jpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF;
}

Rgba8Image decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name) {
  const Handle handle(tjInitDecompress());
  const auto fail = [&](const std::string& what) { throw Error(Error::Kind::input, name, what); };
  if (!handle) throw Error(Error::Kind::failed, name, tjGetErrorStr2(nullptr));
  int width = 0, height = 0, subsampling = 0, colors = 0;
  if (tjDecompressHeader3(handle.get(), bytes.data(), bytes.size(), &width, &height, &subsampling,
                          &colors) != 0) {
    fail(std::string("is not a readable JPEG: ") + tjGetErrorStr2(handle.get()));
  }
  if (width < 1 || height < 1) fail("is a corrupt or incomplete JPEG: it has no picture size");
  if (colors == TJCS_CMYK || colors == TJCS_YCCK) fail("is a CMYK JPEG; save it as RGB");
  check_picture_size({width, height, 4}, bytes.size(), name);

  Rgba8Image image{width, height, {}};
  image.texels.resize(std::size_t(width) * std::size_t(height));
  // A warning means bytes that are missing or make no sense: such a picture is not what its maker
  // saw.
  constexpr int kFlags = TJFLAG_STOPONWARNING | TJFLAG_LIMITSCANS | TJFLAG_ACCURATEDCT;
  if (tjDecompress2(handle.get(), bytes.data(), bytes.size(), image.texels.data()->data(), width, 0,
                    height, TJPF_RGBA, kFlags) != 0) {
    fail(std::string("is a corrupt or incomplete JPEG: ") + tjGetErrorStr2(handle.get()));
  }
  return image;
}

std::vector<std::uint8_t> encode_jpeg(const Samples8& image, int quality) {
  const Handle handle(tjInitCompress());
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  const bool grey = image.channels == 1;
  const bool ok =
      handle && tjCompress2(handle.get(), image.samples.data(), image.width_px, 0, image.height_px,
                            grey ? TJPF_GRAY : TJPF_RGB, &buffer, &size,
                            grey ? TJSAMP_GRAY : TJSAMP_444, quality, TJFLAG_ACCURATEDCT) == 0;
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(buffer, tjFree);
  if (!ok) throw Error(Error::Kind::failed, "JPEG", tjGetErrorStr2(handle.get()));
  return {buffer, buffer + size};
}

}  // namespace arris
