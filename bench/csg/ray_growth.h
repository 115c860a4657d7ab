// ray_growth.h — what single rays through CSG solids cost
// What       growth: random solids of 10² to 10⁵ primitives in a cube, differences among them; holes: a plate with 400
//            holes as one difference against 400 tiles with a hole each, and against the plate alone. Times are of
//            closest hits and of occlusion, in rounds in which every scene has its turn; ratios pair times of one
//            round.
#pragma once

namespace arris::bench {

struct RayGrowthSettings {
  int rounds = 7;
  int rays = 100'000;
  int largest = 100'000;
};

void run_ray_growth(const RayGrowthSettings& settings);

}  // namespace arris::bench
