// edge_objects.h — the edges of a prepared scene's objects, ready to be found from any eye
// What       builds the edge tree of every mesh once; objects that share a mesh share it. An edge is drawn as a
//            silhouette, or wherever it can be seen if shading jumps across it: where the faces of a flat mesh turn,
//            where vertex normals, materials or texture coordinates differ on its two sides, or where it is open.
//            Solids of solids have their own edges (csg_edges.h). A frame's edges are found by all threads, each
//            taking shares of the trees.
// Source     Bala, Walter, Greenberg (2003), §6.1, §6.2
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "edgepoint/edge_mesh.h"
#include "edgepoint/edge_raster.h"
#include "edgepoint/edge_tree.h"
#include "edgepoint/face_tree.h"
#include "edgepoint/wedge_walk.h"
#include "render/csg_edges.h"
#include "render/prepared_scene.h"

namespace arris {

struct Sphere {
  Vec3d center;
  double radius = 0;
};

struct EdgeTotals {
  std::uint64_t silhouette = 0, sharp = 0, shadow = 0;
};

// The edges of a frame, and memory that the next one uses again.
class FoundEdges {
 public:
  // In the world.
  [[nodiscard]] std::span<const std::span<const WorldEdge>> lists() const { return spans_; }
  [[nodiscard]] const EdgeTotals& totals() const { return totals_; }

 private:
  friend class EdgeObjects;
  struct List {
    std::vector<WorldEdge> edges;
    std::vector<std::uint32_t> places;  // while a tree is searched
    std::uint64_t sharp = 0;
  };

  std::vector<List> lists_;
  std::vector<std::span<const WorldEdge>> spans_;
  EdgeTotals totals_;
};

// Whether the middle of a narrow rounding is an edge: so that few points, which lie here and there, leave a straight
// border between two faces. Where each pixel is known, it would but hide the rounding.
enum class Creases : std::uint8_t { drawn, left_out };

class EdgeObjects {
 public:
  EdgeObjects(const PreparedScene& prepared, int threads, Creases creases = Creases::drawn,
              const std::atomic<bool>* stop = nullptr);
  ~EdgeObjects();

  // All edges of the picture, and few beside it. The scene is the one this was made of, or one whose objects, camera
  // and lights have moved since.
  void find_edges(const PreparedScene& prepared, const PixelView& view, int threads,
                  FoundEdges& found) const;
  // What shadows need of an object; nothing if it is no mesh. Valid while both are.
  struct Parts {
    const EdgeMesh* mesh = nullptr;
    const EdgeTree* tree = nullptr;
    const FaceTree* faces = nullptr;
    const Affine3d* world = nullptr;            // from the object
    const RoundedGeometry* rounding = nullptr;  // null: sharp
    const FaceVoids* voids = nullptr;           // null: sharp
    // Pairs of faces, the lower first, whose edge is rounded; sorted.
    std::span<const std::pair<std::uint32_t, std::uint32_t>> rounded_between;

    [[nodiscard]] bool is_rounded_between(std::uint32_t face0, std::uint32_t face1) const {
      const std::pair<std::uint32_t, std::uint32_t> key = std::minmax(face0, face1);
      return std::binary_search(rounded_between.begin(), rounded_between.end(), key);
    }
  };
  [[nodiscard]] std::optional<Parts> parts(const PreparedScene& prepared,
                                           std::uint32_t object) const;
  // Of an object that is a solid of solids; else null.
  [[nodiscard]] const CsgEdges* solid(std::uint32_t object) const {
    return object < objects_.size() ? objects_[object].solid.get() : nullptr;
  }
  // These of `before`, with the edges that the roundings of `after` round; null if they are the same.
  [[nodiscard]] std::shared_ptr<const EdgeObjects> with_roundings(const PreparedScene& before,
                                                                  const PreparedScene& after) const;
  // Whether roundings look different; those of an object that has moved may have been made again as they were.
  [[nodiscard]] bool is_rounded_anew(const PreparedScene& before, const PreparedScene& after) const;
  [[nodiscard]] Sphere bounding_sphere(const PreparedScene& prepared, std::uint32_t object) const;

 private:
  struct MeshEdges;
  // painted: of different materials on its two sides, which meet where the mesh's edge is seen. partly: concave, and
  // parts of it lie between sharp and rounded surface.
  enum class RoundedEdge : std::uint8_t { no, yes, painted, partly };
  using KeptParts = std::map<std::uint32_t, std::vector<EdgeEnds>>;
  struct ObjectEdges {
    std::shared_ptr<const MeshEdges> mesh;  // null: no edges are known
    std::shared_ptr<const CsgEdges> solid;  // null: a mesh
    std::uint32_t geometry = kNoGeometry;
    std::vector<RoundedEdge> rounded;  // of the mesh's edges; empty: none
    KeptParts kept;                    // of those that are partly rounded
    std::vector<std::pair<std::uint32_t, std::uint32_t>> rounded_between;  // Parts'
    FaceVoids voids;                                                       // Parts'
  };

  // What one thread does of a frame: an object's solid, or shares of its tree, or its rounded outline.
  struct Task {
    std::uint32_t object = 0;
    std::uint32_t first_share = 0, last_share = 0;
    bool rounded_outline = false;
  };

  void find_solids(const PreparedScene& prepared, int threads, const std::atomic<bool>* stop);
  void make_tasks();
  static void set_rounded(const PreparedScene& prepared, ObjectEdges& object);
  static void find_rounded(const PreparedScene& prepared, ObjectEdges& object);

  void find_solid(const Task& task, const PreparedScene& prepared, const PixelView& view,
                  int threads, FoundEdges::List& found) const;
  void find_shares(const Task& task, const PreparedScene& prepared, const PixelView& view,
                   FoundEdges::List& found) const;

  std::vector<ObjectEdges> objects_;
  std::vector<Task> tasks_;
  Creases creases_;
};

}  // namespace arris
