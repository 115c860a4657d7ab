// nearest_pieces.h — what along an event is nearest to the light
// What       keeps, for each s in [0, 1], the segment of those inserted that has the highest nearness; nearness is
//            linear in s along each segment
// Guarantee  pieces are sorted by s and do not overlap; ends of segments stay as they are. The same segments make the
//            same pieces, bit for bit, in whatever order they come, as who is nearer is decided on whole segments,
//            which never change; but where three and more lie within rounding of each other
//            (tests/edgepoint/nearest_pieces_test.cpp).
// Cost       of an insertion: a binary search, and the pieces that it changes or moves
// Source     Bala, Walter, Greenberg 2003, section 6.5, "Clipping": shadow edges of one event against each other, in
//            one dimension
// Legend     s position along the event; k nearness at its two ends
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace arris {

// Where an event meets a face.
struct EventSegment {
  double s0 = 0, s1 = 0;  // s0 < s1
  double k0 = 0, k1 = 0;
  std::uint32_t receiver = 0, face = 0;

  // What the compiler makes of it compares with 0.
  // NOLINTNEXTLINE(modernize-use-nullptr)
  friend auto operator<=>(const EventSegment&, const EventSegment&) = default;
  [[nodiscard]] double nearness(double s) const {
    return s <= s0 ? k0 : s >= s1 ? k1 : k0 + (k1 - k0) * ((s - s0) / (s1 - s0));
  }
};

// Of a segment, what is nearest.
struct EventPiece {
  double s0 = 0, s1 = 0;
  EventSegment of;

  friend bool operator==(const EventPiece&, const EventPiece&) = default;
  [[nodiscard]] double nearness(double s) const { return of.nearness(s); }
};

// Shorter pieces are not kept: along s, of [0, 1]. Far below what a float position tells.
inline constexpr double kShortestPiece = 1e-9;

class NearestPieces {
 public:
  // Of `pieces`, which others have made.
  void assign(std::span<const EventPiece> pieces);
  // Whether anything of it is nearest.
  bool insert(const EventSegment& segment);
  [[nodiscard]] const std::vector<EventPiece>& pieces() const { return pieces_; }
  // What is less near everywhere cannot show; −infinity while a part of [0, 1] is not covered.
  [[nodiscard]] double least_nearness() const { return least_; }

 private:
  void update_least();

  std::vector<EventPiece> pieces_;
  std::vector<EventPiece> changed_;
  double least_ = -std::numeric_limits<double>::infinity();
};

}  // namespace arris
