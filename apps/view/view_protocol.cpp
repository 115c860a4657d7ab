#include "view/view_protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "arris/error.h"
#include "base/nearest_name.h"
#include "base/utf8_text.h"
#include "scene/limits.h"
#include "scene/rounding_text.h"

namespace arris::view {
namespace {

using nlohmann::json;

constexpr double kMostStrength = 1e6, kMostTurnDeg = 1e6, kMostPixels = 1e5;
constexpr std::size_t kMostNameBytes = 256;

template <class T>
using Names = std::vector<std::pair<std::string, T>>;

const Names<RoundMethod> kMethods{{"exact", RoundMethod::exact},
                                  {"shader", RoundMethod::shader},
                                  {"mesh", RoundMethod::mesh},
                                  {"none", RoundMethod::none}};
const Names<RoundEdges> kEdges{
    {"convex", RoundEdges::convex}, {"concave", RoundEdges::concave}, {"both", RoundEdges::both}};
const Names<LightChoice> kLights{{"studio", LightChoice::studio},
                                 {"sky", LightChoice::sky},
                                 {"white", LightChoice::white},
                                 {"file", LightChoice::file}};
const Names<EdgePointShader> kShaders{{"direct", EdgePointShader::direct},
                                      {"glossy", EdgePointShader::glossy},
                                      {"gi", EdgePointShader::gi}};
const Names<FrameView::From> kViews{{"first", FrameView::From::first},
                                    {"front", FrameView::From::front},
                                    {"right", FrameView::From::right},
                                    {"top", FrameView::From::top},
                                    {"iso", FrameView::From::iso}};

template <class T>
const char* find_name(const Names<T>& names, T value) {
  const auto row = std::ranges::find(names, value, &std::pair<std::string, T>::second);
  return row == names.end() ? "" : row->first.c_str();
}

template <class T>
std::vector<std::string> names_in(const Names<T>& names) {
  std::vector<std::string> out;
  for (const auto& [name, value] : names) out.push_back(name);
  return out;
}

struct Range {
  double least, most;
};
constexpr Range kCoordinate{-kMaxCoordinate, kMaxCoordinate};

// One message's keys.
class Keys {
 public:
  Keys(const json& object, std::string type) : object_(object), type_(std::move(type)) {}

  // Null is there, too.
  [[nodiscard]] const json* find(const char* key) const {
    const auto found = object_.find(key);
    return found == object_.end() ? nullptr : &*found;
  }
  [[nodiscard]] bool is_null(const char* key) const { return at(key).is_null(); }
  [[nodiscard]] const json& at(const char* key) const {
    const json* value = find(key);
    if (value == nullptr) fail(key, "is missing");
    return *value;
  }

  [[nodiscard]] double number(const char* key, Range range) const {
    return number_in(at(key), key, range);
  }
  [[nodiscard]] std::uint32_t whole(const char* key) const {
    const double value = number(key, {0, double(std::numeric_limits<std::uint32_t>::max())});
    if (value != std::floor(value)) fail(key, "must be a whole number");
    return std::uint32_t(value);
  }
  [[nodiscard]] bool flag(const char* key) const {
    if (!at(key).is_boolean()) fail(key, "must be true or false");
    return at(key).get<bool>();
  }
  [[nodiscard]] std::string text(const char* key) const {
    if (!at(key).is_string()) fail(key, "must be text");
    const auto& value = at(key).get_ref<const std::string&>();
    if (value.size() > kMostNameBytes) fail(key, "is too long");
    return value;
  }
  template <class T>
  [[nodiscard]] T choice(const char* key, const Names<T>& names) const {
    const std::string given = text(key);
    for (const auto& [name, value] : names) {
      if (name == given) return value;
    }
    fail(key, fmt::format("{} is not known; use one of {}{}", in_quotes(given),
                          fmt::join(names_in(names), ", "), did_you_mean(given, names_in(names))));
  }
  [[nodiscard]] std::vector<double> numbers(const char* key, std::size_t count, Range range) const {
    return numbers_in(at(key), key, count, range);
  }
  [[nodiscard]] Vec3d vector(const char* key) const {
    const std::vector<double> v = numbers(key, 3, kCoordinate);
    return {v[0], v[1], v[2]};
  }
  [[nodiscard]] Affine3d matrix(const char* key) const {
    const json& rows = at(key);
    if (!rows.is_array() || rows.size() != 4) fail(key, "must be 4 rows of 4 numbers");
    std::array<std::vector<double>, 4> m;
    for (std::size_t i = 0; i < 4; ++i) m[i] = numbers_in(rows[i], key, 4, kCoordinate);
    if (m[3] != std::vector<double>{0, 0, 0, 1}) fail(key, "must have the last row [0, 0, 0, 1]");
    const auto column = [&](std::size_t i) { return Vec3d(m[0][i], m[1][i], m[2][i]); };
    const Affine3d out{{column(0), column(1), column(2)}, column(3)};
    if (!is_invertible(out.linear)) fail(key, "flattens the object");
    return out;
  }
  // A length, "auto" or "12%".
  [[nodiscard]] Radius radius(const char* key) const {
    constexpr double kLeast = 1e-30;
    if (!at(key).is_string()) return number(key, {kLeast, kMaxCoordinate});
    const auto settings = parse_rounding_text(text(key));
    if (!settings || settings->method == RoundMethod::none) {
      fail(key, R"(must be a length above 0, "auto" or a part of the inradius such as "10%")");
    }
    return settings->radius;
  }
  [[nodiscard]] PictureSize size(const char* key) const {
    const std::vector<double> v = numbers(key, 2, {0, kMostPixels});
    const auto within = [](double value, int least, int most) {
      return value == std::floor(value) && value >= least && value <= most;
    };
    if (!within(v[0], kLeastSize.width_px, kMostSize.width_px) ||
        !within(v[1], kLeastSize.height_px, kMostSize.height_px)) {
      fail(key, fmt::format("must be {} to {} pixels wide and {} to {} high", kLeastSize.width_px,
                            kMostSize.width_px, kLeastSize.height_px, kMostSize.height_px));
    }
    return {int(v[0]), int(v[1])};
  }

  [[noreturn]] void fail(const char* key, const std::string& what) const {
    throw Error(Error::Kind::input, fmt::format("message {}", in_quotes(type_)),
                fmt::format("\"{}\" {}", key, what));
  }

 private:
  [[nodiscard]] double number_in(const json& value, const char* key, Range range) const {
    if (!value.is_number()) fail(key, "must be a number");
    const auto number = value.get<double>();
    if (!(number >= range.least && number <= range.most)) {
      fail(key, fmt::format("must lie within {:g} and {:g}", range.least, range.most));
    }
    return number;
  }
  [[nodiscard]] std::vector<double> numbers_in(const json& value, const char* key,
                                               std::size_t count, Range range) const {
    if (!value.is_array() || value.size() != count) {
      fail(key, fmt::format("must be {} numbers", count));
    }
    std::vector<double> out;
    for (const json& each : value) out.push_back(number_in(each, key, range));
    return out;
  }

  const json& object_;
  std::string type_;
};

SetCamera parse_camera(const Keys& keys) {
  return {{keys.vector("position"), keys.vector("target"), keys.vector("up"),
           keys.number("fov", {kMinFovDeg, kMaxFovDeg})}};
}

FrameView parse_frame_view(const Keys& keys) {
  if (keys.find("direction") == nullptr || keys.is_null("direction")) return {};
  return {keys.choice("direction", kViews)};
}

SetRounding parse_rounding(const Keys& keys) {
  SetRounding out;
  if (keys.find("method") != nullptr) out.method = keys.choice("method", kMethods);
  if (keys.find("radius") != nullptr) out.radius = keys.radius("radius");
  if (keys.find("edges") != nullptr) out.edges = keys.choice("edges", kEdges);
  if (keys.find("min_angle") != nullptr) {
    out.min_angle = radians(keys.number("min_angle", {0, 180}));
  }
  return out;
}

SetObject parse_object(const Keys& keys) {
  SetObject out;
  out.id = keys.whole("id");
  if (keys.find("visible") != nullptr) out.visible = keys.flag("visible");
  if (keys.find("matrix") != nullptr) out.world_from_object = keys.matrix("matrix");
  if (keys.find("radius") != nullptr) {
    out.radius.emplace();
    if (!keys.is_null("radius")) *out.radius = keys.radius("radius");
  }
  return out;
}

Isolate parse_isolate(const Keys& keys) {
  if (keys.is_null("id")) return {};
  return {keys.whole("id")};
}

SetLight parse_light(const Keys& keys) {
  SetLight out;
  if (keys.find("lighting") != nullptr) out.lighting = keys.choice("lighting", kLights);
  if (keys.find("strength") != nullptr) out.strength = keys.number("strength", {0, kMostStrength});
  if (keys.find("rotation") != nullptr) {
    out.rotation_deg = std::remainder(keys.number("rotation", {-kMostTurnDeg, kMostTurnDeg}), 360);
  }
  return out;
}

Compare parse_compare(const Keys& keys) {
  Compare out;
  if (!keys.is_null("method")) out.method = keys.choice("method", kMethods);
  if (keys.find("split") != nullptr) out.split = keys.number("split", {0, 1});
  return out;
}

Pick parse_pick(const Keys& keys) {
  const std::vector<double> at = keys.numbers("at", 2, {-kMostPixels, kMostPixels});
  return {at[0], at[1]};
}

SetQuality parse_quality(const Keys& keys) {
  constexpr Range kRange{30, 95};
  return {int(keys.number("moving", kRange)), int(keys.number("still", kRange))};
}

using Parse = MessageKind (*)(const Keys& keys);

// In the order of MessageKind.
const Names<Parse> kParsers{
    {"hello", [](const Keys& keys) -> MessageKind { return Hello{keys.size("size")}; }},
    {"ack", [](const Keys& keys) -> MessageKind { return Ack{keys.whole("frame")}; }},
    {"size", [](const Keys& keys) -> MessageKind { return SetSize{keys.size("size")}; }},
    {"camera", [](const Keys& keys) -> MessageKind { return parse_camera(keys); }},
    {"frame_view", [](const Keys& keys) -> MessageKind { return parse_frame_view(keys); }},
    {"rounding", [](const Keys& keys) -> MessageKind { return parse_rounding(keys); }},
    {"object", [](const Keys& keys) -> MessageKind { return parse_object(keys); }},
    {"isolate", [](const Keys& keys) -> MessageKind { return parse_isolate(keys); }},
    {"light", [](const Keys& keys) -> MessageKind { return parse_light(keys); }},
    {"material",
     [](const Keys& keys) -> MessageKind {
       if (keys.is_null("name")) return SetMaterial{};
       return SetMaterial{keys.text("name")};
     }},
    {"ground", [](const Keys& keys) -> MessageKind { return SetGround{keys.flag("on")}; }},
    {"shader",
     [](const Keys& keys) -> MessageKind { return SetShader{keys.choice("name", kShaders)}; }},
    {"compare", [](const Keys& keys) -> MessageKind { return parse_compare(keys); }},
    {"overlay", [](const Keys& keys) -> MessageKind { return SetOverlay{keys.flag("on")}; }},
    {"pick", [](const Keys& keys) -> MessageKind { return parse_pick(keys); }},
    {"beam", [](const Keys&) -> MessageKind { return MakeBeam{}; }},
    {"beam_stop", [](const Keys&) -> MessageKind { return StopBeam{}; }},
    {"quality", [](const Keys& keys) -> MessageKind { return parse_quality(keys); }},
};

[[noreturn]] void refuse(const std::string& what) {
  throw Error(Error::Kind::input, "message", what);
}

// Depth is bounded while reading: a message of brackets makes no tree of 64 Ki levels.
json parse_json(std::string_view text) {
  constexpr int kMostDepth = 4;
  bool too_deep = false;
  const auto watch = [&](int depth, json::parse_event_t, json&) {
    too_deep = too_deep || depth > kMostDepth;
    return !too_deep;
  };
  json value = json::parse(text.begin(), text.end(), watch, false);
  if (too_deep) refuse("is nested too deeply");
  if (value.is_discarded()) refuse("is no JSON");
  if (!value.is_object()) refuse("must be a JSON object");
  return value;
}

}  // namespace

ClientMessage parse_message(std::string_view text) {
  if (text.size() > kMaxMessageBytes) {
    refuse(fmt::format("is longer than {} bytes", kMaxMessageBytes));
  }
  const json object = parse_json(text);
  const auto type = object.find("type");
  if (type == object.end() || !type->is_string()) refuse("must have a \"type\"");
  const auto& name = type->get_ref<const std::string&>();
  const auto row = std::ranges::find(kParsers, name, &std::pair<std::string, Parse>::first);
  if (row == kParsers.end()) {
    const std::string given = name.substr(0, kMostNameBytes);
    refuse(fmt::format("has the type {}, which is not known{}", in_quotes(given),
                       did_you_mean(given, names_in(kParsers))));
  }
  const Keys keys(object, name);
  ClientMessage message;
  if (keys.find("seq") != nullptr) message.seq = keys.whole("seq");
  message.what = row->second(keys);
  return message;
}

MessageHead find_head(std::string_view text) {
  MessageHead head;
  if (text.size() > kMaxMessageBytes) return head;
  try {
    const json object = parse_json(text);
    const Keys keys(object, "");
    if (keys.find("type") != nullptr) {
      std::string type = keys.text("type");
      if (std::ranges::count(names_in(kParsers), type) > 0) head.type = std::move(type);
    }
    if (keys.find("seq") != nullptr) head.seq = keys.whole("seq");
  } catch (const Error&) {
  }
  return head;
}

const char* type_of(const MessageKind& what) {
  return kParsers[what.index()].first.c_str();
}

const char* name_of(LightChoice choice) {
  return find_name(kLights, choice);
}
const char* name_of(EdgePointShader shader) {
  return find_name(kShaders, shader);
}
const char* name_of(RoundMethod method) {
  return find_name(kMethods, method);
}
const char* name_of(RoundEdges edges) {
  return find_name(kEdges, edges);
}

}  // namespace arris::view
