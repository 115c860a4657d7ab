#include "render/scene_rounding.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "arris/error.h"
#include "base/check.h"
#include "base/parallel_for.h"
#include "render/auto_radius.h"
#include "render/void_neighbors.h"

namespace arris {
namespace {

// An automatic radius takes at most this part of what fits.
constexpr double kAutoPartOfHalfWidth = 0.3;

std::vector<Vec3f> transformed_positions(const Mesh& mesh, const Affine3d& m) {
  std::vector<Vec3f> out;
  out.reserve(mesh.positions.size());
  for (const Vec3f& p : mesh.positions) out.push_back(Vec3f(transform_point(m, Vec3d(p))));
  return out;
}

std::string place_of(const Object& object) {
  return "object \"" + object.name + "\"";
}

// The scale of an instance by a similarity. In float: turning it changes nothing.
std::optional<double> instance_scale(const GeometryRecord& record, const Mat3d& linear) {
  if (!record.instanced) return std::nullopt;
  const std::optional<double> scale = similarity_scale(linear);
  return scale ? std::optional(double(float(*scale))) : std::nullopt;
}

// One Rounding to be built, and the geometries that use it.
struct Task {
  std::uint32_t record = 0;  // the first geometry that needs it
  RoundingOptions options;
  std::optional<double> scale;  // in object space, by a similarity
  std::vector<std::uint32_t> users;
  std::shared_ptr<const Rounding> result;  // made already, where it is shared
};

class Maker {
 public:
  Maker(const SceneGeometry& geometry, const std::optional<RoundingSettings>& scene_default,
        const SceneRoundingOptions& options, const SceneRounding* before)
      : geometry_(geometry),
        scene_(geometry.scene),
        default_(scene_default),
        options_(options),
        before_(before) {}

  SceneRounding make() {
    const auto start = std::chrono::steady_clock::now();
    out_.scene_default = default_;
    out_.geometries.resize(geometry_.embree.records().size());
    out_.sources.resize(out_.geometries.size());
    collect_tasks();
    parallel_for(tasks_.size(), {.grain = 1, .threads = options_.threads, .stop = options_.stop},
                 [&](std::size_t i) {
                   if (!tasks_[i].result) build(tasks_[i]);
                 });
    for (Task& task : tasks_) attach(task);
    note_rules_without_edges();
    end_if_stopped(options_.stop);
    if (out_.any) out_.fillets = SceneFillets(out_.geometries);
    if (out_.any) find_void_neighbors(geometry_, out_, options_.threads, before_);
    out_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(out_);
  }

 private:
  [[nodiscard]] const GeometryRecord& record(std::uint32_t index) const {
    return geometry_.embree.records()[index];
  }
  [[nodiscard]] const Object& object_of(std::uint32_t index) const {
    return scene_.objects[record(index).object.index];
  }
  [[nodiscard]] const std::optional<RoundingSettings>& settings_of(std::uint32_t index) const {
    const Object& object = object_of(index);
    return object.rounding ? object.rounding : default_;
  }

  // What this geometry had before, if it still fits.
  [[nodiscard]] const RoundingSource* find_source(std::uint32_t i) const {
    if (before_ == nullptr) return nullptr;
    const RoundingSource& source = before_->sources[i];
    const RoundingSource& now = out_.sources[i];
    return (now.scale ? now.scale == source.scale : now.place.linear == source.place.linear)
               ? &source
               : nullptr;
  }

  // World units.
  [[nodiscard]] double radius_of(std::uint32_t i) const {
    const std::optional<RoundingSettings>& s = settings_of(i);
    if (!s || s->method != RoundMethod::exact) return 0;
    if (const RoundingSource* source = find_source(i)) return source->radius;
    if (before_ != nullptr && std::holds_alternative<AutoRadius>(s->radius)) {
      return before_->sources[i].radius;
    }
    return resolve_radius(scene_, object_of(i), *s, out_.sources[i].scale);
  }

  void collect_tasks() {
    std::vector<double> radii(out_.sources.size(), 0);
    parallel_for(radii.size(), {.grain = 8, .threads = options_.threads, .stop = options_.stop},
                 [&](std::size_t i) {
                   const auto index = std::uint32_t(i);
                   out_.sources[i].place = object_of(index).world_from_object;
                   if (record(index).triangles == nullptr) return;
                   RoundingSource& source = out_.sources[i];
                   source.scale = instance_scale(record(index), source.place.linear);
                   source.radius = radii[i] = radius_of(index);
                 });
    std::map<std::tuple<std::uint32_t, double, int, double, int, std::size_t>, std::size_t> shared;
    for (std::uint32_t i = 0; i < radii.size(); ++i) {
      if (!(radii[i] > 0)) continue;
      const RoundingSettings& settings = *settings_of(i);
      Task task;
      task.record = i;
      task.options = {radii[i],
                      settings.edges,
                      settings.min_angle,
                      options_.detection,
                      std::holds_alternative<AutoRadius>(settings.radius) ? TooLarge::leave_sharp
                                                                          : TooLarge::error,
                      settings.on_overlap,
                      settings.rules};
      if (const RoundingSource* source = find_source(i)) task.result = source->rounding;
      task.scale = out_.sources[i].scale;
      if (task.scale) {
        task.options.radius /= *task.scale;
        for (EdgeRule& rule : task.options.rules) rule.radius /= rule.is_part ? 1 : *task.scale;
        const auto key =
            std::tuple(record(i).mesh.index, task.options.radius, int(settings.edges),
                       settings.min_angle, int(settings.on_overlap), number_of(task.options.rules));
        const auto [at, is_new] = shared.try_emplace(key, tasks_.size());
        if (!is_new) {
          Task& same = tasks_[at->second];
          same.users.push_back(i);
          if (!same.result) same.result = task.result;
          continue;
        }
      }
      task.users.push_back(i);
      tasks_.push_back(std::move(task));
    }
  }

  // The same for equal rules.
  std::size_t number_of(const std::vector<EdgeRule>& rules) {
    const auto known = std::size_t(std::ranges::find(rules_, rules) - rules_.begin());
    if (known == rules_.size()) rules_.push_back(rules);
    return known;
  }

  void build(Task& task) const {
    const GeometryRecord& r = record(task.record);
    const Mesh& mesh = scene_.meshes[r.mesh.index];
    const Object& object = scene_.objects[r.object.index];
    const std::span<const Triangle> triangles(r.triangles, r.triangle_count);
    std::vector<Vec3f> own;
    std::span<const Vec3f> positions(r.positions, mesh.positions.size());
    if (r.instanced && !task.scale) {
      own = transformed_positions(mesh, {object.world_from_object.linear, {}});
      positions = own;
    }
    MeshView view{positions, triangles, mesh.sharp_edges, mesh.edge_radii, mesh.positions};
    std::vector<EdgeRadius> radii;
    if (!task.scale && !mesh.edge_radii.empty()) {
      radii = mesh.edge_radii;
      const double scale = std::cbrt(std::abs(determinant(object.world_from_object.linear)));
      for (EdgeRadius& edge : radii) edge.radius = float(scale * double(edge.radius));
      view.edge_radii = radii;
    }
    task.result =
        std::make_shared<const Rounding>(make_rounding(view, task.options, place_of(object)));
  }

  void attach(Task& task) {
    out_.any = true;
    const RoundingReport& report = task.result->report();
    out_.bytes += report.bytes;
    for (const std::uint32_t i : task.users) {
      const GeometryRecord& r = record(i);
      const Object& object = scene_.objects[r.object.index];
      RoundedGeometry& g = out_.geometries[i];
      out_.sources[i].rounding = task.result;
      out_.sources[i].options = task.options;
      g.rounding = task.result.get();
      if (!task.result->data().band_begin.empty()) {
        g.band_begin = task.result->data().band_begin.data();
        g.bands = task.result->data().bands.data();
      }
      g.any_turned = std::ranges::any_of(task.result->data().solids, &Solid::turned);
      if (task.scale) {
        // A similarity's own linear part turns normals, mirrored or not.
        set_frame(g, {inverse(object.world_from_object), object.world_from_object.linear});
      } else if (r.instanced) {
        set_frame(g, {{{}, -object.world_from_object.translation}, {}});
      }
      out_.edges += report.rounded_edges;
      out_.corners += report.rounded_corners;
      out_.summaries.push_back({object.name, r.object.index,
                                task.options.radius * task.scale.value_or(1), report.rounded_edges,
                                report.rounded_corners, report.notes,
                                clamped_in_world(task, r, object)});
      count_matches(settings_of(i)->rules, report.rule_edges);
    }
    out_.roundings.push_back(std::move(task.result));
  }

  void count_matches(const std::vector<EdgeRule>& rules, std::span<const std::uint64_t> edges) {
    if (rules.empty()) return;
    auto known = std::ranges::find(matches_, rules, &RuleMatches::rules);
    if (known == matches_.end()) {
      matches_.push_back({rules, std::vector<std::uint64_t>(rules.size(), 0), {}});
      known = matches_.end() - 1;
    }
    ARRIS_CHECK(edges.size() == rules.size());
    for (std::size_t k = 0; k < edges.size(); ++k) known->edges[k] += edges[k];
    known->summaries.push_back(out_.summaries.size() - 1);
  }

  // One that matches edges of another object is right.
  void note_rules_without_edges() {
    for (const RuleMatches& matches : matches_) {
      for (std::size_t k = 0; k < matches.edges.size(); ++k) {
        if (matches.edges[k] > 0) continue;
        const RoundingNote note{0, "", fmt::format("rule {} matches no edge to be rounded", k + 1)};
        for (const std::size_t summary : matches.summaries) {
          out_.summaries[summary].notes.push_back(note);
        }
      }
    }
  }

  // The rounding was made in the object's space, in the world's, or in that without the object's translation.
  [[nodiscard]] static std::vector<ClampedEdge> clamped_in_world(const Task& task,
                                                                 const GeometryRecord& record,
                                                                 const Object& object) {
    Affine3d to_world;
    if (task.scale) {
      to_world = object.world_from_object;
    } else if (record.instanced) {
      to_world.translation = object.world_from_object.translation;
    }
    std::vector<ClampedEdge> edges = task.result->report().clamped;
    for (ClampedEdge& edge : edges) {
      edge.from = transform_point(to_world, edge.from);
      edge.to = transform_point(to_world, edge.to);
      edge.radius *= task.scale.value_or(1);
    }
    return edges;
  }

  void set_frame(RoundedGeometry& g, const RoundingFrame& frame) {
    out_.frames.push_back(std::make_unique<const RoundingFrame>(frame));
    g.frame = out_.frames.back().get();
  }

  const SceneGeometry& geometry_;
  const Scene& scene_;
  const std::optional<RoundingSettings>& default_;
  SceneRoundingOptions options_;
  const SceneRounding* before_;
  SceneRounding out_;
  std::vector<Task> tasks_;
  std::vector<std::vector<EdgeRule>> rules_;  // of the tasks, each once
  // How many edges of all objects that have the rules each of these matches.
  struct RuleMatches {
    std::vector<EdgeRule> rules;
    std::vector<std::uint64_t> edges;
    std::vector<std::size_t> summaries;
  };
  std::vector<RuleMatches> matches_;
};

Vec3d center_of(const Mesh& mesh, const Affine3d& m) {
  Vec3d low(INFINITY), high(-INFINITY);
  for (const Vec3f& p : mesh.positions) {
    const Vec3d q = transform_point(m, Vec3d(p));
    low = min(low, q);
    high = max(high, q);
  }
  return (low + high) * 0.5;
}

// Lengths in world units. In object space, if there is a scale from it: so they don't depend on how it is turned.
RadiusLimits limits_of(const Mesh& mesh, const Object& object, double min_angle,
                       std::optional<double> scale) {
  if (!scale) {
    const std::vector<Vec3f> positions = transformed_positions(mesh, object.world_from_object);
    return find_radius_limits({positions, mesh.triangles, mesh.sharp_edges}, min_angle,
                              place_of(object));
  }
  RadiusLimits limits = find_radius_limits({mesh.positions, mesh.triangles, mesh.sharp_edges},
                                           min_angle, place_of(object));
  if (limits.smallest_inradius) *limits.smallest_inradius *= *scale;
  if (limits.typical_half_width) *limits.typical_half_width *= *scale;
  return limits;
}

double percent_radius(const RadiusLimits& limits, double percent) {
  if (limits.smallest_inradius) return *limits.smallest_inradius * percent / 100;
  return limits.typical_half_width.value_or(0) * percent / 100;  // 0: no edge to round
}

double auto_radius(const Scene& scene, const Object& object, const RadiusLimits& limits) {
  if (!limits.typical_half_width) return 0;  // no edge to round
  return std::min(most_auto_radius(scene, object),
                  kAutoPartOfHalfWidth * *limits.typical_half_width);
}

}  // namespace

std::optional<double> similarity_scale(const Mat3d& m) {
  const double s = length(m.x);
  const double slack = 1e-6 * s * s;
  const bool same =
      std::abs(dot(m.y, m.y) - s * s) < slack && std::abs(dot(m.z, m.z) - s * s) < slack;
  const bool square = std::abs(dot(m.x, m.y)) < slack && std::abs(dot(m.y, m.z)) < slack &&
                      std::abs(dot(m.z, m.x)) < slack;
  return same && square ? std::optional(s) : std::nullopt;
}

double most_auto_radius(const Scene& scene, const Object& object) {
  if (object.auto_radius) return *object.auto_radius;
  const Mesh& mesh = scene.meshes[object.mesh.index];
  return readable_radius(*scene.camera, scene.image, center_of(mesh, object.world_from_object));
}

double resolve_radius(const Scene& scene, const Object& object, const RoundingSettings& settings,
                      std::optional<double> scale) {
  if (settings.method == RoundMethod::none) return 0;
  if (const auto* value = std::get_if<double>(&settings.radius)) return *value;
  const RadiusLimits limits =
      limits_of(scene.meshes[object.mesh.index], object, settings.min_angle, scale);
  if (const auto* percent = std::get_if<PercentOfInradius>(&settings.radius)) {
    return percent_radius(limits, percent->percent);
  }
  return auto_radius(scene, object, limits);
}

SceneRounding make_scene_rounding(const SceneGeometry& geometry,
                                  const std::optional<RoundingSettings>& scene_default,
                                  const SceneRoundingOptions& options,
                                  const SceneRounding* before) {
  return Maker(geometry, scene_default, options, before).make();
}

}  // namespace arris
