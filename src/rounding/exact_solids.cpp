#include "rounding/exact_solids.h"

#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "base/parallel_for.h"
#include "rounding/make_creased.h"
#include "rounding/plain_lists.h"

namespace arris {
namespace {

class ExactMaker {
 public:
  ExactMaker(const ExactInput& input, Rounding::Data& data) : in_(input), data_(data) {}

  MadeExact make() {
    make_creased_solids();
    make_filled_solids();
    list_plain_creases();
    return std::move(made_);
  }

 private:
  // Of each shell that is no hollow: it and its hollows, if they are for a CreasedSolid.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> shells_for_creases() const {
    std::vector<std::vector<std::uint32_t>> solids;
    if (in_.options.edges == RoundEdges::concave) return solids;
    std::vector<std::vector<std::uint32_t>> hollows = hollows_of_shells();
    for (std::uint32_t s = 0; s < data_.solids.size(); ++s) {
      if (is_cavity(in_.welded.shells[s]) || !in_.welded.shells[s].closed) continue;
      const bool is_convex = data_.solids[s].convex && hollows[s].empty();
      if (is_convex && !has_own_radii(s)) continue;
      hollows[s].insert(hollows[s].begin(), s);
      solids.push_back(std::move(hollows[s]));
    }
    return solids;
  }

  [[nodiscard]] bool has_own_radii(std::uint32_t s) const {
    bool any = false;
    if (!in_.radii.empty()) {
      for_edges_of(EdgeKind::convex, in_.welded, in_.kinds, s,
                   [&](std::uint32_t h) { any = any || in_.radii[h] != in_.options.radius; });
    }
    return any;
  }

  [[nodiscard]] std::vector<std::vector<std::uint32_t>> hollows_of_shells() const {
    const std::vector<Shell>& shells = in_.welded.shells;
    std::vector<std::vector<std::uint32_t>> hollows(shells.size());
    for (std::uint32_t s = 0; s < shells.size(); ++s) {
      const std::uint32_t outer = shell_around(shells, s);
      if (outer != kNone) hollows[outer].push_back(s);
    }
    return hollows;
  }

  void make_creased_solids() {
    const std::vector<std::vector<std::uint32_t>> wanted = shells_for_creases();
    const CreasedInput input{in_.mesh,  in_.welded,         in_.regions,
                             in_.kinds, in_.options.radius, in_.options.on_overlap,
                             in_.radii};
    std::vector<std::optional<MadeCreased>> made(wanted.size());
    parallel_for(wanted.size(), {},
                 [&](std::size_t i) { made[i] = make_creased_solid(input, wanted[i]); });
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (!made[i]) {
        if (wanted[i].size() > 1)
          made_.left_sharp.insert(made_.left_sharp.end(), wanted[i].begin(), wanted[i].end());
        continue;
      }
      made_.bands.insert(made_.bands.end(), made[i]->bands.begin(), made[i]->bands.end());
      for (const std::uint32_t s : wanted[i]) join(s, wanted[i].front(), made[i]->solid.radius);
      made_.clamped.insert(made_.clamped.end(), made[i]->clamped.begin(), made[i]->clamped.end());
      data_.creased.push_back(std::make_unique<const CreasedSolid>(std::move(made[i]->solid)));
      plain_.push_back({wanted[i].front(), false, std::move(made[i]->plain)});
    }
  }

  // Makes a shell part of the creased solid to come, in coordinates relative to the outer one's centre.
  void join(std::uint32_t s, std::uint32_t outer, double radius) {
    Solid& solid = data_.solids[s];
    solid.creased = std::uint32_t(data_.creased.size());
    solid.radius = radius;
    solid.convex = solid.exact = false;
    if (s == outer) return;
    solid.hollow = true;
    const Vec3d shift = solid.center - data_.solids[outer].center;
    for (std::uint32_t f = solid.first_face; f < solid.first_face + solid.face_count; ++f) {
      data_.faces[f].d += dot(in_.regions.planes[f].normal, shift);
    }
    solid.center = data_.solids[outer].center;
    solid.size = data_.solids[outer].size;
  }

  // The space outside solids, rounded along its convex edges.
  void make_filled_solids() {
    if (in_.outside == nullptr) return;
    std::vector<std::uint32_t> wanted;
    for (std::uint32_t s = 0; s < data_.solids.size(); ++s) {
      const Shell& shell = in_.welded.shells[s];
      if (shell.closed && fillets_of(s) > 0) wanted.push_back(s);
    }
    std::vector<double> radii(in_.radii.size());
    for (std::uint32_t h = 0; h < radii.size(); ++h) radii[turned_edge(h)] = in_.radii[h];
    const CreasedInput input{in_.mesh,
                             in_.outside->welded,
                             in_.outside->regions,
                             in_.outside->kinds,
                             in_.options.radius,
                             in_.options.on_overlap,
                             radii,
                             true};
    std::vector<std::optional<MadeCreased>> made(wanted.size());
    parallel_for(wanted.size(), {}, [&](std::size_t i) {
      made[i] = make_creased_solid(input, std::span(wanted).subspan(i, 1),
                                   data_.solids[wanted[i]].center);
    });
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (!made[i]) continue;
      covers_.insert(covers_.end(), made[i]->bands.begin(), made[i]->bands.end());
      for (const ClampedPart& part : made[i]->clamped) {
        made_.clamped.push_back(
            {turned_edge(part.half_edge), part.radius, 1 - part.to, 1 - part.from});
      }
      plain_.push_back({wanted[i], true, std::move(made[i]->plain)});
      fill(wanted[i], std::move(made[i]->solid), plain_.back().creases);
    }
    made_.bands.insert(made_.bands.end(), covers_.begin(), covers_.end());
  }

  // What rays meet along most of the edges of creased and filled solids.
  void list_plain_creases() {
    if (plain_.empty()) return;
    PlainLists lists(in_.mesh, covers_);
    for (const SolidCreases& of : plain_) {
      const Solid& solid = data_.solids[of.solid];
      lists.add(of.is_fillet ? data_.filled[solid.filled]->outside : *data_.creased[solid.creased],
                solid.center, of.creases, of.is_fillet);
    }
    lists.put_into(data_);
  }

  void fill(std::uint32_t s, CreasedSolid outside, std::span<const PlainCrease> plain) {
    Solid& solid = data_.solids[s];
    solid.filled = std::uint32_t(data_.filled.size());
    data_.filled.push_back(std::make_unique<const FilledSolid>(std::move(outside), plain));
    made_.filled_edges += fillets_of(s);
    std::set<FacePair> edges;  // those between two faces are one
    for_fillets_of(s, [&](std::uint32_t h) {
      const std::uint32_t twin = in_.welded.twin[h];
      edges.insert(std::minmax(in_.regions.region[h / 3], in_.regions.region[twin / 3]));
    });
    data_.report.rounded_edges += edges.size();
    const FilledSolid& filled = *data_.filled.back();
    for (std::uint32_t i = 0; i < filled.fillets.part_count(); ++i) {
      const Box box = filled.fillets.box_of(i);
      const std::uint32_t triangle = triangle_near(filled.outside, (box.low + box.high) * 0.5);
      if (triangle == kNone) continue;
      data_.fillet_boxes.push_back({box.low + solid.center, box.high + solid.center, triangle});
      data_.fillet_parts.push_back({s, i});
    }
  }

  // Visits concave edges that are to have one.
  template <class Visit>
  void for_fillets_of(std::uint32_t s, const Visit& visit) const {
    for_edges_of(EdgeKind::concave, in_.welded, in_.kinds, s, [&](std::uint32_t h) {
      if (in_.radii.empty() || in_.radii[h] > 0) visit(h);
    });
  }
  [[nodiscard]] std::uint64_t fillets_of(std::uint32_t s) const {
    std::uint64_t count = 0;
    for_fillets_of(s, [&](std::uint32_t) { ++count; });
    return count;
  }

  // One of the caller's, of the nearest face.
  [[nodiscard]] std::uint32_t triangle_near(const CreasedSolid& solid, Vec3d x) const {
    std::uint32_t region = kNone;
    double least = INFINITY;
    const Vec3d reach(2 * solid.radius);
    solid.surface.for_each_near(x - reach, x + reach, [&](const SurfaceTriangle& t) {
      const double distance = length(x - nearest_on_triangle(x, t));
      if (distance >= least || in_.triangle_begin[t.region] == in_.triangle_begin[t.region + 1])
        return;
      least = distance;
      region = t.region;
    });
    return region == kNone ? kNone : in_.triangles[in_.triangle_begin[region]];
  }

  struct SolidCreases {
    std::uint32_t solid;
    bool is_fillet;
    std::vector<PlainCrease> creases;
  };

  const ExactInput& in_;
  Rounding::Data& data_;
  std::vector<TriangleBand> covers_;  // those of fillets
  std::vector<SolidCreases> plain_;
  MadeExact made_;
};

}  // namespace

MadeExact make_exact_solids(const ExactInput& input, Rounding::Data& data) {
  return ExactMaker(input, data).make();
}

}  // namespace arris
