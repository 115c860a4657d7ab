// libpng reports errors by longjmp. Every call into it happens inside a step: a function without
// C++ objects of its own, run by guarded(); everything that owns memory lives outside, in the
// caller.
#include "io/picture_png.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>

#include "arris/error.h"
#include "io/picture_limits.h"

namespace arris {
namespace {

constexpr std::size_t kSignatureBytes = 8;

struct Message {
  std::array<char, 200> text{};
};

[[noreturn]] void on_error(png_structp png, png_const_charp text) {
  auto* message = static_cast<Message*>(png_get_error_ptr(png));
  std::strncpy(message->text.data(), text, message->text.size() - 1);
  png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}  // about chunks that don't change the pixels

// ---- reading

struct Reader {
  std::span<const std::uint8_t> bytes;
  std::size_t position = 0;
  int depth = 8;  // wanted
  Message message;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::int64_t width = 0, height = 0;
  std::vector<png_bytep> rows;

  Reader(std::span<const std::uint8_t> file, int wanted_depth) : bytes(file), depth(wanted_depth) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &message, on_error, on_warning);
    if (png != nullptr) info = png_create_info_struct(png);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void read_bytes(png_structp png, png_bytep out, std::size_t count) {
  auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
  if (count > reader->bytes.size() - reader->position) png_error(png, "the file ends too early");
  std::memcpy(out, reader->bytes.data() + reader->position, count);
  reader->position += count;
}

void read_header(Reader& r) {
  png_set_read_fn(r.png, &r, read_bytes);
  png_set_user_limits(r.png, kMaxPictureSide, kMaxPictureSide);
  png_read_info(r.png, r.info);
  r.width = png_get_image_width(r.png, r.info);
  r.height = png_get_image_height(r.png, r.info);
  png_set_expand(r.png);
  png_set_gray_to_rgb(r.png);
  if (r.depth == 16) {
    png_set_expand_16(r.png);
    png_set_swap(r.png);
  } else {
    png_set_scale_16(r.png);
  }
  png_set_add_alpha(r.png, r.depth == 16 ? 0xFFFF : 0xFF, PNG_FILLER_AFTER);
  png_set_interlace_handling(r.png);
  png_read_update_info(r.png, r.info);
}

void read_pixels(Reader& r) {
  png_read_image(r.png, r.rows.data());
  png_read_end(r.png, nullptr);
}

bool guarded(Reader& reader, void (*step)(Reader&)) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;  // NOLINT: libpng's way
  step(reader);
  return true;
}

template <class Sample>
struct Decoded {
  int width_px = 0, height_px = 0;
  std::vector<std::array<Sample, 4>> pixels;
};

template <class Sample>
Decoded<Sample> decode(std::span<const std::uint8_t> bytes, const std::string& name) {
  Reader reader(bytes, sizeof(Sample) * 8);
  const auto fail = [&] {
    throw Error(Error::Kind::input, name,
                std::string("is a corrupt or incomplete PNG: ") + reader.message.text.data());
  };
  if (reader.info == nullptr) throw Error(Error::Kind::failed, name, "libpng has no memory");
  if (!guarded(reader, read_header)) fail();
  check_picture_size({reader.width, reader.height, 4 * sizeof(Sample)}, bytes.size(), name);
  Decoded<Sample> out{int(reader.width), int(reader.height), {}};
  out.pixels.resize(std::size_t(reader.width) * std::size_t(reader.height));
  for (std::int64_t y = 0; y < reader.height; ++y) {
    reader.rows.push_back(reinterpret_cast<png_bytep>(&out.pixels[std::size_t(y * reader.width)]));
  }
  if (!guarded(reader, read_pixels)) fail();
  return out;
}

// ---- writing

struct Writer {
  const Samples8& image;
  std::vector<std::uint8_t> bytes;
  Message message;
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::vector<png_bytep> rows;

  explicit Writer(const Samples8& source) : image(source) {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &message, on_error, on_warning);
    if (png != nullptr) info = png_create_info_struct(png);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

void write_bytes(png_structp png, png_bytep data, std::size_t count) noexcept {
  auto& bytes = static_cast<Writer*>(png_get_io_ptr(png))->bytes;
  bytes.insert(bytes.end(), data, data + count);
}
void flush_bytes(png_structp) {}

void write_picture(Writer& w) {
  const int type = w.image.channels == 1   ? PNG_COLOR_TYPE_GRAY
                   : w.image.channels == 3 ? PNG_COLOR_TYPE_RGB
                                           : PNG_COLOR_TYPE_RGB_ALPHA;
  png_set_write_fn(w.png, &w, write_bytes, flush_bytes);
  png_set_IHDR(w.png, w.info, png_uint_32(w.image.width_px), png_uint_32(w.image.height_px), 8,
               type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(w.png, w.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(w.png, w.info);
  png_write_image(w.png, w.rows.data());
  png_write_end(w.png, nullptr);
}

bool guarded(Writer& writer, void (*step)(Writer&)) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;  // NOLINT: libpng's way
  step(writer);
  return true;
}

}  // namespace

bool is_png(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kSignatureBytes && png_sig_cmp(bytes.data(), 0, kSignatureBytes) == 0;
}

Rgba8Image decode_png(std::span<const std::uint8_t> bytes, const std::string& name) {
  Decoded<std::uint8_t> decoded = decode<std::uint8_t>(bytes, name);
  return {decoded.width_px, decoded.height_px, std::move(decoded.pixels)};
}

Rgba16Image decode_png16(std::span<const std::uint8_t> bytes, const std::string& name) {
  Decoded<std::uint16_t> decoded = decode<std::uint16_t>(bytes, name);
  return {decoded.width_px, decoded.height_px, std::move(decoded.pixels)};
}

std::vector<std::uint8_t> encode_png(const Samples8& image) {
  Writer writer(image);
  if (writer.info == nullptr) throw Error(Error::Kind::failed, "PNG", "libpng has no memory");
  const std::size_t row_bytes = std::size_t(image.width_px) * std::size_t(image.channels);
  for (std::size_t y = 0; y < std::size_t(image.height_px); ++y) {
    writer.rows.push_back(const_cast<png_bytep>(image.samples.data() + y * row_bytes));
  }
  if (!guarded(writer, write_picture)) {
    throw Error(Error::Kind::failed, "PNG", writer.message.text.data());
  }
  return std::move(writer.bytes);
}

}  // namespace arris
