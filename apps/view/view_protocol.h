// view_protocol.h — what the viewer's page says, as data (docs/view-protocol.md)
// What       parse_message() reads one text message of a client
// Errors     arris::Error, kind input, for all that is not in the protocol: what is wrong and what is expected
// Guarantee  any bytes give a message or an Error; numbers of a message are finite and within their limits
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "arris/edge_point.h"
#include "arris/math.h"
#include "arris/render.h"
#include "arris/scene.h"

namespace arris::view {

inline constexpr std::size_t kMaxMessageBytes = std::size_t(64) << 10;

struct PictureSize {
  int width_px = 1280, height_px = 720;
  friend bool operator==(const PictureSize&, const PictureSize&) = default;
};
inline std::int64_t area_of(PictureSize size) {
  return std::int64_t(size.width_px) * size.height_px;
}
inline constexpr PictureSize kLeastSize{64, 64}, kMostSize{3840, 2160};

// Whose lights: the file's, or those of render/staging.h.
enum class LightChoice { file, studio, sky, white };

struct Hello {
  PictureSize size;
};
struct Ack {
  std::uint32_t frame = 0;
};
struct SetSize {
  PictureSize size;
};
struct SetCamera {
  Camera camera;
};
struct FrameView {
  enum class From { here, first, front, right, top, iso } from = From::here;
};
// What is empty stays as it is.
struct SetRounding {
  std::optional<RoundMethod> method;
  std::optional<Radius> radius;
  std::optional<RoundEdges> edges;
  std::optional<double> min_angle;
};
struct SetObject {
  std::uint32_t id = 0;
  std::optional<bool> visible;
  std::optional<std::optional<Radius>> radius;  // empty within: the scene's
  std::optional<Affine3d> world_from_object;
};
struct Isolate {
  std::optional<std::uint32_t> id;  // empty: all are visible
};
struct SetLight {
  std::optional<LightChoice> lighting;
  std::optional<double> strength;
  std::optional<double> rotation_deg;
};
struct SetMaterial {
  std::optional<std::string> name;  // empty: the file's own
};
struct SetGround {
  bool on = true;
};
struct SetShader {
  EdgePointShader shader = EdgePointShader::gi;
};
struct Compare {
  std::optional<RoundMethod> method;  // empty: no comparison
  double split = 0.5;
};
struct SetOverlay {
  bool on = true;
};
struct Pick {
  double x = 0, y = 0;  // pixels
};
struct MakeBeam {};
struct StopBeam {};
struct SetQuality {
  int moving = 60, still = 90;
};

using MessageKind = std::variant<Hello, Ack, SetSize, SetCamera, FrameView, SetRounding, SetObject,
                                 Isolate, SetLight, SetMaterial, SetGround, SetShader, Compare,
                                 SetOverlay, Pick, MakeBeam, StopBeam, SetQuality>;

struct ClientMessage {
  std::optional<std::uint32_t> seq;
  MessageKind what;
};

ClientMessage parse_message(std::string_view text);

// What can be seen of a text that parse_message() refuses: for the answer.
struct MessageHead {
  std::optional<std::uint32_t> seq;
  std::string type;  // empty: none that is known
};
MessageHead find_head(std::string_view text);

const char* type_of(const MessageKind& what);

const char* name_of(LightChoice choice);
const char* name_of(EdgePointShader shader);
const char* name_of(RoundMethod method);
const char* name_of(RoundEdges edges);

}  // namespace arris::view
