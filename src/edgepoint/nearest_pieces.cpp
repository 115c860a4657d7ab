#include "edgepoint/nearest_pieces.h"

#include <algorithm>
#include <compare>
#include <tuple>

namespace arris {
namespace {

// Appends the part of a segment from s0 to s1, to the one before if that is its beginning.
void append(std::vector<EventPiece>& to, const EventSegment& segment, double s0, double s1) {
  if (!(s0 < s1)) return;
  if (!to.empty() && to.back().s1 == s0 && to.back().of == segment) {
    to.back().s1 = s1;
    return;
  }
  to.push_back({s0, s1, segment});
}

// Of segments that are equally near, this one is taken.
bool comes_first(const EventSegment& a, const EventSegment& b) {
  return std::tie(a.receiver, a.face, a.s0, a.s1) < std::tie(b.receiver, b.face, b.s0, b.s1);
}

// Appends the nearer of two segments from s0 to s1, where both are. Where they cross is found from all that they share,
// so that it does not depend on what hides some of it.
void append_nearer(std::vector<EventPiece>& to, const EventSegment& one, const EventSegment& other,
                   double s0, double s1) {
  if (!(s0 < s1)) return;
  const bool ordered = comes_first(one, other);
  const EventSegment &a = ordered ? one : other, &b = ordered ? other : one;
  const double begin = std::max(a.s0, b.s0), end = std::min(a.s1, b.s1);
  const double d0 = b.nearness(begin) - a.nearness(begin), d1 = b.nearness(end) - a.nearness(end);
  if (d0 <= 0 && d1 <= 0) {
    append(to, a, s0, s1);
  } else if (d0 >= 0 && d1 >= 0) {
    append(to, b, s0, s1);
  } else {
    const double crossing = std::clamp(begin + (end - begin) * (d0 / (d0 - d1)), s0, s1);
    append(to, d0 > 0 ? b : a, s0, crossing);
    append(to, d0 > 0 ? a : b, crossing, s1);
  }
}

}  // namespace

void NearestPieces::assign(std::span<const EventPiece> pieces) {
  pieces_.assign(pieces.begin(), pieces.end());
  update_least();
}

bool NearestPieces::insert(const EventSegment& segment) {
  const auto first = std::ranges::lower_bound(
      pieces_, segment.s0, [](double s1, double s0) { return s1 <= s0; }, &EventPiece::s1);
  changed_.clear();
  double at = segment.s0;
  auto last = first;
  for (; last != pieces_.end() && last->s0 < segment.s1; ++last) {
    append(changed_, segment, at, last->s0);
    append(changed_, last->of, last->s0, std::min(at, last->s1));
    const double s0 = std::max(at, last->s0), s1 = std::min(segment.s1, last->s1);
    append_nearer(changed_, last->of, segment, s0, s1);
    append(changed_, last->of, s1, last->s1);
    at = s1;
  }
  append(changed_, segment, at, segment.s1);
  if (std::equal(first, last, changed_.begin(), changed_.end())) return false;

  const auto replaced = last - first, kept = std::min(replaced, std::ptrdiff_t(changed_.size()));
  const auto rest = std::copy_n(changed_.begin(), kept, first);
  if (kept < replaced) {
    pieces_.erase(rest, last);
  } else {
    pieces_.insert(rest, changed_.begin() + kept, changed_.end());
  }
  update_least();
  return true;
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
    least = std::min({least, p.nearness(p.s0), p.nearness(p.s1)});
  }
  least_ = at < 1 - kShortestPiece ? kNotCovered : least;
}

}  // namespace arris
