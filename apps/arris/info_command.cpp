#include "arris/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "arris/command_line.h"
#include "arris/commands.h"
#include "arris/console.h"
#include "arris/input.h"
#include "arris/render.h"
#include "arris/rounding.h"
#include "arris/values.h"

namespace arris::program {
namespace {

struct Findings {
  SceneReport scene;
  PrepareStats prepare;
  std::vector<std::optional<double>> fitting_radii;  // of the objects that lack room at some edge
};

// In world units.
std::optional<double> fitting_radius_of(const Scene& scene, const Object& object, double radius) {
  const Mesh& mesh = scene.meshes[object.mesh.index];
  std::vector<Vec3f> positions;
  positions.reserve(mesh.positions.size());
  for (const Vec3f& p : mesh.positions) {
    positions.emplace_back(transform_point(object.world_from_object, Vec3d(p)));
  }
  const RoundingSettings settings =
      object.rounding.value_or(scene.rounding.value_or(RoundingSettings{}));
  RoundingOptions options;
  options.radius = radius;
  options.edges = settings.edges;
  options.min_angle = settings.min_angle;
  return find_fitting_radius({positions, mesh.triangles, mesh.sharp_edges}, options, object.name);
}

const RoundingSummary* find_summary(const Findings& findings, std::size_t object) {
  for (const RoundingSummary& summary : findings.prepare.rounding) {
    if (summary.object_index == object) return &summary;
  }
  return nullptr;
}

nlohmann::ordered_json to_json(Vec3d v) {
  return {v.x, v.y, v.z};
}

nlohmann::ordered_json to_json(const EdgeCounts& e) {
  return {{"convex", e.convex}, {"concave", e.concave},   {"smooth", e.smooth},
          {"flat", e.flat},     {"boundary", e.boundary}, {"nonmanifold", e.nonmanifold}};
}

nlohmann::ordered_json to_json(const RoundingSummary& r, std::optional<double> fitting) {
  std::vector<std::string> notes;
  for (const RoundingNote& note : r.notes) notes.push_back(note.text());
  auto clamped = nlohmann::ordered_json::array();
  for (const ClampedEdge& edge : r.clamped) {
    clamped.push_back(
        {{"from", to_json(edge.from)}, {"to", to_json(edge.to)}, {"radius", edge.radius}});
  }
  return {{"radius", r.radius},
          {"edges", r.edges},
          {"corners", r.corners},
          {"notes", notes},
          {"clamped", clamped},
          {"fitting_radius", fitting ? nlohmann::ordered_json(*fitting) : nullptr}};
}

nlohmann::ordered_json to_json(const ObjectReport& o, const RoundingSummary* rounding,
                               std::optional<double> fitting) {
  nlohmann::ordered_json json{{"name", o.name}};
  if (o.csg) {
    json["csg"] = {{"primitives", o.csg->primitives},
                   {"curved", o.csg->curved},
                   {"flat_faces", o.csg->flat_faces},
                   {"operations", o.csg->operations},
                   {"depth", o.csg->depth}};
  } else {
    json.update({{"triangles", o.triangles},
                 {"vertices", o.vertices},
                 {"shells", o.shells},
                 {"edges", to_json(o.edges)},
                 {"closed", o.closed},
                 {"convex", o.convex}});
    json["inradius"] = o.inradius ? nlohmann::ordered_json(*o.inradius) : nullptr;
  }
  json["bounds"] = {{"min", to_json(o.bounds_min)}, {"max", to_json(o.bounds_max)}};
  if (!o.csg) json["degenerate_triangles"] = o.degenerate_triangles;
  json["rounding"] =
      rounding != nullptr ? to_json(*rounding, fitting) : nlohmann::ordered_json(nullptr);
  return json;
}

void print_json(const Findings& findings) {
  const SceneReport& scene = findings.scene;
  nlohmann::ordered_json json{
      {"triangles", scene.triangles},
      {"bounds", {{"min", to_json(scene.bounds_min)}, {"max", to_json(scene.bounds_max)}}},
      {"objects", nlohmann::ordered_json::array()}};
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    json["objects"].push_back(
        to_json(scene.objects[i], find_summary(findings, i), findings.fitting_radii[i]));
  }
  const auto replace = nlohmann::ordered_json::error_handler_t::replace;
  fmt::print("{}\n", json.dump(2, ' ', false, replace));
}

std::string format_bounds(Vec3d lower, Vec3d upper) {
  const Vec3d size = upper - lower;
  return fmt::format(
      "{:.6g} x {:.6g} x {:.6g}, from ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})", size.x,
      size.y, size.z, lower.x, lower.y, lower.z, upper.x, upper.y, upper.z);
}

std::string count(std::uint64_t number, const char* what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

// "2 curved, which are exact, and 1 of 12 flat faces"
std::string describe_surfaces(const CsgReport& csg) {
  const std::uint64_t flat = csg.primitives - csg.curved;
  const std::string curved =
      fmt::format("{} curved, which {} exact", csg.curved, csg.curved == 1 ? "is" : "are");
  const std::string faceted = fmt::format("{} of {}", flat, count(csg.flat_faces, "flat face"));
  if (flat == 0) return curved;
  return csg.curved == 0 ? faceted : curved + ", and " + faceted;
}

void print_csg(const ObjectReport& object) {
  const CsgReport& csg = *object.csg;
  fmt::print("  solid       {} in {}, {} deep\n", count(csg.primitives, "primitive"),
             count(csg.operations, "operation"), csg.depth);
  if (csg.primitives > 0) fmt::print("  surfaces    {}\n", describe_surfaces(csg));
}

void print_mesh(const ObjectReport& object) {
  const EdgeCounts& e = object.edges;
  fmt::print("  triangles   {} on {} vertices, in {} {}\n", object.triangles, object.vertices,
             object.shells, object.shells == 1 ? "piece" : "pieces");
  if (object.degenerate_triangles > 0) {
    fmt::print("  degenerate  {} {} without area\n", object.degenerate_triangles,
               object.degenerate_triangles == 1 ? "triangle" : "triangles");
  }
  fmt::print("  edges       {} convex, {} concave, {} smooth, {} flat", e.convex, e.concave,
             e.smooth, e.flat);
  if (e.boundary > 0) fmt::print(", {} boundary", e.boundary);
  if (e.nonmanifold > 0) fmt::print(", {} non-manifold", e.nonmanifold);
  fmt::print("\n  shape       {}, {}", object.closed ? "closed" : "not closed",
             object.convex ? "convex" : "not convex");
  if (object.inradius) fmt::print(", inradius {:.6g}", *object.inradius);
  fmt::print("\n");
}

void print_object(const ObjectReport& object, const RoundingSummary* rounding,
                  std::optional<double> fitting) {
  fmt::print("\n{}\n", object.name.empty() ? "(no name)" : object.name);
  object.csg ? print_csg(object) : print_mesh(object);
  fmt::print("  size        {}\n", format_bounds(object.bounds_min, object.bounds_max));
  if (rounding == nullptr || rounding->radius == 0) {
    fmt::print("  rounding    none\n");
  } else {
    fmt::print("  rounding    radius {:.4g}: {} edges, {} corners\n", rounding->radius,
               rounding->edges, rounding->corners);
  }
  if (rounding == nullptr) return;
  for (const RoundingNote& note : rounding->notes) fmt::print("              {}\n", note.text());
  if (fitting)
    fmt::print("              a radius of {:.3g} leaves no edge sharp for want of room\n",
               *fitting);
}

// "12 triangles and 3 primitives": what there is of them.
std::string count_parts(const SceneReport& scene) {
  std::uint64_t primitives = 0;
  for (const ObjectReport& object : scene.objects) {
    primitives += object.csg ? object.csg->primitives : 0;
  }
  if (primitives == 0) return count(scene.triangles, "triangle");
  const std::string solids = count(primitives, "primitive");
  return scene.triangles == 0 ? solids : count(scene.triangles, "triangle") + " and " + solids;
}

void print_report(const Findings& findings, const std::string& input) {
  const SceneReport& scene = findings.scene;
  fmt::print("{}: {} in {}\n", input, count_parts(scene), count(scene.objects.size(), "object"));
  fmt::print("size {}\n", format_bounds(scene.bounds_min, scene.bounds_max));
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    print_object(scene.objects[i], find_summary(findings, i), findings.fitting_radii[i]);
  }
}

}  // namespace

int run_info(const Arguments& arguments) {
  const std::string& input = arguments.positionals[0];
  const int threads = threads_of(arguments);
  with_rounding_options({}, arguments);  // bad values before long loading
  Input loaded = load_input(input, load_options_of(arguments));
  Scene& scene = loaded.scene;
  check_scene(scene, loaded.name);
  Console console(arguments);
  // As render does: bare models are rounded, scene files say what they want.
  if (!scene.rounding && !loaded.is_scene_file) {
    RoundingSettings automatic;
    automatic.method = RoundMethod::exact;
    scene.rounding = automatic;
  }
  apply_rounding_options(scene, arguments);
  Findings findings;
  findings.scene = inspect_scene(scene, scene.rounding.value_or(RoundingSettings{}).min_angle);
  const auto prepared = prepare_scene(std::move(scene), {.threads = threads});
  for (const std::string& note : scene_of(*prepared).notes) console.report(note);
  findings.prepare = prepare_stats(*prepared);
  const Scene& described = scene_of(*prepared);
  for (std::size_t i = 0; i < findings.scene.objects.size(); ++i) {
    std::optional<double>& fitting = findings.fitting_radii.emplace_back();
    const RoundingSummary* const summary = find_summary(findings, i);
    if (summary == nullptr) continue;
    const auto stays_sharp = [](const ClampedEdge& edge) { return edge.radius == 0; };
    if (std::ranges::none_of(summary->clamped, stays_sharp)) continue;
    fitting = fitting_radius_of(described, described.objects[i], summary->radius);
  }
  if (arguments.has("--json")) {
    print_json(findings);
  } else {
    print_report(findings, loaded.name);
  }
  return 0;
}

}  // namespace arris::program
