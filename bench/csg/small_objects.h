// small_objects.h — what a picture shows of things smaller than a pixel, against dense sampling
// What       A truth is the mean of 256 rays a pixel on a regular grid, with no noise. The error (RMSE of linear light)
//            is taken on every sixteenth pixel. An object counts as missed if what it adds to the 3 x 3 pixels round
//            it, against the median of those 3 pixels away, is less than a tenth of what it adds in truth, at all its
//            places.
// Limits     640 x 480 pixels, for which objects.json says where they are
#pragma once

#include <string>
#include <vector>

#include "arris/image.h"
#include "arris/render.h"

namespace arris::bench {

inline constexpr int kTruthGrid = 16;  // rays of truth a pixel and side

struct Place {
  int x, y;  // pixel
};
struct SmallObject {
  std::string kind;
  std::vector<Place> places;
};

// Of a scene, from objects.json in the folder.
std::vector<SmallObject> load_small_objects(const std::string& folder, const std::string& scene);

// Our own truth, of the pixels that the functions below look at; the others are -1.
Image make_truth(const PreparedScene& scene, const std::vector<SmallObject>& objects, int threads);
// A picture of kTruthGrid times the size, box filtered.
Image shrink_to_truth(const Image& dense);

double rmse(const Image& image, const Image& truth);

struct Missed {
  int missed = 0, visible = 0;  // visible: of which there is something to see in truth
};
Missed count_missed(const Image& image, const Image& truth,
                    const std::vector<SmallObject>& objects);

}  // namespace arris::bench
