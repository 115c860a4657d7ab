// ids.h — names for the things of a scene
#pragma once

#include <compare>
#include <cstdint>

namespace arris {

// Index into one of the scene's arrays; the tag keeps the arrays apart.
template <class Tag>
struct Id {
  std::uint32_t index = 0;
  friend constexpr auto operator<=>(Id, Id) = default;
};
using MeshId = Id<struct MeshTag>;
using CsgId = Id<struct CsgTag>;
using MaterialId = Id<struct MaterialTag>;
using TextureId = Id<struct TextureTag>;
using ObjectId = Id<struct ObjectTag>;

}  // namespace arris
