#include "io/picture_exr.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "arris/error.h"
#include "io/header_text.h"
#include "io/picture_limits.h"

namespace arris {
namespace {

constexpr int kMaxChannels = 256;

// ---- bytes in memory for OpenEXR

class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(std::span<const std::uint8_t> bytes, const std::string& name)
      : IStream(name.c_str()), bytes_(bytes) {}

  bool isMemoryMapped() const override { return false; }
  bool read(char out[], int count) override {
    if (count < 0 || std::uint64_t(count) > bytes_.size() - position_) {
      throw std::runtime_error("the file ends too early");
    }
    std::memcpy(out, bytes_.data() + position_, std::size_t(count));
    position_ += std::uint64_t(count);
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("the file ends too early");
    position_ = position;
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::uint64_t position_ = 0;
};

class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : OStream("EXR") {}

  void write(const char data[], int count) override {
    const std::size_t end = position_ + std::size_t(count);
    if (end > bytes_.size()) bytes_.resize(end);
    std::memcpy(bytes_.data() + position_, data, std::size_t(count));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = std::size_t(position); }

  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
  std::size_t position_ = 0;
};

// ---- channels and layers

// The parts of one image: planes of single channels, in the order of its channels.
struct Planes {
  std::string layer;  // empty: the colour
  std::vector<std::string> channels;
};

bool take_components(std::vector<std::string>& names, const std::string& prefix,
                     const std::string& components, std::vector<Planes>& out) {
  Planes planes{prefix.empty() ? "" : prefix.substr(0, prefix.size() - 1), {}};
  for (const char component : components) {
    planes.channels.push_back(prefix + component);
    if (std::find(names.begin(), names.end(), planes.channels.back()) == names.end()) return false;
  }
  std::erase_if(names, [&](const std::string& name) {
    return std::find(planes.channels.begin(), planes.channels.end(), name) != planes.channels.end();
  });
  out.push_back(std::move(planes));
  return true;
}

// "n.R", "n.G", "n.B" become one image; what belongs to no such set, an image of its own.
std::vector<Planes> group_channels(std::vector<std::string> names) {
  std::vector<Planes> groups;
  if (!take_components(names, "", "RGB", groups)) take_components(names, "", "Y", groups);
  std::vector<std::string> prefixes;
  for (const std::string& name : names) {
    const std::size_t dot = name.rfind('.');
    if (dot != std::string::npos && dot > 0) prefixes.push_back(name.substr(0, dot + 1));
  }
  prefixes.erase(std::unique(prefixes.begin(), prefixes.end()), prefixes.end());
  for (const std::string& prefix : prefixes) {
    if (take_components(names, prefix, "RGBA", groups)) continue;
    if (take_components(names, prefix, "RGB", groups)) continue;
    take_components(names, prefix, "XYZ", groups);
  }
  for (const std::string& name : names) groups.push_back({name == "A" ? "alpha" : name, {name}});
  return groups;
}

// ---- reading

// OpenEXR takes memory for an attribute of unknown type before it reads it: up to 2 GiB, whatever the file holds.
// Layout: OpenEXR File Layout, "Header"; what does not follow it is left to OpenEXR to refuse.
void check_attribute_sizes(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kMagicAndVersion = 8;
  constexpr std::uint8_t kMultiPart = 0x10;  // of the version's second byte
  if (bytes.size() < kMagicAndVersion) return;
  const bool is_multi_part = (bytes[5] & kMultiPart) != 0;
  std::size_t at = kMagicAndVersion;
  const auto read_name = [&] {
    const auto* const begin = bytes.data() + at;
    const auto* const end = std::find(begin, bytes.data() + bytes.size(), std::uint8_t(0));
    at = std::min(bytes.size(), at + std::size_t(end - begin) + 1);
    return std::string(begin, end);
  };
  bool is_first = true;  // of a header
  while (at < bytes.size()) {
    const std::string name = read_name();
    if (name.empty()) {
      if (is_first || !is_multi_part) return;
      is_first = true;
      continue;
    }
    is_first = false;
    read_name();  // its type
    std::uint32_t size = 0;
    if (bytes.size() - at < sizeof(size)) return;
    std::memcpy(&size, bytes.data() + at, sizeof(size));
    at += sizeof(size);
    if (size > bytes.size() - at) {
      throw std::runtime_error(fmt::format("attribute \"{}\" has {} bytes, but only {} follow",
                                           name, size, bytes.size() - at));
    }
    at += size;
  }
}

class Decoder {
 public:
  Decoder(std::span<const std::uint8_t> bytes, const std::string& name)
      : name_(name), file_bytes_(bytes.size()), stream_(bytes, name), file_(stream_, 0) {}

  PictureFile decode() {
    const std::vector<Planes> groups = group_channels(checked_channels());
    PictureFile out;
    Imf::FrameBuffer frame;
    // All images exist before the first slice points into one.
    for (const Planes& group : groups) {
      Image image(width_, height_, int(group.channels.size()));
      if (group.layer.empty()) {
        out.picture.color = std::move(image);
      } else {
        out.picture.layers.push_back({group.layer, std::move(image)});
      }
    }
    std::size_t layer = 0;
    for (const Planes& group : groups) {
      Image& image = group.layer.empty() ? out.picture.color : out.picture.layers[layer++].image;
      insert_slices(frame, image, group.channels);
    }
    file_.setFrameBuffer(frame);
    const Imath::Box2i& window = file_.header().dataWindow();
    file_.readPixels(window.min.y, window.max.y);
    if (out.picture.color.channels == 1) out.picture.color = repeat_channel(out.picture.color);
    if (out.picture.color.channels == 0) take_first_layer_as_color(out.picture);
    out.attributes = string_attributes();
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Error::Kind::input, name_, what);
  }

  std::vector<std::string> checked_channels() {
    const Imf::Header& header = file_.header();
    std::vector<std::string> names;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
      if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
        fail("has subsampled (luminance and chroma) channels; save it as RGB");
      }
      names.emplace_back(it.name());
    }
    if (names.empty()) fail("is an EXR without channels");
    if (int(names.size()) > kMaxChannels) {
      fail(fmt::format("has {} channels; at most {} are read", names.size(), kMaxChannels));
    }
    const Imath::Box2i& window = header.dataWindow();
    const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
    const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
    check_picture_size({width, height, std::int64_t(names.size()) * 4}, file_bytes_, name_);
    width_ = int(width);
    height_ = int(height);
    return names;
  }

  void insert_slices(Imf::FrameBuffer& frame, Image& image,
                     const std::vector<std::string>& channels) const {
    const Imath::Box2i& window = file_.header().dataWindow();
    const std::size_t pixel = sizeof(float) * channels.size();
    const std::size_t row = pixel * std::size_t(image.width_px);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      // OpenEXR addresses pixels by their place in the data window: the base lies outside the
      // array.
      const auto first = reinterpret_cast<std::uintptr_t>(image.values.data() + c);
      const std::uintptr_t base = first - std::uintptr_t(std::int64_t(window.min.x)) * pixel -
                                  std::uintptr_t(std::int64_t(window.min.y)) * row;
      char* base_pointer = reinterpret_cast<char*>(base);  // NOLINT(performance-no-int-to-ptr)
      frame.insert(channels[c], Imf::Slice(Imf::FLOAT, base_pointer, pixel, row));
    }
  }

  static Image repeat_channel(const Image& grey) {
    Image color(grey.width_px, grey.height_px, 3);
    for (std::size_t i = 0; i < color.values.size(); ++i) color.values[i] = grey.values[i / 3];
    return color;
  }

  static void take_first_layer_as_color(Picture& picture) {
    const Image& first = picture.layers.front().image;
    picture.color = first.channels == 1 ? repeat_channel(first) : first;
    if (picture.color.channels == 4) {
      Image color(first.width_px, first.height_px, 3);
      for (std::size_t i = 0; i < color.values.size(); ++i) {
        color.values[i] = first.values[i / 3 * 4 + i % 3];
      }
      picture.color = std::move(color);
    }
  }

  Attributes string_attributes() const {
    Attributes attributes;
    for (auto it = file_.header().begin(); it != file_.header().end(); ++it) {
      const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
      if (text != nullptr) attributes.emplace_back(it.name(), text->value());
    }
    return attributes;
  }

  const std::string& name_;
  std::size_t file_bytes_;
  MemoryInput stream_;
  Imf::InputFile file_;
  int width_ = 0, height_ = 0;
};

// ---- writing

std::vector<std::string> channel_names(const std::string& layer, int channels) {
  if (channels == 1) return {layer.empty() ? "Y" : layer};
  std::vector<std::string> names;
  for (const char* component : {"R", "G", "B", "A"}) {
    if (int(names.size()) == channels) break;
    names.push_back(layer.empty() ? component : layer + "." + component);
  }
  return names;
}

void insert_image(const std::string& layer, const Image& image, Imf::Header& header,
                  Imf::FrameBuffer& frame) {
  const std::vector<std::string> names = channel_names(layer, image.channels);
  const std::size_t pixel = sizeof(float) * names.size();
  for (std::size_t c = 0; c < names.size(); ++c) {
    header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
    char* base = reinterpret_cast<char*>(const_cast<float*>(image.values.data() + c));
    frame.insert(names[c],
                 Imf::Slice(Imf::FLOAT, base, pixel, pixel * std::size_t(image.width_px)));
  }
}

}  // namespace

bool is_exr(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 4> kMagic{0x76, 0x2F, 0x31, 0x01};
  return bytes.size() >= 4 && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

namespace {

// OpenEXR's own words, without the name of the file that Arris says already:
// Cannot read image file "a.exr". Invalid display window in image header.
std::string reason_of(std::string_view text, const std::string& name) {
  constexpr std::size_t kMostBytes = 200;
  const std::string named = "file \"" + name + "\". ";
  if (const std::size_t at = text.find(named); at != std::string_view::npos) {
    text.remove_prefix(at + named.size());
  }
  while (text.ends_with('.')) text.remove_suffix(1);
  return printable(text, kMostBytes);
}

}  // namespace

PictureFile decode_exr(std::span<const std::uint8_t> bytes, const std::string& name) {
  try {
    check_attribute_sizes(bytes);
    return Decoder(bytes, name).decode();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(Error::Kind::input, name,
                "is a corrupt or incomplete EXR: " + reason_of(error.what(), name));
  }
}

std::vector<std::uint8_t> encode_exr(const Picture& picture, const Attributes& attributes) {
  try {
    Imf::Header header(picture.color.width_px, picture.color.height_px);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [name, value] : attributes) {
      header.insert(name, Imf::StringAttribute(value));
    }
    Imf::FrameBuffer frame;
    insert_image("", picture.color, header, frame);
    for (const Layer& layer : picture.layers) {
      insert_image(layer.name, layer.image, header, frame);
    }
    MemoryOutput stream;
    {
      Imf::OutputFile file(stream, header, 0);
      file.setFrameBuffer(frame);
      file.writePixels(picture.color.height_px);
    }
    return stream.take();
  } catch (const std::exception& error) {
    throw Error(Error::Kind::failed, "EXR", error.what());
  }
}

}  // namespace arris
