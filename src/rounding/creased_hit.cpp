#include "rounding/creased_hit.h"

#include <algorithm>
#include <utility>

#include "rounding/plain_crease.h"

namespace arris {
namespace {

// One solid's rounding, whatever its shape, as hits on its mesh need it. Either part may be missing.
class CreasedHit {
 public:
  CreasedHit(const Rounding::Data& data, const Solid& solid, const FaceHit& at, RayStart start)
      : data_(data),
        solid_(solid),
        at_(at),
        start_(start),
        normal_(data.faces[at.face].normal),
        entering_(dot(normal_, at.direction) < 0),
        inner_(solid.creased == kNone ? nullptr : data.creased[solid.creased].get()),
        filled_(solid.filled == kNone ? nullptr : data.filled[solid.filled].get()) {}

  // Most hits beside edges end here: those beside a plain stretch of a crease. Nothing: resolve() decides.
  [[nodiscard]] std::optional<Resolution> settle_plainly(const MeshHit& hit) const {
    for (const std::uint32_t index : plain_creases_on(data_, hit.triangle)) {
      const PlainCrease& crease = data_.plain[index];
      const CreasedSolid* const solid = crease.is_fillet ? &filled_->outside : inner_;
      const bool backwards = entering_ == crease.is_fillet;
      const Vec3d direction = backwards ? -at_.direction : at_.direction;
      const std::optional<PlainCrossing> crossing =
          cross_plainly(crease, *solid, at_.face, {at_.x, direction});
      if (!crossing) continue;
      const double along = crossing->t / at_.scale;
      const double t = backwards ? at_.t - along : at_.t + along;
      if (crease.is_fillet) return onto_fillet(*crossing, t);
      return beside_crease(*crossing, t);
    }
    return std::nullopt;
  }

  // Nothing: the local network decides.
  [[nodiscard]] std::optional<Resolution> resolve(const Ray& ray, const MeshHit& hit) const {
    // Out of a void. That of a local rounding: the solid is closed, and its inside is not met.
    if (!entering_ && start_ == RayStart::outside) {
      return inner_ == nullptr ? make(Resolution::Outcome::passed, at_.t, normal_, Feature::face)
                               : out_of_void(ray, hit);
    }
    const bool kept = inner_ == nullptr || inner_->is_kept(place_of(hit), at_.x, normal_, at_.face);
    if ((entering_ || kept) && is_covered(hit)) return through_fillet(kept);
    if (kept && entering_ && start_ == RayStart::inside) {
      if (const auto side = out_of_fillet(ray)) return side;
    }
    if (inner_ == nullptr) return std::nullopt;
    if (kept) return stay();
    return entering_ ? into_void() : from_inside();
  }

 private:
  [[nodiscard]] const Face& face() const { return data_.faces[at_.face]; }

  static MeshPlace place_of(const MeshHit& hit) { return {hit.triangle, hit.u, hit.v}; }
  [[nodiscard]] Resolution stay() const {
    return make(Resolution::Outcome::kept, at_.t, normal_, Feature::face);
  }

  // Whether a fillet lies on the face.
  [[nodiscard]] bool is_covered(Vec3d x, std::uint32_t face) const {
    return filled_ != nullptr &&
           !filled_->outside.is_kept(x, -Vec3d(data_.faces[face].normal), face);
  }
  [[nodiscard]] bool is_covered(const MeshHit& hit) const {
    return filled_ != nullptr &&
           !filled_->outside.is_kept(place_of(hit), at_.x, -normal_, at_.face);
  }

  [[nodiscard]] Resolution make(Resolution::Outcome outcome, double t, Vec3d normal,
                                Feature feature) const {
    Resolution out;
    out.outcome = outcome;
    out.hit = {t, normal, feature};
    if (feature == Feature::edge || feature == Feature::corner) out.hit.solid = face().solid;
    return out;
  }
  static Feature feature_of(const PipeHit& met) {
    return met.at_end ? Feature::corner : Feature::edge;
  }

  // From outside into a fillet, or from a solid whose convex edges stay sharp out of one.
  [[nodiscard]] std::optional<Resolution> onto_fillet(const PlainCrossing& crossing,
                                                      double t) const {
    const bool leaves_void = !entering_ && (inner_ != nullptr || start_ == RayStart::outside);
    const bool is_ahead = t * at_.scale > filled_->outside.tolerance;
    if (leaves_void || !is_ahead || !crossing.normal) return std::nullopt;
    return make(Resolution::Outcome::moved, t, -*crossing.normal, Feature::fillet);
  }

  // t: where the pipe is met, or the void ends.
  [[nodiscard]] std::optional<Resolution> beside_crease(const PlainCrossing& crossing,
                                                        double t) const {
    if (!entering_ && start_ == RayStart::outside) {
      // It began in the void, or it is not known how it came there.
      if (t * at_.scale > inner_->tolerance) return std::nullopt;
      return make(Resolution::Outcome::passed, at_.t, normal_, Feature::face);
    }
    if (crossing.normal)
      return make(Resolution::Outcome::moved, t, *crossing.normal, Feature::edge);
    return make(Resolution::Outcome::passed, at_.t, normal_, Feature::face);
  }

  // From the fillet into the solid, or the other way.
  [[nodiscard]] Resolution through_fillet(bool kept) const {
    const Vec3d into_fillet = entering_ ? -at_.direction : at_.direction;
    const auto [met, exit] = filled_->outside.cross_void(at_.x, into_fillet);
    const double along = met ? met->t / at_.scale : 0;
    const double t = entering_ ? at_.t - along : at_.t + along;
    if (met && t >= 0) return make(Resolution::Outcome::moved, t, -met->normal, Feature::fillet);
    const bool is_beside =
        !met && (exit.region == kNone || !is_covered(at_.x + into_fillet * exit.t, exit.region));
    if (entering_ && (start_ == RayStart::outside || is_beside)) {
      // From the fillet's far side into the void, or, by rounding errors, from its surface or beside it: then the face
      // stands.
      return kept ? stay() : into_void();
    }
    if (!kept) return make(Resolution::Outcome::moved, at_.t, -normal_, Feature::fillet);
    return make(Resolution::Outcome::passed, at_.t, normal_, Feature::fillet);
  }

  // A ray that starts in a fillet and comes to a face from outside has left the fillet by its side, in a gap.
  [[nodiscard]] std::optional<Resolution> out_of_fillet(const Ray& ray) const {
    if (filled_ == nullptr) return std::nullopt;
    const auto met = filled_->outside.cross_void(ray.origin - solid_.center, at_.direction).met;
    if (!met || met->t > at_.t * at_.scale + filled_->outside.tolerance) return std::nullopt;
    return make(Resolution::Outcome::moved, std::min(met->t / at_.scale, at_.t), -met->normal,
                Feature::fillet);
  }

  [[nodiscard]] Resolution out_of_void(const Ray& ray, const MeshHit& hit) const {
    const Resolution passed = make(Resolution::Outcome::passed, at_.t, normal_, Feature::face);
    // A ray from the face, or from a fillet that has no thickness there, may start behind it.
    if (at_.t * at_.scale <= inner_->tolerance) return passed;
    const Vec3d origin = ray.origin - solid_.center;
    // Hits are judged in any order: this one may lie beyond where the ray enters again.
    const double tolerance = inner_->tolerance, end = at_.t * at_.scale - tolerance;
    if (inner_->surface.is_entered(origin, at_.direction, tolerance, end)) return passed;
    if (const auto met = inner_->cross_void(origin, at_.direction).met) {
      return make(Resolution::Outcome::moved, met->t / at_.scale, met->normal, feature_of(*met));
    }
    return is_covered(hit) ? make(Resolution::Outcome::moved, at_.t, -normal_, Feature::fillet)
                           : passed;
  }

  // Beyond the void there may be a fillet.
  [[nodiscard]] Resolution into_void() const {
    const auto [met, exit] = inner_->cross_void(at_.x, at_.direction);
    if (met) {
      return make(Resolution::Outcome::moved, at_.t + met->t / at_.scale, met->normal,
                  feature_of(*met));
    }
    if (exit.region != kNone && is_covered(at_.x + at_.direction * exit.t, exit.region)) {
      return make(Resolution::Outcome::moved, at_.t + exit.t / at_.scale,
                  -Vec3d(data_.faces[exit.region].normal), Feature::fillet);
    }
    return make(Resolution::Outcome::passed, at_.t, normal_, Feature::face);
  }

  // Looked at backwards.
  [[nodiscard]] Resolution from_inside() const {
    const auto met = inner_->cross_void(at_.x, -at_.direction).met;
    if (!met) return make(Resolution::Outcome::passed, at_.t, normal_, Feature::face);
    return make(Resolution::Outcome::moved, at_.t - met->t / at_.scale, met->normal,
                feature_of(*met));
  }

  const Rounding::Data& data_;
  const Solid& solid_;
  const FaceHit& at_;
  RayStart start_;
  Vec3d normal_;
  bool entering_;
  const CreasedSolid* inner_;
  const FilledSolid* filled_;
};

}  // namespace

std::optional<Resolution> resolve_creased(const Rounding::Data& data, const Solid& solid,
                                          const CreasedEvent& event) {
  const CreasedHit creased(data, solid, event.at, event.start);
  const std::optional<Resolution> found = creased.settle_plainly(event.hit);
  return found ? found : creased.resolve(event.ray, event.hit);
}

}  // namespace arris
