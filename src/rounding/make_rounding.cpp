// make_rounding.cpp — from triangles to a Rounding: weld, find faces, build each shell's network, its bands
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <string>

#include "arris/error.h"
#include "base/parallel_for.h"
#include "edges/inscribed_ball.h"
#include "rounding/bands.h"
#include "rounding/crease_network.h"
#include "rounding/edge_radii.h"
#include "rounding/eroded_polyhedron.h"
#include "rounding/exact_solids.h"
#include "rounding/outside_mesh.h"
#include "rounding/rounding_data.h"
#include "rounding/rounding_parts.h"

namespace arris {
namespace {

std::string format_length(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

class RoundingMaker {
 public:
  RoundingMaker(const MeshView& mesh, const RoundingOptions& options, const std::string& name)
      : mesh_(mesh), options_(options), name_(name), data_(std::make_unique<Rounding::Data>()) {}

  std::unique_ptr<const Rounding::Data> make() {
    check_options();
    data_->radius = options_.radius;
    welded_ = make_welded_mesh(mesh_, name_);
    regions_ = make_flat_regions(welded_);
    if (!turn_inverted_shells(welded_, regions_, options_.min_angle).empty()) {
      regions_ = make_flat_regions(welded_);
    }
    classify_edges();
    auto [radii, matches] = find_edge_radii(mesh_, welded_, regions_, kinds_, options_);
    radii_ = std::move(radii);
    data_->report.rule_edges = std::move(matches);
    sort_triangles_by_region();
    make_solids();
    for (std::uint32_t s = 0; s < data_->solids.size(); ++s) judge_shape(s);
    make_exact();
    leave_edges_without_radius();
    std::vector<ShellNetwork> networks = build_networks();
    for (std::uint32_t s = 0; s < data_->solids.size(); ++s) round_solid(s, std::move(networks[s]));
    sort_bands();
    fill_links();
    if (options_.detection == Detection::kd_tree) make_tree();
    finish_report();
    return std::move(data_);
  }

  // Besides, what the rounding was made from.
  RoundingParts make_parts() {
    keep_networks_ = true;
    RoundingParts parts;
    parts.data = make();
    parts.welded = std::move(welded_);
    parts.regions = std::move(regions_);
    parts.kinds = std::move(kinds_);
    parts.networks = std::move(networks_);
    parts.networks.resize(parts.welded.shells.size());
    return parts;
  }

 private:
  void check_options() const {
    if (!(options_.radius > 0) || !std::isfinite(options_.radius)) {
      throw Error(Error::Kind::input, name_,
                  "rounding radius " + format_length(options_.radius) +
                      " is not a positive number; use one above 0, or no rounding");
    }
    if (!(options_.min_angle >= 0 && options_.min_angle <= kPi)) {
      throw Error(Error::Kind::input, name_,
                  "minimum angle " + format_length(degrees(options_.min_angle)) +
                      " degrees is outside 0 to 180");
    }
  }

  void classify_edges() {
    const auto count = std::uint32_t(welded_.twin.size());
    kinds_.assign(count, EdgeKind::flat);
    RoundingReport& report = data_->report;
    for (std::uint32_t h = 0; h < count; ++h) {
      if (welded_.shell[h / 3] == kNone) continue;
      const std::uint32_t twin = welded_.twin[h];
      if (twin <= kLastHalfEdge && twin < h) continue;
      const EdgeKind kind = classify_edge(welded_, regions_, h, options_.min_angle);
      kinds_[h] = kind;
      if (twin <= kLastHalfEdge) kinds_[twin] = kind;
      report.concave_edges += kind == EdgeKind::concave ? 1 : 0;
      report.smooth_edges += kind == EdgeKind::smooth ? 1 : 0;
      report.boundary_edges += kind == EdgeKind::boundary ? 1 : 0;
      report.nonmanifold_edges += kind == EdgeKind::nonmanifold ? 1 : 0;
    }
    if (options_.edges == RoundEdges::convex) return;
    if (report.concave_edges > 0) outside_ = turn_inside_out(welded_, regions_, kinds_);
    if (options_.edges == RoundEdges::both) return;
    for (std::uint32_t h = 0; h < count; ++h) {
      if (kinds_[h] != EdgeKind::convex) continue;
      kinds_[h] = EdgeKind::smooth;
      unasked_ += welded_.twin[h] < h ? 1 : 0;
    }
  }

  // The caller's triangles: pieces of split ones have no barycentrics of their own.
  void sort_triangles_by_region() {
    const std::size_t count = mesh_.triangles.size();
    triangle_begin_.assign(regions_.planes.size() + 2, 0);
    for (std::size_t t = 0; t < count; ++t) {
      if (regions_.region[t] != kNone) ++triangle_begin_[regions_.region[t] + 2];
    }
    for (std::size_t r = 2; r < triangle_begin_.size(); ++r) {
      triangle_begin_[r] += triangle_begin_[r - 1];
    }
    triangles_.resize(triangle_begin_.back());
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::uint32_t r = regions_.region[t];
      if (r != kNone) triangles_[triangle_begin_[r + 1]++] = t;
    }
  }

  void make_solids() {
    data_->face.assign(regions_.region.begin(),
                       regions_.region.begin() + std::ptrdiff_t(mesh_.triangles.size()));
    data_->faces.reserve(regions_.planes.size());
    for (std::size_t r = 0; r < regions_.planes.size(); ++r) {
      data_->faces.push_back(
          {Vec3f(regions_.planes[r].normal), regions_.shell[r], regions_.planes[r].d});
    }
    data_->solids.resize(welded_.shells.size());
    for (std::size_t s = 0; s < welded_.shells.size(); ++s) {
      Solid& solid = data_->solids[s];
      solid.center = welded_.shells[s].center();
      solid.size = welded_.shells[s].size();
      solid.closed = welded_.shells[s].closed;
      solid.turned = welded_.shells[s].turned;
      solid.radius = options_.radius;
    }
    for (std::uint32_t f = 0; f < data_->faces.size(); ++f) {
      Solid& solid = data_->solids[data_->faces[f].solid];
      if (solid.face_count++ == 0) solid.first_face = f;
    }
  }

  // Looks at every edge of the shell: is it convex, is every edge rounded?
  void judge_shape(std::uint32_t shell_index) {
    const Shell& shell = welded_.shells[shell_index];
    Solid& solid = data_->solids[shell_index];
    bool all_rounded = true;
    bool convex = true;
    for (std::uint32_t i = 0; i < shell.triangle_count; ++i) {
      const std::uint32_t t = welded_.triangles_by_shell[shell.first_triangle + i];
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        all_rounded = all_rounded && (kinds_[h] == EdgeKind::convex || kinds_[h] == EdgeKind::flat);
        if (kinds_[h] == EdgeKind::concave) convex = false;
        if (kinds_[h] == EdgeKind::smooth && welded_.twin[h] > h) {
          convex = convex && turn_at(welded_, regions_, h) >= 0;
        }
      }
    }
    solid.convex = convex;
    solid.all_rounded = all_rounded;
    solid.exact = convex && solid.closed && all_rounded;
  }

  // Of each shell, empty ones of hollows that stay sharp. Builders have room for the whole mesh: a few do for all.
  [[nodiscard]] std::vector<ShellNetwork> build_networks() {
    constexpr std::size_t kMostParts = 16;
    // A mesh of bevels has each edge of its own.
    const ShortEdges short_edges = keep_networks_ ? ShortEdges::leave_sharp : ShortEdges::skip;
    const std::size_t count = data_->solids.size(), parts = std::min(count, kMostParts);
    std::vector<ShellNetwork> networks(count);
    parallel_for(parts, {}, [&](std::size_t part) {
      std::map<double, NetworkBuilder> builders;
      for (std::size_t s = count * part / parts; s < count * (part + 1) / parts; ++s) {
        const Solid& solid = data_->solids[s];
        if (stays_sharp(s)) continue;
        const auto at = builders.try_emplace(solid.radius, welded_, regions_, kinds_, solid.radius,
                                             short_edges);
        networks[s] = at.first->second.build(std::uint32_t(s), solid.convex && solid.closed);
      }
    });
    return networks;
  }

  // A hollow whose solid isn't creased.
  [[nodiscard]] bool stays_sharp(std::size_t s) const {
    return is_cavity(welded_.shells[s]) && data_->solids[s].creased == kNone;
  }

  void round_solid(std::uint32_t s, ShellNetwork network) {
    Solid& solid = data_->solids[s];
    solid.first_arc = std::uint32_t(data_->arcs.size());
    solid.first_node = std::uint32_t(data_->nodes.size());
    const bool creased = solid.creased != kNone;
    if (stays_sharp(s)) {
      cavities_ += solid.filled == kNone ? 1 : 0;
      return;
    }
    const bool convex_solid = solid.convex && solid.closed;
    if (convex_solid && network.inverted) {
      const InscribedBall ball = inscribed_ball(s);
      if (ball.radius - options_.radius < 1e-6 * solid.size) {
        leave_sharp(s, ball);
        return;
      }
      network = erode(s, ball);
    }
    data_->report.rounded_edges += network.rounded_edges;
    data_->report.rounded_corners += network.rounded_corners;
    if (creased) {
      // What the network leaves sharp is rounded all the same. It tells outlines where to look.
      data_->report.rounded_edges += network.shortened_edges + network.narrow_edges;
    } else {
      local_ += solid.closed && !solid.convex && network.rounded_edges > 0 ? 1 : 0;
      shortened_ += network.shortened_edges;
      narrow_ += network.narrow_edges;
      for (const std::uint32_t h : network.left_sharp) add_clamped({h, 0});
      const BandInput input{mesh_, welded_, regions_, triangle_begin_, triangles_, options_.radius};
      append_bands(input, network, solid, solid.first_arc, bands_);
    }
    append(network, s);
    if (!keep_networks_) return;
    networks_.resize(data_->solids.size());
    networks_[s] = std::move(network);
  }

  // Whoever wants networks gets local ones.
  void make_exact() {
    if (keep_networks_) return;
    MadeExact made =
        make_exact_solids({mesh_, options_, welded_, regions_, kinds_, radii_, triangle_begin_,
                           triangles_, outside_ ? &*outside_ : nullptr},
                          *data_);
    bands_ = std::move(made.bands);
    filled_edges_ = made.filled_edges;
    std::map<FacePair, std::int64_t> sharp;  // how many of an edge's pieces are, all along
    for (const ClampedPart& e : made.clamped) {
      add_clamped(e);
      if (e.radius > 0) {
        ++clamped_;
      } else {
        sharp[faces_at(e.half_edge)] += e.from == 0 && e.to == 1 ? 1 : 0;
      }
    }
    count_sharp_edges(std::move(sharp));
    for (const std::uint32_t s : made.left_sharp) leave_shell_sharp(s);
  }

  // Pieces of an edge are one.
  void count_sharp_edges(std::map<FacePair, std::int64_t> sharp_pieces) {
    if (sharp_pieces.empty()) return;
    for (std::uint32_t h = 0; h < kinds_.size(); ++h) {
      const bool may_be_rounded = kinds_[h] == EdgeKind::convex || kinds_[h] == EdgeKind::concave;
      if (!may_be_rounded || h > welded_.twin[h] || welded_.twin[h] > kLastHalfEdge) continue;
      const auto edge = sharp_pieces.find(faces_at(h));
      if (edge != sharp_pieces.end()) --edge->second;
    }
    for (const auto& [faces, beyond] : sharp_pieces)
      ++(beyond < 0 ? sharp_in_part_ : left_in_creased_);
  }

  [[nodiscard]] FacePair faces_at(std::uint32_t h) const {
    return std::minmax(regions_.region[h / 3], regions_.region[welded_.twin[h] / 3]);
  }

  void leave_shell_sharp(std::uint32_t s) {
    std::set<FacePair> edges;
    for_edges_of(EdgeKind::convex, welded_, kinds_, s, [&](std::uint32_t h) {
      kinds_[h] = kinds_[welded_.twin[h]] = EdgeKind::smooth;
      edges.insert(faces_at(h));
      add_clamped({h, 0});
    });
    narrow_ += edges.size();
    data_->solids[s].all_rounded = data_->solids[s].exact = false;
  }

  void add_clamped(const ClampedPart& part) {
    const Vec3d p(welded_.vertices[welded_.origin(part.half_edge)]);
    const Vec3d along = Vec3d(welded_.vertices[welded_.target(part.half_edge)]) - p;
    data_->report.clamped.push_back({p + along * part.from, p + along * part.to, part.radius});
  }

  // Edges without a radius stay sharp everywhere; the others of what isn't creased or filled have the options' radius.
  void leave_edges_without_radius() {
    if (radii_.empty()) return;
    for (std::uint32_t s = 0; s < data_->solids.size(); ++s) {
      Solid& solid = data_->solids[s];
      for_edges_of(EdgeKind::convex, welded_, kinds_, s, [&](std::uint32_t h) {
        if (radii_[h] == 0) {
          kinds_[h] = kinds_[welded_.twin[h]] = EdgeKind::smooth;
          ++sharp_by_rule_;
          solid.all_rounded = solid.exact = false;
        } else if (solid.creased == kNone && radii_[h] != options_.radius) {
          ++rules_ignored_;
        }
      });
      for_edges_of(EdgeKind::concave, welded_, kinds_, s, [&](std::uint32_t h) {
        if (radii_[h] == 0) ++concave_by_rule_;
      });
    }
  }

  [[nodiscard]] std::span<const Plane> planes_of(const Solid& solid) const {
    return std::span(regions_.planes).subspan(solid.first_face, solid.face_count);
  }

  [[nodiscard]] InscribedBall inscribed_ball(std::uint32_t s) const {
    const Solid& solid = data_->solids[s];
    return largest_inscribed_ball(planes_of(solid), solid.size);
  }

  // No ball of the radius fits into the solid.
  void leave_sharp(std::uint32_t s, const InscribedBall& ball) {
    Solid& solid = data_->solids[s];
    if (options_.too_large == TooLarge::leave_sharp) {
      solid.exact = false;
      ++too_small_;
      return;
    }
    throw Error(Error::Kind::input, name_,
                "rounding radius " + format_length(options_.radius) +
                    " is not below the inradius " + format_length(ball.radius) +
                    " of the solid at (" + format_length(solid.center.x) + ", " +
                    format_length(solid.center.y) + ", " + format_length(solid.center.z) +
                    "); use at most " + format_length(0.99 * ball.radius));
  }

  // The radius has eaten features: E has fewer edges than P.
  ShellNetwork erode(std::uint32_t s, const InscribedBall& ball) {
    Solid& solid = data_->solids[s];
    solid.rewired = true;
    return make_eroded_polyhedron(planes_of(solid), smooth_groups(s), solid.first_face,
                                  options_.radius, ball.center, solid.size);
  }

  // Faces joined by edges that stay sharp.
  std::vector<std::uint32_t> smooth_groups(std::uint32_t s) const {
    const Solid& solid = data_->solids[s];
    const Shell& shell = welded_.shells[s];
    std::vector<std::uint32_t> group(solid.face_count);
    std::iota(group.begin(), group.end(), 0U);
    const auto root = [&](std::uint32_t f) {
      while (group[f] != f) f = group[f] = group[group[f]];
      return f;
    };
    for (std::uint32_t i = 0; i < shell.triangle_count; ++i) {
      const std::uint32_t t = welded_.triangles_by_shell[shell.first_triangle + i];
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        if (kinds_[h] != EdgeKind::smooth) continue;
        const std::uint32_t a = root(regions_.region[t] - solid.first_face);
        const std::uint32_t b = root(regions_.region[welded_.twin[h] / 3] - solid.first_face);
        group[std::max(a, b)] = std::min(a, b);
      }
    }
    for (std::uint32_t f = 0; f < group.size(); ++f) group[f] = root(f);
    return group;
  }

  void append(const ShellNetwork& network, std::uint32_t s) {
    Solid& solid = data_->solids[s];
    solid.arc_count = std::uint32_t(network.arcs.size());
    solid.node_count = std::uint32_t(network.nodes.size());
    const Vec3d shift = welded_.shells[s].center() - solid.center;  // of a hollow
    for (const NetworkArc& source : network.arcs) {
      Arc arc = source.arc;
      arc.line.p0 = Vec3f(Vec3d(arc.line.p0) + shift);
      arc.node0 += solid.first_node;
      if (!arc.is_stub()) arc.node1 += solid.first_node;
      const std::size_t triangles = mesh_.triangles.size();  // pieces of split ones have no normals
      // Without smooth edges, the faces' shading normals are the faces' own.
      if (solid.all_rounded || arc.triangle_a >= triangles || arc.triangle_b >= triangles) {
        arc.triangle_a = arc.triangle_b = kNone;
      }
      data_->arcs.push_back(arc);
    }
    for (const NetworkNode& source : network.nodes) {
      Node node;
      node.position = Vec3f(source.position + shift);
      node.kind = source.kind;
      data_->nodes.push_back(node);
      walls_.push_back(source.wall);
    }
  }

  // Bands in the order of their triangles.
  void sort_bands() {
    std::vector<std::uint32_t>& begin = data_->band_begin;
    begin.assign(mesh_.triangles.size() + 2, 0);
    for (const TriangleBand& b : bands_) ++begin[b.triangle + 2];
    for (std::size_t t = 2; t < begin.size(); ++t) begin[t] += begin[t - 1];
    data_->bands.resize(bands_.size());
    for (const TriangleBand& b : bands_) data_->bands[begin[b.triangle + 1]++] = b.band;
    begin.pop_back();
  }

  void fill_links() {
    std::vector<Node>& nodes = data_->nodes;
    const auto for_ends = [&](auto&& visit) {
      for (std::uint32_t a = 0; a < data_->arcs.size(); ++a) {
        visit(data_->arcs[a].node0, a);
        if (!data_->arcs[a].is_stub()) visit(data_->arcs[a].node1, a);
      }
    };
    std::vector<std::uint32_t> count(nodes.size(), 0);
    for_ends([&](std::uint32_t node, std::uint32_t) { ++count[node]; });
    std::uint32_t total = 0;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      nodes[n].first_link = total;
      total += count[n] + (nodes[n].kind == Node::Kind::cap ? 1U : 0U);
    }
    data_->links.assign(total, kNone);
    for_ends([&](std::uint32_t node, std::uint32_t arc) {
      data_->links[nodes[node].first_link + nodes[node].link_count++] = arc;
    });
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      if (nodes[n].kind != Node::Kind::cap) continue;
      data_->links[nodes[n].first_link + nodes[n].link_count++] = walls_[n];
    }
  }

  // The tree stands in for the bands, which are not kept beside it.
  void make_tree() {
    std::vector<std::vector<DetectionEntry>> entries(data_->solids.size());
    for (const TriangleBand& b : bands_) {
      if (b.band.arc == kNone) continue;  // creased solids ask their own trees
      const std::uint32_t face = data_->face[b.triangle];
      const std::uint32_t s = data_->faces[face].solid;
      const DetectionEntry part = detection_entry(b, face, data_->solids[s]);
      if (entries[s].empty() || entries[s].back().face != face ||
          entries[s].back().arc != part.arc) {
        entries[s].push_back(part);
        continue;
      }
      DetectionEntry& whole = entries[s].back();
      whole.low = min(whole.low, part.low);
      whole.high = max(whole.high, part.high);
    }
    data_->tree = std::make_unique<const DetectionTree>(entries);
    data_->bands = {};
    data_->band_begin = {};
  }

  // Box of the triangle's part where the band is not kept.
  [[nodiscard]] DetectionEntry detection_entry(const TriangleBand& b, std::uint32_t face,
                                               const Solid& solid) const {
    const Triangle& t = mesh_.triangles[b.triangle];
    const float depth[3] = {b.band.c0, b.band.c0 + b.band.cu, b.band.c0 + b.band.cv};
    Vec3d low(INFINITY), high(-INFINITY);
    const auto include = [&](Vec3d p) {
      low = min(low, p);
      high = max(high, p);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const Vec3d p = Vec3d(mesh_.positions[t[i]]) - solid.center;
      const Vec3d q = Vec3d(mesh_.positions[t[j]]) - solid.center;
      if (depth[i] > 0) include(p);
      if ((depth[i] > 0) != (depth[j] > 0)) {
        include(p + (q - p) * double(depth[i] / (depth[i] - depth[j])));
      }
    }
    const Vec3d slack(kPlaneTolerance * solid.size);
    return {Vec3f(low - slack), Vec3f(high + slack), face, b.band.arc,
            b.band.cu == 0 && b.band.cv == 0};
  }

  void finish_report() {
    RoundingReport& report = data_->report;
    report.solids = data_->solids.size();
    std::uint64_t open = 0;
    report.rounded_edges -= std::min(report.rounded_edges, left_in_creased_);
    for (const Solid& solid : data_->solids) {
      report.convex_solids += solid.convex && solid.closed ? 1 : 0;
      const bool creased = solid.creased != kNone;
      report.exact_solids += solid.exact || creased ? 1 : 0;
      open += solid.closed ? 0 : 1;
    }
    report.open_solids = open;
    report.bytes = bytes();
    const auto note = [&](std::uint64_t count, const char* one, const char* many) {
      if (count > 0) report.notes.push_back({count, one, many});
    };
    if (options_.edges != RoundEdges::concave) {
      note(local_, "solid is not convex: rounded locally along its convex edges",
           "solids are not convex: rounded locally along their convex edges");
      note(open, "shell is not closed: rounded where it is locally a solid",
           "shells are not closed: rounded where they are locally a solid");
    }
    note(unasked_, "convex edge stays sharp: only concave edges are to be rounded",
         "convex edges stay sharp: only concave edges are to be rounded");
    note(cavities_, "hollow inside another solid: its edges stay sharp",
         "hollows inside other solids: their edges stay sharp");
    const std::uint64_t unfilled = report.concave_edges - filled_edges_ - concave_by_rule_;
    note(unfilled, "concave edge stays sharp", "concave edges stay sharp");
    note(report.nonmanifold_edges, "non-manifold edge stays sharp",
         "non-manifold edges stay sharp");
    report.narrow_edges = shortened_ + narrow_ + left_in_creased_ + too_small_ +
                          (options_.edges == RoundEdges::convex ? 0 : unfilled);
    note(shortened_, "edge stays sharp: the radius needs more length than it has",
         "edges stay sharp: the radius needs more length than they have");
    note(narrow_ + left_in_creased_,
         "edge stays sharp: the radius is too large for the faces beside it",
         "edges stay sharp: the radius is too large for the faces beside them");
    note(sharp_in_part_,
         "edge stays sharp in part: the radius is too large for the faces beside it",
         "edges stay sharp in part: the radius is too large for the faces beside them");
    note(clamped_, "edge has a smaller radius: its own is too large for what lies beside it",
         "edges have a smaller radius: their own is too large for what lies beside them");
    note(sharp_by_rule_ + concave_by_rule_, "edge stays sharp: its radius is 0",
         "edges stay sharp: their radius is 0");
    note(rules_ignored_,
         "edge has the object's radius instead of its own: it is of no closed solid that is exact",
         "edges have the object's radius instead of their own: they are of no closed solid that is "
         "exact");
    note(too_small_, "solid stays sharp: no ball of the radius fits into it",
         "solids stay sharp: no ball of the radius fits into them");
  }

  [[nodiscard]] std::uint64_t creased_bytes() const {
    std::uint64_t sum = 0;
    for (const auto& solid : data_->creased) sum += solid->bytes();
    for (const auto& solid : data_->filled) sum += solid->outside.bytes() + solid->fillets.bytes();
    return sum;
  }

  [[nodiscard]] std::uint64_t bytes() const {
    const auto of = [](const auto& v) { return v.size() * sizeof(v[0]); };
    return of(data_->band_begin) + of(data_->bands) + of(data_->face) + of(data_->faces) +
           of(data_->arcs) + of(data_->nodes) + of(data_->links) + of(data_->solids) +
           of(data_->fillet_boxes) + of(data_->fillet_parts) + of(data_->plain) +
           of(data_->plain_begin) + of(data_->plain_on) + (data_->tree ? data_->tree->bytes() : 0) +
           creased_bytes();
  }

  const MeshView& mesh_;
  const RoundingOptions& options_;
  const std::string& name_;
  std::unique_ptr<Rounding::Data> data_;
  WeldedMesh welded_;
  FlatRegions regions_;
  std::vector<EdgeKind> kinds_;
  std::vector<double> radii_;           // find_edge_radii()
  std::optional<OutsideMesh> outside_;  // if concave edges are to be rounded, and there are any
  std::vector<std::uint32_t> triangle_begin_, triangles_;
  std::vector<TriangleBand> bands_;
  std::vector<std::uint32_t> walls_;
  bool keep_networks_ = false;
  std::vector<ShellNetwork> networks_;
  std::uint64_t local_ = 0, cavities_ = 0, shortened_ = 0, narrow_ = 0, too_small_ = 0,
                unasked_ = 0;
  std::uint64_t filled_edges_ = 0, left_in_creased_ = 0, sharp_in_part_ = 0;
  std::uint64_t clamped_ = 0, sharp_by_rule_ = 0, concave_by_rule_ = 0, rules_ignored_ = 0;
};

}  // namespace

Rounding make_rounding(const MeshView& mesh, const RoundingOptions& options,
                       const std::string& name) {
  return Rounding(RoundingMaker(mesh, options, name).make());
}

RoundingParts make_rounding_parts(const MeshView& mesh, const RoundingOptions& options,
                                  const std::string& name) {
  return RoundingMaker(mesh, options, name).make_parts();
}

}  // namespace arris
