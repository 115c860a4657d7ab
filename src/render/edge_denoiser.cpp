#include "render/edge_denoiser.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "base/parallel_for.h"
#include "base/sobol.h"
#include "edgepoint/antialias.h"
#include "edgepoint/frame_maker.h"
#include "edgepoint/reach_filter.h"
#include "render/camera.h"
#include "render/edge_objects.h"
#include "render/film.h"
#include "render/pixel_filter.h"
#include "render/shadow_finder.h"
#include "render/shadow_probe.h"
#include "render/texture_tints.h"

namespace arris {
namespace {

constexpr std::uint32_t kShadowSeed = 0x2545f491;  // other numbers than the paths'
constexpr std::size_t kMostEvents = 1'000'000;     // about 3 s
constexpr float kLeastAlbedo = 0.02F;
// Residues are alike that are not further apart than so many standard deviations; squared.
constexpr float kResiduesApart2 = 4;
// Part of the variance of a mean residue that is taken off it.
constexpr float kClear2 = 1;
// Ends of edges are known to an eighth of a pixel: so much of a pixel is on the wrong side, squared.
constexpr float kCoarse2 = 0.03F * 0.03F;

using Pixels = std::vector<NoisyPixel>;

Rgb color_at(const Image& image, std::size_t pixel) {
  return {image.values[3 * pixel], image.values[3 * pixel + 1], image.values[3 * pixel + 2]};
}

void set_color_at(Image& image, std::size_t pixel, Rgb color) {
  image.values[3 * pixel] = color.x;
  image.values[3 * pixel + 1] = color.y;
  image.values[3 * pixel + 2] = color.z;
}

Rgb divided(Rgb a, Rgb b) {
  return {a.x / b.x, a.y / b.y, a.z / b.z};
}

// Where area lights throw shadows light changes gradually: their borders would only be in the way.
bool is_sharp(const ShadowLight& light) {
  return std::holds_alternative<HomogeneousPoint>(light);
}

// Edges of the picture, and on which side of them each pixel lies.
class EdgePicture {
 public:
  EdgePicture(const PreparedScene& scene, const DenoiseSettings& settings)
      : scene_(scene),
        settings_(settings),
        image_(scene.scene().image),
        camera_(make_camera_rays(*scene.scene().camera, image_)),
        maker_(image_.width_px, image_.height_px) {
    const PixelView view{Vec3d(camera_.position),
                         inverse(Mat3d{camera_.step_x, camera_.step_y, camera_.corner}),
                         image_.width_px, image_.height_px};
    const EdgeObjects objects(scene, settings.threads, Creases::left_out);
    FoundEdges edges;
    objects.find_edges(scene, view, settings.threads, edges);
    ShadowFinder shadows;
    std::vector<ShadowTriple> triples;
    PointCache cache = look(triples);
    shadows.add(triples);
    shadows.update(scene, objects, kMostEvents);
    Image unused(image_.width_px, image_.height_px, 3);
    maker_.make(view, {edges.lists(), *shadows.edges()}, cache,
                {0, false, settings.threads, {}, false, false}, unused);
  }

  [[nodiscard]] const EdgePointImage& image() const { return maker_.image(); }
  [[nodiscard]] const CameraRays& camera() const { return camera_; }

 private:
  struct Row {
    std::vector<ShadedPoint> points;
    std::vector<ShadowTriple> triples;
  };

  // A point in the middle of each pixel, and what stands between it and a light.
  PointCache look(std::vector<ShadowTriple>& triples) const {
    std::vector<ShadowLight> lights = shadow_lights(scene_);
    if (std::none_of(lights.begin(), lights.end(), is_sharp)) lights.clear();
    std::vector<Row> rows(std::size_t(image_.height_px));
    parallel_for(rows.size(), {.grain = 4, .threads = settings_.threads}, [&](std::size_t y) {
      for (int x = 0; x < image_.width_px; ++x) look_at(x, int(y), lights, rows[y]);
    });
    PointCache cache(rows.size() * std::size_t(image_.width_px));
    for (const Row& row : rows) {
      cache.add(row.points, 0);
      triples.insert(triples.end(), row.triples.begin(), row.triples.end());
    }
    return cache;
  }

  void look_at(int x, int y, const std::vector<ShadowLight>& lights, Row& row) const {
    const TraceRay ray = camera_ray(camera_, x + 0.5, y + 0.5);
    const std::optional<SurfaceHit> hit = scene_.intersect(ray);
    ShadedPoint point;
    point.position = hit ? hit->position : ray.direction;
    if (hit) point.object = hit->object.index;
    row.points.push_back(point);
    if (!hit || lights.empty()) return;
    Sampler sampler(settings_.seed ^ kShadowSeed, std::uint32_t(x), std::uint32_t(y), 0);
    const ShadowProbe probe{ray, sampler.next_1d(), sampler.next_2d()};
    const std::optional<ShadowTriple> triple = probe_shadow(scene_, lights, probe);
    if (triple && is_sharp(lights[triple->light])) row.triples.push_back(*triple);
  }

  const PreparedScene& scene_;
  const DenoiseSettings& settings_;
  const ImageSettings& image_;
  CameraRays camera_;
  FrameMaker maker_;
};

struct Regions {
  Rgb primary, secondary;
};

// The colours of primary regions, a plane for each channel and one of what is known; a row of nothing above and below.
class RegionPlanes {
 public:
  RegionPlanes(int width, int height) : width_(std::size_t(width)) {
    for (auto& plane : values_) plane.resize(width_ * std::size_t(height + 2));
  }

  void set(std::size_t pixel, Rgb color, bool known) {
    for (int c = 0; c < 3; ++c) values_[std::size_t(c)][pixel + width_] = color[c];
    values_[3][pixel + width_] = known ? 1.0F : 0.0F;
  }
  [[nodiscard]] PrimaryRows row(int y) {
    const std::size_t at = std::size_t(y + 1) * width_;
    return {{values_[0].data() + at, values_[1].data() + at, values_[2].data() + at},
            values_[3].data() + at};
  }

 private:
  std::array<std::vector<float>, 4> values_;
  std::size_t width_;
};

constexpr int kCells = 4;  // along a side of a pixel
using CellTable = std::array<float, std::size_t(kCells* kCells)>;

// By edge code: how much of each cell is region A.
const std::vector<CellTable>& cell_tables() {
  static const std::vector<CellTable> kTables = [] {
    constexpr int kFine = 8;  // places along a side of a cell
    std::vector<CellTable> tables(kEdgeCodes);
    for (std::uint32_t code = 0; code < kEdgeCodes; ++code) {
      const Vec2d p = boundary_point((first_end(code) + 0.5) / 8),
                  q = boundary_point((last_end(code) + 0.5) / 8);
      for (int i = 0; i < kCells * kFine * kCells * kFine; ++i) {
        const int column = i % (kCells * kFine), line = i / (kCells * kFine);
        const double x = (column + 0.5) / (kCells * kFine) - p.x;
        const double y = (line + 0.5) / (kCells * kFine) - p.y;
        // Clockwise from the first end to the second lies on the left of the edge.
        if ((q.x - p.x) * y - (q.y - p.y) * x < 0) {
          tables[code][std::size_t(line / kFine * kCells + column / kFine)] +=
              1.0F / (kFine * kFine);
        }
      }
    }
    return tables;
  }();
  return kTables;
}

// The filter's masses in the cells of three pixels along an axis.
std::array<float, std::size_t(3 * kCells)> cell_weights(ImageSettings::Filter filter) {
  constexpr int kSteps = 64;  // of a cell
  std::array<float, std::size_t(3 * kCells)> weights{};
  double whole = 0;
  for (int i = 0; i < 3 * kCells * kSteps; ++i) {
    const double value = eval_filter(filter, (i + 0.5) / (kCells * kSteps) - 1.5);
    weights[std::size_t(i / kSteps)] += float(value);
    whole += value;
  }
  for (float& weight : weights) weight /= float(whole);
  return weights;
}

class Denoiser {
 public:
  Denoiser(const PreparedScene& scene, const Image& noisy, const Image& squares,
           const DenoiseSettings& settings)
      : scene_(scene),
        noisy_(noisy),
        squares_(squares),
        settings_(settings),
        edges_(scene, settings) {}

  Image run() {
    see_surfaces();
    Pixels light(albedos_.size());
    for (std::size_t i = 0; i < light.size(); ++i) {
      light[i] = {divided(color_at(noisy_, i), albedos_[i]),
                  divided(variance_at(i), albedos_[i] * albedos_[i]), normals_[i],
                  image().codes[i].is_empty()};
    }
    filter_within_reach(image(), {.threads = settings_.threads}, light);
    return filter_regions(find_regions(light));
  }

 private:
  [[nodiscard]] const EdgePointImage& image() const { return edges_.image(); }

  // Of a pixel's mean.
  [[nodiscard]] Rgb variance_at(std::size_t pixel) const {
    const Rgb mean = color_at(noisy_, pixel), square = color_at(squares_, pixel);
    return max(square - mean * mean, Rgb(0)) *
           (1 / float(std::max<std::uint64_t>(1, settings_.samples - 1)));
  }

  void see_surfaces() {
    albedos_.resize(image().codes.size());
    normals_.resize(albedos_.size());
    const PixelLooks square(scene_.scene(), ImageSettings::Filter::box, settings_.threads);
    parallel_for(std::size_t(noisy_.height_px), {.grain = 4, .threads = settings_.threads},
                 [&](std::size_t row) {
                   const int y = int(row);
                   for (int x = 0; x < noisy_.width_px; ++x) {
                     const Vec2f in = primary_place_of(image(), x, y);
                     const SeenSurface seen = see_surface(scene_, edges_.camera(), square,
                                                          {float(x) + in.x, float(y) + in.y});
                     albedos_[image().offset(x, y)] = max(seen.albedo, Rgb(kLeastAlbedo));
                     normals_[image().offset(x, y)] = seen.normal;
                   }
                 });
  }

  // What a pixel's own mean says beyond what its regions make of it: grooves and roundings within the pixel. `noise`
  // is the variance of that.
  struct Residue {
    Rgb color;
    float noise = 0, coarse = 0;
    bool known = false;
  };

  // What each pixel shows: the colours of its two regions, equal where it has but one.
  [[nodiscard]] std::vector<Regions> find_regions(const Pixels& light) const {
    const int width = noisy_.width_px, height = noisy_.height_px;
    RegionPlanes planes(width, height);
    std::vector<Regions> regions(light.size());
    std::vector<Residue> residues(light.size());
    std::vector<std::uint8_t> is_alone(light.size());
    for (std::size_t i = 0; i < light.size(); ++i) {
      const Rgb color = light[i].known ? light[i].color * albedos_[i] : color_at(noisy_, i);
      planes.set(i, color, light[i].known && !image().codes[i].is_complex());
      regions[i] = {color, color};
    }
    parallel_for(
        std::size_t(height), {.grain = 8, .threads = settings_.threads}, [&](std::size_t row) {
          const int y = int(row);
          const PrimaryNeighborhood rows{planes.row(y - 1), planes.row(y), planes.row(y + 1)};
          for (int x = 0; x < width; ++x) {
            const std::size_t at = image().offset(x, y);
            if (image().codes[at].is_empty()) continue;
            is_alone[at] = image().codes[at].is_complex() || !light[at].known ? 1 : 0;
            if (is_alone[at] != 0) continue;
            if (const auto other = find_secondary_color(image(), x, y, rows)) {
              regions[at].secondary = *other;
              residues[at] = find_residue(at, regions[at]);
            } else {
              is_alone[at] = 1;
            }
          }
        });
    parallel_for(std::size_t(height), {.grain = 8, .threads = settings_.threads},
                 [&](std::size_t row) {
                   for (int x = 0; x < width; ++x) {
                     const std::size_t at = image().offset(x, int(row));
                     if (is_alone[at] == 0) continue;
                     const Rgb color = mean_along_edge(is_alone, x, int(row));
                     regions[at] = {color, color};
                   }
                 });
    add_residues(regions, residues);
    return regions;
  }

  // Of a pixel with a region of which nothing is known, such as a gap of less than a pixel between an outline and a
  // shadow, or with several edges: its own mean, and those of others alike that are crossed likewise.
  [[nodiscard]] Rgb mean_along_edge(std::span<const std::uint8_t> is_alone, int x, int y) const {
    constexpr int kAround = 3;
    const auto noise_at = [&](std::size_t at) {
      const Rgb v = variance_at(at);
      return v.x + v.y + v.z;
    };
    const auto crossings_of = [&](int px, int py) {
      return boundary_mask(image().crossings.of_pixel(px, py));
    };
    const std::uint32_t own_crossings = crossings_of(x, y);
    const auto for_likewise = [&](const auto& call) {
      for (int py = std::max(0, y - kAround); py <= std::min(noisy_.height_px - 1, y + kAround);
           ++py) {
        for (int px = std::max(0, x - kAround); px <= std::min(noisy_.width_px - 1, x + kAround);
             ++px) {
          const std::size_t at = image().offset(px, py);
          if (is_alone[at] != 0 && is_crossed_likewise(crossings_of(px, py), own_crossings)) {
            call(at);
          }
        }
      }
    };
    float count = 0, noise = std::numeric_limits<float>::min();
    for_likewise([&](std::size_t at) {
      noise += noise_at(at);
      ++count;
    });
    const Rgb own = color_at(noisy_, image().offset(x, y));
    Rgb sum;
    float weights = 0;
    for_likewise([&](std::size_t at) {
      const Rgb color = color_at(noisy_, at), d = color - own;
      const float w = std::exp(-dot(d, d) * count / (kResiduesApart2 * noise));
      sum += color * w;
      weights += w;
    });
    return sum * (1 / weights);
  }

  // By edges that cross its boundary where those of the other do, or an eighth beside.
  [[nodiscard]] static bool is_crossed_likewise(std::uint32_t a, std::uint32_t b) {
    const auto wide = [](std::uint32_t mask) {
      return mask | std::rotl(mask, 1) | std::rotr(mask, 1);
    };
    return (a & ~wide(b)) == 0 && (b & ~wide(a)) == 0;
  }

  [[nodiscard]] Residue find_residue(std::size_t pixel, const Regions& regions) const {
    const PixelCode code = image().codes[pixel];
    const float area_a = edge_tables().area_a[code.edge()];
    const float area = code.primary_is_a() ? area_a : 1 - area_a;
    const Rgb joined = regions.primary * area + regions.secondary * (1 - area);
    const Rgb v = variance_at(pixel), apart = regions.primary - regions.secondary;
    const float apart2 = dot(apart, apart), mixed = area * (1 - area) * apart2;
    const float n = float(settings_.samples);
    // How the samples fall on the two regions is part of their variance, though being stratified they miss the areas by
    // less; their number's power of -3/4.
    const float noise = std::max(0.0F, v.x + v.y + v.z - mixed / n) + mixed / (n * std::sqrt(n));
    return {color_at(noisy_, pixel) - joined, noise, kCoarse2 * apart2, true};
  }

  // Along edges residues are alike: the mean of those around that are so.
  [[nodiscard]] Residue filter_residue(const std::vector<Residue>& residues, int x, int y) const {
    constexpr int kAround = 3;
    const Residue& own = residues[image().offset(x, y)];
    Residue mean = own;
    float sum = 1;
    for (int py = std::max(0, y - kAround); py <= std::min(noisy_.height_px - 1, y + kAround);
         ++py) {
      for (int px = std::max(0, x - kAround); px <= std::min(noisy_.width_px - 1, x + kAround);
           ++px) {
        const Residue& other = residues[image().offset(px, py)];
        if (!other.known || (px == x && py == y)) continue;
        const Rgb d = own.color - other.color;
        const float w =
            std::exp(-dot(d, d) / (kResiduesApart2 * (own.noise + other.noise) + 1e-12F));
        mean.color += other.color * w;
        mean.noise += other.noise * (w * w);
        sum += w;
      }
    }
    mean.color *= 1 / sum;
    mean.noise *= 1 / (sum * sum);
    return mean;
  }

  // Adds what is clearly there of residues, and those of single pixels as far as edges are too coarse to know better.
  void add_residues(std::vector<Regions>& regions, const std::vector<Residue>& residues) const {
    parallel_for(std::size_t(noisy_.height_px), {.grain = 8, .threads = settings_.threads},
                 [&](std::size_t row) {
                   for (int x = 0; x < noisy_.width_px; ++x) {
                     const std::size_t at = image().offset(x, int(row));
                     const Residue& own = residues[at];
                     if (!own.known) continue;
                     const Residue mean = filter_residue(residues, x, int(row));
                     const float size = dot(mean.color, mean.color);
                     const float clear =
                         size > kClear2 * mean.noise ? 1 - kClear2 * mean.noise / size : 0.0F;
                     const float even =
                         own.coarse > 0 ? own.coarse / (own.coarse + own.noise) : 0.0F;
                     const Rgb expected = mean.color * clear;
                     const Rgb more = expected + (own.color - expected) * even;
                     regions[at].primary = max(regions[at].primary + more, Rgb{});
                     regions[at].secondary = max(regions[at].secondary + more, Rgb{});
                   }
                 });
  }

  // The picture's filter over 4 × 4 cells of each pixel, which are of the region that covers them.
  [[nodiscard]] Image filter_regions(const std::vector<Regions>& regions) const {
    const std::array<float, 3 * kCells> weights = cell_weights(settings_.filter);
    Image out(noisy_.width_px, noisy_.height_px, 3);
    parallel_for(std::size_t(out.height_px), {.grain = 8, .threads = settings_.threads},
                 [&](std::size_t row) {
                   for (int x = 0; x < out.width_px; ++x) {
                     Rgb sum;
                     for (int i = 0; i < 9; ++i) {
                       sum += filtered_part(regions, weights, {x, int(row), i % 3, i / 3});
                     }
                     set_color_at(out, image().offset(x, int(row)), sum);
                   }
                 });
    return out;
  }

  // Of pixel (x, y) the part that lies in its neighbour (column − 1, line − 1).
  struct Part {
    int x, y, column, line;
  };
  [[nodiscard]] Rgb filtered_part(const std::vector<Regions>& regions,
                                  const std::array<float, 3 * kCells>& weights, Part part) const {
    const int px = std::clamp(part.x + part.column - 1, 0, noisy_.width_px - 1);
    const int py = std::clamp(part.y + part.line - 1, 0, noisy_.height_px - 1);
    const std::size_t at = image().offset(px, py);
    const PixelCode code = image().codes[at];
    const float* const wx = weights.data() + std::ptrdiff_t(part.column * kCells);
    const float* const wy = weights.data() + std::ptrdiff_t(part.line * kCells);
    float whole = 0, of_a = 0;
    for (int j = 0; j < kCells; ++j) {
      for (int i = 0; i < kCells; ++i) {
        const float w = wx[i] * wy[j];
        whole += w;
        if (code.is_simple()) of_a += w * cell_tables()[code.edge()][std::size_t(kCells * j + i)];
      }
    }
    if (!code.is_simple()) return regions[at].primary * whole;
    const Rgb a = code.primary_is_a() ? regions[at].primary : regions[at].secondary;
    const Rgb b = code.primary_is_a() ? regions[at].secondary : regions[at].primary;
    return a * of_a + b * (whole - of_a);
  }

  const PreparedScene& scene_;
  const Image &noisy_, &squares_;
  const DenoiseSettings& settings_;
  EdgePicture edges_;
  std::vector<Rgb> albedos_;
  std::vector<Vec3f> normals_;
};

}  // namespace

// As bright as the squares are, where white is about 1: what is next to nothing is so beside that.
Image denoise_within_edges(const PreparedScene& scene, const Image& noisy, const Image& squares,
                           const DenoiseSettings& settings) {
  const float scale = exposure_scale(scene.scene().image);
  Image scaled = noisy;
  for (float& value : scaled.values) value *= scale;
  Image out = Denoiser(scene, scaled, squares, settings).run();
  for (float& value : out.values) value /= scale;
  return out;
}

}  // namespace arris
