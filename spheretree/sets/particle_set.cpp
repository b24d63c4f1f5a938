#include "particle_set.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "filling.h"
#include "moments.h"
#include "orchard/geometry/error.h"
#include "overlap.h"
#include "packing.h"

namespace orchard {
namespace {

using detail::ParticleSet;

// Balls are reduced by this share, so that rounding errors of distances are far below what is allowed.
constexpr double kShrinkage = 1e-11;
// The largest radius of a set, over that of the largest ball in the solid. All of these are tried for few balls; for
// many, in this order until the moments fit.
constexpr double kCaps[] = {1, 0.8, 0.65, 0.5, 0.35, 0.22, 0.13, 0.07};
constexpr Index kThorough = 300;  // up to this number of balls, all caps are tried
// Balls that are reduced for the sake of the moments keep at least this share of their volume.
constexpr double kLeastVolume = 0.02;
constexpr int kFits = 4;  // the number of iterations, because a smaller ball also has a smaller moment of its own

double volume_of(double radius) { return 4 * std::numbers::pi / 3 * radius * radius * radius; }

std::vector<double> volumes_of(std::span<const Sphere> balls) {
  std::vector<double> volumes;
  for (const Sphere& ball : balls) volumes.push_back(volume_of(ball.radius));
  return volumes;
}

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

class ParticleSearch {
 public:
  ParticleSearch(const Surface& surface, const SphereSetOptions& options, const Progress& progress)
      : surface_(surface),
        options_(options),
        progress_(progress),
        solid_(union_volume(surface, std::vector<Sphere>{surface.bounding_ball()}).of_solid),
        diagonal_(surface.bounding_box().diagonal().norm()),
        least_radius_(options.min_radius * (1 + 2 * kShrinkage)),
        packing_{.balls = options.spheres,
                 .overlap = options.particles.overlap,
                 .least_radius = least_radius_,
                 .seed = options.seed,
                 .rounds = options.effort == Effort::high ? 4 : 1},
        places_(places_in(surface, packing_)) {}

  ParticleSet run() {
    if (!options_.particles.equal_radii) {
      const auto widest = std::max_element(places_.begin(), places_.end(),
                                           [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
      for (const double cap : kCaps) {
        if (widest == places_.end() || (is_enough() && options_.spheres > kThorough)) break;
        try_largest(cap * widest->radius);
      }
    }
    for (const bool with_moments : {false, true})
      if (!is_enough() || (with_moments && options_.spheres <= kThorough)) try_equal(with_moments);
    if (!best_) throw InputError("no ball has room in the solid; it may be as thin as the rounding of its coordinates");
    return std::move(*best_);
  }

 private:
  bool is_enough() const { return best_ && excess_ <= 1; }

  void try_largest(double cap) {
    std::vector<Sphere> balls = pack_largest(surface_, places_, std::max(cap, least_radius_), packing_, progress_);
    if (balls.size() < options_.spheres) return;
    if (!options_.particles.own_masses) {
      std::vector<double> least = volumes_of(balls);
      for (double& volume : least) volume = std::min(volume, std::max(kLeastVolume * volume, volume_of(least_radius_)));
      fit_volumes(balls, std::move(least));
    }
    consider(std::move(balls));
  }

  void try_equal(bool with_moments) {
    const detail::PackingMoments moments{.body = solid_,
                                         .center_error = options_.particles.center_error * diagonal_,
                                         .inertia_error = options_.particles.inertia_error};
    std::vector<Sphere> balls = pack_equal(surface_, places_, with_moments ? &moments : nullptr, packing_, progress_);
    if (!options_.particles.equal_radii) {
      std::vector<Sphere> grown = balls;
      grow_in_place(surface_, packing_, grown);
      if (!options_.particles.own_masses) fit_volumes(grown, volumes_of(balls));
      consider(std::move(grown));
    }
    consider(std::move(balls));
  }

  // Smaller balls stay apart and in the solid, so their volumes can be chosen to match the moments.
  void fit_volumes(std::vector<Sphere>& balls, std::vector<double> least) const {
    detail::WeightBounds bounds;
    bounds.wanted = bounds.upper = volumes_of(balls);
    bounds.lower = std::move(least);
    for (int fit = 0; fit < kFits; ++fit) {
      const std::vector<double> volumes = detail::weights_with_moments(balls, bounds, solid_, false);
      for (std::size_t b = 0; b < balls.size(); ++b) balls[b].radius = std::cbrt(volumes[b] / volume_of(1));
    }
  }

  std::vector<double> masses_of(std::span<const Sphere> balls) const {
    const ParticleOptions& wanted = options_.particles;
    std::vector<double> masses = volumes_of(balls);
    const bool of_solid = wanted.density_of == ParticleOptions::DensityOf::solid;
    const double scale = wanted.density * (of_solid ? solid_.volume / sum_of(masses) : 1);
    for (double& mass : masses) mass *= scale;
    if (!wanted.own_masses) return masses;
    const double sum = sum_of(masses);
    detail::WeightBounds bounds;
    bounds.lower.assign(masses.size(), 0);
    bounds.upper.assign(masses.size(), sum);
    bounds.wanted = std::move(masses);
    masses = detail::weights_with_moments(balls, bounds, solid_, true);
    const double found = sum_of(masses);
    if (!(found > 0)) return bounds.wanted;
    for (double& mass : masses) mass *= sum / found;
    return masses;
  }

  void consider(std::vector<Sphere> balls) {
    for (Sphere& ball : balls) ball.radius *= 1 - kShrinkage;
    if (balls.empty() || !(balls.front().radius > 0)) return;
    std::stable_sort(balls.begin(), balls.end(), [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
    ParticleSet set;
    set.figures = particle_figures(balls, masses_of(balls), solid_, options_.particles);
    set.balls = std::move(balls);
    // Sets that fulfil all requirements are compared by the volume that they fill, and others by how far they miss
    // them. Balls that fill next to nothing are useless even if their moments are right.
    const double excess = particle_excess(set, options_, diagonal_), filled = set.figures.filled;
    const double score = excess <= 1 ? filled : -excess / std::sqrt(filled);
    if (best_ && score <= score_) return;
    excess_ = excess;
    score_ = score;
    best_ = std::move(set);
  }

  const Surface& surface_;
  const SphereSetOptions& options_;
  const Progress& progress_;
  const MassProperties solid_;
  const double diagonal_;
  const double least_radius_;  // before the safety margin is subtracted
  const detail::PackingOptions packing_;
  const std::vector<Sphere> places_;
  std::optional<ParticleSet> best_;
  double excess_ = 0, score_ = 0;  // of the best set so far
};

}  // namespace

ParticleFigures particle_figures(std::span<const Sphere> balls, std::vector<double> masses, const MassProperties& solid,
                                 const ParticleOptions& options) {
  ParticleFigures figures;
  figures.body = detail::body_of(balls, masses);
  figures.center_error = (figures.body.center - solid.center).norm();
  figures.inertia_error = inertia_difference(figures.body, solid, true);
  const double volume = sum_of(volumes_of(balls));
  figures.filled = volume / solid.volume;
  figures.wanted_mass =
      options.density * (options.density_of == ParticleOptions::DensityOf::solid ? solid.volume : volume);
  figures.masses = std::move(masses);
  figures.overlap_proven = true;
  for (Index a = 0; a < balls.size(); ++a)
    for (Index b = a + 1; b < balls.size(); ++b) {
      const double reach = balls[a].radius + balls[b].radius;
      // these are far apart even after rounding
      if ((balls[a].center - balls[b].center).squaredNorm() > 1.001 * reach * reach) continue;
      const double share = overlap_share(balls[a], balls[b]);
      if (share > figures.largest_overlap) figures.largest_overlap = share, figures.overlapping = {a, b};
      figures.overlap_proven = figures.overlap_proven && overlaps_at_most(balls[a], balls[b], options.overlap);
    }
  return figures;
}

detail::ParticleSet detail::particle_set(const Surface& surface, const SphereSetOptions& options,
                                         const Progress& progress) {
  return ParticleSearch(surface, options, progress).run();
}

double detail::particle_excess(const ParticleSet& set, const SphereSetOptions& options, double diagonal) {
  const ParticleFigures& figures = set.figures;
  double excess = std::max(figures.center_error / (options.particles.center_error * diagonal),
                           figures.inertia_error / options.particles.inertia_error);
  if (options.min_radius > 0) excess = std::max(excess, options.min_radius / set.balls.back().radius);
  return excess;
}

}  // namespace orchard
