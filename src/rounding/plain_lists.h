// plain_lists.h — the plain stretches of creases whose voids reach into each triangle
// What       One list for all solids of a mesh. Where a fillet lies on the faces beside a stretch of the solid itself,
//            the stretch ends: rays that leave there come into the fillet.
// Cost       the triangles near each crease; on all cores
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rounding/bands.h"
#include "rounding/plain_crease.h"
#include "rounding/rounding_data.h"

namespace arris {

class PlainLists {
 public:
  // covers: bands of fillets.
  PlainLists(const MeshView& mesh, std::span<const TriangleBand> covers);

  // Of the solid around `center`, or of the space outside. Both live until all is put.
  void add(const CreasedSolid& solid, Vec3d center, std::span<const PlainCrease> creases,
           bool is_fillet);
  void put_into(Rounding::Data& data) const;

 private:
  struct Asked {
    const CreasedSolid* solid;
    Vec3d center;
    const PlainCrease* crease;
    bool is_fillet;
  };
  struct Listed {
    PlainCrease crease;  // what is left of it
    std::vector<std::uint32_t> triangles;
  };

  void list(const Asked& asked, std::vector<Listed>& listed) const;

  const MeshView& mesh_;
  std::vector<std::uint32_t> cover_begin_;  // per triangle, and one more; empty: no fillets
  std::vector<Band> covers_;
  std::vector<Asked> asked_;
};

}  // namespace arris
