// fillets.h — the fillets of a solid's concave edges, as a ray meets them
// What       What closing(P) adds to P is the void of the space outside P, beside the pipes around that space's
//            creases (creased_solid.h). Along a concave edge a ray that enters a fillet meets the mesh behind it; at a
//            fillet's end it may leave again without: so each part of a pipe, in a box, is met on its own.
// In / Out   coordinates relative to the solid's centre
// Legend     c point of a crease; r radius; x = c + r n on its pipe. There the fillet begins iff n lies in the cone of
//            the directions in which the ball around c touches the mesh, and no other ball holds x. Between
//            walls that are too near to each other for the ball, air stays as material does (thin_walls.h).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rounding/contacts.h"
#include "rounding/creased_solid.h"
#include "rounding/plain_crease.h"

namespace arris {

struct FilletCrossing {
  double t = 0;
  Vec3d normal;           // unit, outward: from the fillet into the ball
  bool entering = false;  // the fillet
};

class Fillets {
 public:
  // `outside`: the creased solid of the space outside; plain: stretches of its creases.
  Fillets(const CreasedSolid& outside, std::span<const PlainCrease> plain);

  [[nodiscard]] std::size_t part_count() const { return parts_.size(); }
  // Holds the fillet's surface along one part.
  [[nodiscard]] Box box_of(std::uint32_t part) const {
    return {parts_[part].low, parts_[part].high, part};
  }

  // Where a ray crosses one part's surface of the fillets, within ]t_min, t_max[: the first place of those wanted.
  struct Wanted {
    double t_min, t_max;
    bool entries, exits;
  };
  [[nodiscard]] std::optional<FilletCrossing> meet(std::uint32_t index, Vec3d origin,
                                                   Vec3d direction, const Wanted& wanted) const;
  [[nodiscard]] std::size_t bytes() const { return parts_.size() * sizeof(Part); }

 private:
  struct Part {
    std::uint32_t pipe;  // CreasePipes'
    // Where the balls around a segment touch: the same all along it.
    bool has_sides = false;
    Vec3d side_a, side_b;
    bool among_walls = false;  // what lies behind it may be air that stays
    // Of the curve, where no other pipe is near.
    double plain0 = 0, plain1 = 0;
    Vec3d low{}, high{};  // see box_of()
  };

  [[nodiscard]] bool is_among_walls(const CreaseCurve& curve) const;
  void set_box(Part& part) const;
  [[nodiscard]] Contacts contacts_at(const CreaseCurve& curve, double u) const;
  [[nodiscard]] bool begins_at(const Part& part, const PipePlace& place) const;

  const CreasedSolid* outside_;
  std::vector<Part> parts_;
  bool any_among_walls_ = false;
};

}  // namespace arris
