#include "orchard/spheretree/sphere_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cover_set.h"
#include "filling.h"
#include "orchard/geometry/error.h"
#include "particle_set.h"

namespace orchard {
namespace {

// The rounding error of a signed distance and of a sum of radii, per unit of the coordinates.
constexpr double kInsideRounding = 0x1p-45;

bool lies_inside(const Surface& surface, const Sphere& ball) {
  const double rounding = kInsideRounding * (ball.center.norm() + surface.bounding_radius());
  return surface.signed_distance(ball.center) + ball.radius + rounding <= 0;
}

void require(bool holds, const std::string& what) {
  if (!holds) throw InputError(what);
}

// Builds sets with different numbers of spheres by the same options, and measures by how much they miss the
// requirements.
class SetBuilder {
 public:
  SetBuilder(const Surface& surface, const SphereSetOptions& options, const Progress& progress)
      : surface_(surface), options_(options), progress_(progress) {}

  SphereSetBuild build(Index spheres) const {
    SphereSetOptions own = options_;
    own.spheres = spheres;
    SphereSetBuild result;
    result.fit = own.fit;
    time_stage(result.seconds, "fitting", [&] { fit(own, result); });
    time_stage(result.seconds, "certificate",
               [&] { result.audit = audit_spheres(surface_, result.spheres, own.audit, progress_); });
    result.kept = is_kept(result);
    result.error_reached = !asks_for_error() || excess(result) <= 1;
    for (Sphere& ball : result.spheres) ball.radius += own.padding;
    return result;
  }

  bool asks_for_error() const { return options_.error > 0 || options_.volume_error > 0; }
  static bool misses_nothing(const SphereSetBuild& build) { return build.kept && build.error_reached; }

  // Returns the largest error as a multiple of what is allowed.
  double excess(const SphereSetBuild& build) const {
    const SphereAudit::BesideSolid& beside = *build.audit.beside_solid;
    const double solid = beside.volume.solid, diagonal = surface_.bounding_box().diagonal().norm();
    const double error = options_.fit == SphereFit::cover      ? beside.protrusion.upper
                         : options_.fit == SphereFit::balanced ? beside.mean.two_sided()
                                                               : build.audit.largest_gap.upper;
    const double volume =
        options_.fit == SphereFit::cover ? beside.volume.outside.value : beside.volume.uncovered.value;
    double excess = 0;
    if (options_.error > 0) excess = std::max(excess, error / (diagonal * options_.error));
    if (options_.volume_error > 0) excess = std::max(excess, volume / (solid * options_.volume_error));
    if (!build.particles) return excess;
    return std::max({excess, build.particles->center_error / (diagonal * options_.particles.center_error),
                     build.particles->inertia_error / options_.particles.inertia_error});
  }

  // Returns the largest factor by which a sphere is too small; at most 1 if none is.
  double narrowness(const SphereSetBuild& build) const {
    return options_.min_radius > 0 ? options_.min_radius / (build.spheres.back().radius - options_.padding) : 0;
  }

 private:
  void fit(const SphereSetOptions& own, SphereSetBuild& result) const {
    if (own.fit == SphereFit::particles) {
      detail::ParticleSet set = detail::particle_set(surface_, own, progress_);
      result.spheres = std::move(set.balls);
      result.particles = std::move(set.figures);
      return;
    }
    result.spheres = own.fit == SphereFit::cover ? covering(own) : detail::filled_set(surface_, own, progress_);
    std::stable_sort(result.spheres.begin(), result.spheres.end(),
                     [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
  }

  std::vector<Sphere> covering(const SphereSetOptions& own) const {
    std::vector<Sphere> balls = detail::cover_set(surface_, own, progress_);
    for (Sphere& ball : balls) ball.radius = std::max(ball.radius, own.min_radius);
    if (own.solid) detail::close_voids(surface_, balls);
    if (balls.size() < own.spheres) detail::add_inner_balls(surface_, own.spheres, own.min_radius, balls);
    // There is no room for more spheres of that size, so some are repeated.
    for (std::size_t b = 0; balls.size() < own.spheres; ++b) balls.push_back(balls[b]);
    return balls;
  }

  bool is_kept(const SphereSetBuild& result) const {
    return result.spheres.back().radius >= options_.min_radius && keeps_promise(result);
  }

  bool keeps_promise(const SphereSetBuild& result) const {
    const auto lies_within = [&](const Sphere& ball) { return lies_inside(surface_, ball); };
    switch (result.fit) {
      case SphereFit::cover:
        return result.audit.covered && (!options_.solid || covers_solid(surface_, result.spheres));
      case SphereFit::particles:
        if (!result.particles->overlap_proven || excess(result) > 1) return false;
        if (options_.particles.equal_radii && result.spheres.front().radius != result.spheres.back().radius)
          return false;
        [[fallthrough]];
      case SphereFit::inside:
        return std::all_of(result.spheres.begin(), result.spheres.end(), lies_within);
      case SphereFit::balanced:
        break;
    }
    const UnionVolume& volume = result.audit.beside_solid->volume;
    return std::abs(volume.balls.value - volume.solid) + 2 * volume.balls.error <= kBalancedVolume * volume.solid;
  }

  const Surface& surface_;
  const SphereSetOptions& options_;
  const Progress& progress_;
};

// Doubles the number and then bisects, because errors fall with the number, if not in every step.
SphereSetBuild fewest(const SetBuilder& builder, Index most) {
  Index failed = 0, tried = std::min<Index>(2, most);
  SphereSetBuild best = builder.build(tried);
  while (builder.excess(best) > 1) {
    failed = tried;
    if (tried == most) return best;
    tried = std::min(2 * tried, most);
    best = builder.build(tried);
  }
  while (tried - failed > 1) {
    const Index middle = failed + (tried - failed) / 2;
    SphereSetBuild build = builder.build(middle);
    if (builder.excess(build) > 1) {
      failed = middle;
    } else {
      tried = middle;
      best = std::move(build);
    }
  }
  return best;
}

// Searches for the number of spheres with which `missing` is fulfilled. Guesses follow the power law through the last
// two sets, and each guess is tried. A lower limit on the size is fulfilled by fewer spheres, and all other
// requirements by more.
class EnoughSearch {
 public:
  EnoughSearch(const SetBuilder& builder, const SphereSetBuild& missing) : builder_(builder) { note(missing); }

  std::optional<Index> run() {
    for (int trial = 0; trial < kMaxTrials; ++trial) {
      const std::optional<Index> guess = next();
      if (!guess) return std::nullopt;
      const SphereSetBuild build = builder_.build(*guess);
      if (SetBuilder::misses_nothing(build)) return guess;
      note(build);
    }
    return std::nullopt;
  }

 private:
  static constexpr int kMaxTrials = 4;
  static constexpr double kBeyond = 2;  // a guess beyond this many times kMaxSetSpheres is not tried
  static constexpr double kAmple = 1.15;

  struct Tried {
    double spheres, excess, narrowness;
  };

  void note(const SphereSetBuild& build) {
    before_ = last_;
    last_ = {static_cast<double>(build.spheres.size()), builder_.excess(build), builder_.narrowness(build)};
  }

  std::optional<Index> next() const {
    if (last_.narrowness > 1) {
      if (last_.excess > 1) return std::nullopt;
      const double fewer = std::floor(last_.spheres / (kAmple * std::pow(last_.narrowness, 3)));
      return fewer >= 1 ? std::optional(static_cast<Index>(fewer)) : std::nullopt;
    }
    double guess = 2 * last_.spheres;
    if (before_.spheres > 0 && last_.excess > 1 && before_.excess > last_.excess && last_.spheres > before_.spheres) {
      const double power = std::log(last_.spheres / before_.spheres) / std::log(before_.excess / last_.excess);
      guess = kAmple * last_.spheres * std::pow(last_.excess, power);
    }
    if (last_.spheres >= kMaxSetSpheres || guess > kBeyond * kMaxSetSpheres) return std::nullopt;
    return static_cast<Index>(std::clamp(std::ceil(guess), last_.spheres + 1, double{kMaxSetSpheres}));
  }

  const SetBuilder& builder_;
  Tried before_{0, 0, 0}, last_{0, 0, 0};
};

}  // namespace

void require_usable(const SphereSetOptions& options) {
  require(options.spheres >= 1 && options.spheres <= kMaxSetSpheres,
          "the number of spheres must lie between 1 and " + std::to_string(kMaxSetSpheres));
  for (const auto& [value, name] : {std::pair{options.error, "error"},
                                    {options.volume_error, "volume error"},
                                    {options.padding, "padding"},
                                    {options.min_radius, "smallest radius"}})
    require(value >= 0 && std::isfinite(value), std::string("the ") + name + " must be a finite number, 0 or more");
  const bool covers = options.fit == SphereFit::cover;
  require(covers || !options.solid, "only a cover can hold the whole solid");
  require(covers || options.padding == 0, "only a cover has padding");
  require(options.fit != SphereFit::particles || options.weights.empty(), "weights are of no use to particles");
  for (const WeightRegion& region : options.weights.regions)
    require(region.factor > 0 && std::isfinite(region.factor),
            "the weight of a region must be a finite number above 0");
  for (const double factor : options.weights.of_vertices)
    require(factor > 0 && std::isfinite(factor), "the weight of a vertex must be a finite number above 0");
  const ParticleOptions& particles = options.particles;
  require(particles.overlap >= 0 && particles.overlap <= 1, "the overlap of particles must lie between 0 and 1");
  for (const auto& [value, name] : {std::pair{particles.density, "density"},
                                    {particles.center_error, "error of the centre of mass"},
                                    {particles.inertia_error, "error of the inertia"}})
    require(value > 0 && std::isfinite(value), std::string("the ") + name + " must be a finite number above 0");
  require(options.fit != SphereFit::balanced || options.volume_error == 0,
          "a balanced set has the volume of the solid anyhow: it has no volume error");
}

SphereSetBuild build_sphere_set(const Surface& surface, const SphereSetOptions& options, const Progress& progress) {
  require_usable(options);
  if (!surface.solid())
    throw InputError("a set of spheres needs a solid: " + surface.report().faults() + "; repair the mesh first");
  const std::size_t weights = options.weights.of_vertices.size(), vertices = surface.mesh().vertices.size();
  require(weights == 0 || weights == vertices, "there must be one weight for each of the " + std::to_string(vertices) +
                                                   " vertices, and there are " + std::to_string(weights));
  const SetBuilder builder(surface, options, progress);
  SphereSetBuild result = builder.asks_for_error() ? fewest(builder, options.spheres) : builder.build(options.spheres);
  if (options.find_enough && !SetBuilder::misses_nothing(result)) result.enough = EnoughSearch(builder, result).run();
  return result;
}

}  // namespace orchard
