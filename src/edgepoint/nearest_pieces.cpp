#include "edgepoint/nearest_pieces.h"

#include <algorithm>

namespace arris {
namespace {

// Appends the part of a piece from s0 to s1, to the one before if that is its beginning.
void append(std::vector<EventPiece>& to, const EventPiece& piece, double s0, double s1) {
  if (!(s0 < s1)) return;
  if (!to.empty() && to.back().item == piece.item && to.back().s1 == s0) {
    to.back().s1 = s1;
    to.back().k1 = piece.nearness(s1);
    return;
  }
  to.push_back({s0, s1, piece.nearness(s0), piece.nearness(s1), piece.item, piece.receiver});
}

// Appends the nearer of two pieces from s0 to s1, where both are.
void append_nearer(std::vector<EventPiece>& to, const EventPiece& old, const EventPiece& segment,
                   double s0, double s1) {
  const double d0 = segment.nearness(s0) - old.nearness(s0);
  const double d1 = segment.nearness(s1) - old.nearness(s1);
  if (d0 <= 0 && d1 <= 0) {
    append(to, old, s0, s1);
  } else if (d0 >= 0 && d1 >= 0) {
    append(to, segment, s0, s1);
  } else {
    const double crossing = std::clamp(s0 + (s1 - s0) * (d0 / (d0 - d1)), s0, s1);
    append(to, d0 > 0 ? segment : old, s0, crossing);
    append(to, d0 > 0 ? old : segment, crossing, s1);
  }
}

}  // namespace

void NearestPieces::clear() {
  pieces_.clear();
  least_ = -std::numeric_limits<double>::infinity();
}

void NearestPieces::insert(const EventPiece& segment) {
  const auto first = std::ranges::lower_bound(
      pieces_, segment.s0, [](double s1, double s0) { return s1 <= s0; }, &EventPiece::s1);
  changed_.clear();
  double at = segment.s0;
  auto last = first;
  for (; last != pieces_.end() && last->s0 < segment.s1; ++last) {
    append(changed_, segment, at, last->s0);
    append(changed_, *last, last->s0, std::min(at, last->s1));
    const double s0 = std::max(at, last->s0), s1 = std::min(segment.s1, last->s1);
    append_nearer(changed_, *last, segment, s0, s1);
    append(changed_, *last, s1, last->s1);
    at = s1;
  }
  append(changed_, segment, at, segment.s1);

  const auto replaced = last - first, kept = std::min(replaced, std::ptrdiff_t(changed_.size()));
  const auto rest = std::copy_n(changed_.begin(), kept, first);
  if (kept < replaced) {
    pieces_.erase(rest, last);
  } else {
    pieces_.insert(rest, changed_.begin() + kept, changed_.end());
  }
  update_least();
}

void NearestPieces::update_least() {
  constexpr double kNotCovered = -std::numeric_limits<double>::infinity();
  double at = 0, least = std::numeric_limits<double>::infinity();
  for (const EventPiece& p : pieces_) {
    if (p.s0 > at + kShortestPiece) {
      least_ = kNotCovered;
      return;
    }
    at = p.s1;
    least = std::min({least, p.k0, p.k1});
  }
  least_ = at < 1 - kShortestPiece ? kNotCovered : least;
}

}  // namespace arris
