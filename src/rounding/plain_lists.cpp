#include "rounding/plain_lists.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "base/parallel_collect.h"
#include "rounding/clipped_triangle.h"

namespace arris {
namespace {

// Relative to the radius: a triangle this near to what a void takes away of a face may be hit there.
constexpr double kSlack = 1e-6;
constexpr std::size_t kCreasesAtOnce = 64;

// A linear function of barycentrics (u, v), given as (x, y).
struct Linear {
  double c0, cu, cv;

  [[nodiscard]] double at(Vec3d p) const { return c0 + cu * p.x + cv * p.y; }
};

// What a stretch's void takes away of one of its faces, as far as a triangle has it.
class TriangleStrip {
 public:
  TriangleStrip(const PlainCrease& crease, double radius, std::uint32_t face,
                const std::array<Vec3d, 3>& corners)
      : part_({Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)}) {
    const auto along = [&](Vec3d direction) {
      return Linear{dot(direction, corners[0] - crease.p0), dot(direction, corners[1] - corners[0]),
                    dot(direction, corners[2] - corners[0])};
    };
    s_ = along(crease.axis);
    const Linear above = along(face == crease.face_a ? crease.normal_b : crease.normal_a);
    const double slack = kSlack * radius;
    part_.clip([&](Vec3d p) { return radius * crease.cosine - slack - above.at(p); });
    part_.clip([&](Vec3d p) { return above.at(p) - radius - slack; });
    part_.clip([&](Vec3d p) { return -slack - s_.at(p); });
    part_.clip([&](Vec3d p) { return s_.at(p) - crease.length - slack; });
  }

  [[nodiscard]] bool is_empty() const { return part_.corners().empty(); }

  // Off a stretch that begins with the crease, what the band covers.
  void cut(const Band& band, Stretch& stretch) const {
    ClippedTriangle covered = part_;
    const Linear depth{band.c0, band.cu, band.cv};
    covered.clip([&](Vec3d p) { return -depth.at(p); });
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3d p : covered.corners()) {
      low = std::min(low, s_.at(p));
      high = std::max(high, s_.at(p));
    }
    if (low < high) stretch.cut(low, high);
  }

 private:
  ClippedTriangle part_;
  Linear s_{};
};

// Of the strips that the void takes away of the two faces.
std::pair<Vec3d, Vec3d> box_of(const PlainCrease& crease, double radius) {
  const Vec3d tip = (crease.normal_a + crease.normal_b) * (radius / (1 + crease.cosine));
  const Vec3d a = crease.normal_a * radius, b = crease.normal_b * radius;
  const Vec3d p1 = crease.p0 + crease.axis * crease.length, slack(kSlack * radius);
  return {min(crease.p0, p1) + min(tip, min(a, b)) - slack,
          max(crease.p0, p1) + max(tip, max(a, b)) + slack};
}

}  // namespace

PlainLists::PlainLists(const MeshView& mesh, std::span<const TriangleBand> covers) : mesh_(mesh) {
  if (covers.empty()) return;
  cover_begin_.assign(mesh.triangles.size() + 2, 0);
  for (const TriangleBand& b : covers) ++cover_begin_[b.triangle + 2];
  for (std::size_t t = 2; t < cover_begin_.size(); ++t) cover_begin_[t] += cover_begin_[t - 1];
  covers_.resize(covers.size());
  for (const TriangleBand& b : covers) covers_[cover_begin_[b.triangle + 1]++] = b.band;
  cover_begin_.pop_back();
}

void PlainLists::add(const CreasedSolid& solid, Vec3d center, std::span<const PlainCrease> creases,
                     bool is_fillet) {
  for (const PlainCrease& crease : creases) asked_.push_back({&solid, center, &crease, is_fillet});
}

void PlainLists::list(const Asked& asked, std::vector<Listed>& listed) const {
  const CreasedSolid& solid = *asked.solid;
  PlainCrease crease = *asked.crease;
  crease.is_fillet = asked.is_fillet;
  const bool may_be_covered = !crease.is_fillet && !cover_begin_.empty();
  Stretch stretch{0, crease.length};
  std::vector<std::uint32_t> triangles;
  const auto [low, high] = box_of(crease, solid.radius);
  solid.surface.for_each_near(low, high, [&](const SurfaceTriangle& t) {
    if (t.region != crease.face_a && t.region != crease.face_b) return;
    std::array<Vec3d, 3> corners{t.p0, t.p1, t.p2};
    // Pieces of split triangles are none of the caller's.
    const bool is_callers = t.index < mesh_.triangles.size();
    for (std::size_t k = 0; k < 3 && is_callers; ++k) {
      corners[k] = Vec3d(mesh_.positions[mesh_.triangles[t.index][k]]) - asked.center;
    }
    const TriangleStrip strip(crease, solid.radius, t.region, corners);
    if (strip.is_empty()) return;
    if (is_callers) triangles.push_back(t.index);
    if (!may_be_covered) return;
    if (!is_callers) {
      stretch = {0, 0};  // its covers aren't known
      return;
    }
    for (std::uint32_t i = cover_begin_[t.index]; i < cover_begin_[t.index + 1]; ++i) {
      strip.cut(covers_[i], stretch);
    }
  });
  if (!(stretch.s0 < stretch.s1)) return;
  crease.p0 += crease.axis * stretch.s0;
  crease.length = stretch.s1 - stretch.s0;
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  listed.push_back({crease, std::move(triangles)});
}

void PlainLists::put_into(Rounding::Data& data) const {
  const std::vector<Listed> all = parallel_collect<Listed>(
      asked_.size(), kCreasesAtOnce,
      [&](std::size_t i, std::vector<Listed>& listed) { list(asked_[i], listed); });
  std::vector<std::uint32_t>& begin = data.plain_begin;
  begin.assign(mesh_.triangles.size() + 2, 0);
  for (const Listed& listed : all) {
    data.plain.push_back(listed.crease);
    for (const std::uint32_t t : listed.triangles) ++begin[t + 2];
  }
  for (std::size_t t = 2; t < begin.size(); ++t) begin[t] += begin[t - 1];
  data.plain_on.resize(begin.back());
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    for (const std::uint32_t t : all[i].triangles) data.plain_on[begin[t + 1]++] = i;
  }
  begin.pop_back();
}

}  // namespace arris
