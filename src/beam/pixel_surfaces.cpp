#include "beam/pixel_surfaces.h"

#include <algorithm>

#include "base/hash.h"

namespace arris {

PixelSurfaces::Key PixelSurfaces::key_of(const PixelSurface& s) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  const std::uint32_t mirrors =
      s.mirror_number * 4 + (s.mirror_open ? 2 : 0) + (s.light_open ? 1 : 0);
  if (!s.seen) return {kNone, kNone, kNone, s.lit, s.lit_known, mirrors};
  const std::uint32_t face = s.seen->face * 2 + (s.seen->entering ? 1 : 0);
  return {s.seen->solid, s.seen->leaf, face, s.lit, s.lit_known, mirrors};
}

std::size_t PixelSurfaces::KeyHash::operator()(const Key& key) const {
  std::uint32_t hash = 0;
  for (const std::uint32_t part : key) hash = hash_combine(hash, part);
  return hash;
}

void PixelSurfaces::clear() {
  entries_.clear();
  index_.clear();
}

PixelSurface& PixelSurfaces::entry_of(const PixelSurface& surface) {
  constexpr std::size_t kFewSurfaces = 16;  // of more, an index is faster
  const Key key = key_of(surface);
  if (entries_.size() <= kFewSurfaces) {
    for (PixelSurface& known : entries_) {
      if (key_of(known) == key) return known;
    }
  } else {
    if (index_.empty()) {
      for (std::uint32_t i = 0; i < entries_.size(); ++i) index_[key_of(entries_[i])] = i;
    }
    const auto [at, is_new] = index_.try_emplace(key, std::uint32_t(entries_.size()));
    if (!is_new) return entries_[at->second];
  }
  PixelSurface& added = entries_.emplace_back();
  added.seen = surface.seen;
  added.lit = surface.lit;
  added.lit_known = surface.lit_known;
  added.mirror_open = surface.mirror_open;
  added.light_open = surface.light_open;
  added.mirror_number = surface.mirror_number;
  if (surface.mirror_number != 0) added.mirrors = mirrors_.chain(surface.mirror_number);
  return added;
}

void PixelSurfaces::add(const PixelSurface& surface) {
  PixelSurface& known = entry_of(surface);
  known.lo += surface.lo;
  known.hi += surface.hi;
  known.estimate += surface.estimate;
  known.lit_shares.resize(light_count_);
  for (LitShare& share : known.lit_shares) share.open += surface.estimate;
  known.samples.insert(known.samples.end(), surface.samples.begin(), surface.samples.end());
  if (surface.sample_weight > known.sample_weight) {
    known.seen = surface.seen;  // with the root that is seen there
    known.sample = surface.sample;
    known.sample_weight = surface.sample_weight;
  }
}

void PixelSurfaces::add_estimate(const std::optional<SeenSurface>& seen, Vec2d sample,
                                 double estimate) {
  PixelSurface surface;
  surface.seen = seen;
  surface.sample = sample;
  surface.estimate = surface.sample_weight = estimate;
  add(surface);
}

void PixelSurfaces::clamp_bounds() {
  for (PixelSurface& s : entries_) {
    s.lo = std::clamp(s.lo, 0.0, 1.0);
    s.hi = std::clamp(s.hi, 0.0, 1.0);
  }
}

double PixelSurfaces::open_area() const {
  double open = 0;
  for (const PixelSurface& s : entries_) open += s.hi - s.lo;
  return open;
}

bool PixelSurfaces::is_certified(double tolerance) const {
  return std::ranges::all_of(entries_, [&](const PixelSurface& s) {
    return s.hi - s.lo <= tolerance && !((s.mirror_open || s.light_open) && s.hi > tolerance) &&
           std::ranges::none_of(s.lit_shares, [&](const LitShare& share) {
             return share.hi - share.lo > tolerance || share.doubtful > tolerance;
           });
  });
}

}  // namespace arris
