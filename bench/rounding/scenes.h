// scenes.h — the paper's test scenes, made anew from a seed
// What       Scenes 1 to 3: fields and heaps of small convex solids with 42k, 103k and 252k triangles; Blocks:
//            726 toy bricks with knobs that touch one another, 276k triangles; a Cornell box with rounded
//            inside corners; a bracket, a plate with a boss, one with 400 pockets, and 3,000 brackets, which have
//            concave edges; a camera move over Blocks
// Guarantee  same name, same bytes: own random numbers, no library distributions
// Source     Courtin et al., "Efficient Rendering of Rounded Corners and Edges for Convex Objects", Fig. 8, 9,
//            11 and 12; the scenes themselves are not published, so these are of the same kind and size
#pragma once

#include <string>
#include <vector>

#include "arris/scene.h"

namespace arris::bench {

struct BenchScene {
  std::string name;  // as on the command line
  std::string title;
  Scene scene;        // scene.rounding rounds all objects but those that ask for none
  double radius = 0;  // 0: the objects say it, or it is automatic
};

// Names that make_bench_scene() knows, in the order of the paper's table.
std::vector<std::string> bench_scene_names();
BenchScene make_bench_scene(const std::string& name);

// From a view over all of Blocks down to one brick and away again.
std::vector<Camera> make_camera_move(int frames);

}  // namespace arris::bench
