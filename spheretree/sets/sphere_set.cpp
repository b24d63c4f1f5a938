#include "orchard/spheretree/sphere_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cover_set.h"
#include "filling.h"
#include "orchard/geometry/error.h"

namespace orchard {
namespace {

// Roundings of a signed distance and of a radius' sum, per unit of coordinate.
constexpr double kRounding = 0x1p-45;

bool lies_inside(const Surface& surface, const Sphere& ball) {
  const double rounding = kRounding * (ball.center.norm() + surface.bounding_radius());
  return surface.signed_distance(ball.center) + ball.radius + rounding <= 0;
}

void require(bool holds, const std::string& what) {
  if (!holds) throw InputError(what);
}

// Spheres of exactly `options.spheres`, and whether they keep their promise.
class SetBuilder {
 public:
  SetBuilder(const Surface& surface, const SphereSetOptions& options, const Progress& progress)
      : surface_(surface), options_(options), progress_(progress) {}

  SphereSetBuild build(Index spheres) const {
    SphereSetOptions own = options_;
    own.spheres = spheres;
    SphereSetBuild result;
    result.fit = own.fit;
    time_stage(result.seconds, "fitting", [&] { result.spheres = fitted(own); });
    std::stable_sort(result.spheres.begin(), result.spheres.end(),
                     [](const Sphere& a, const Sphere& b) { return a.radius > b.radius; });
    time_stage(result.seconds, "certificate",
               [&] { result.audit = audit_spheres(surface_, result.spheres, {}, progress_); });
    result.kept = is_kept(result);
    for (Sphere& ball : result.spheres) ball.radius += own.padding;
    return result;
  }

  // How large the errors are that were asked for, as multiples of what is allowed: the larger one.
  double excess(const SphereSetBuild& build) const {
    const SphereAudit::BesideSolid& beside = *build.audit.beside_solid;
    const double diagonal = surface_.bounding_box().diagonal().norm(), solid = beside.volume.solid;
    const double error = options_.fit == SphereFit::cover    ? beside.protrusion.upper
                         : options_.fit == SphereFit::inside ? build.audit.largest_gap.upper
                                                             : beside.mean.two_sided();
    const double volume =
        options_.fit == SphereFit::cover ? beside.volume.outside.value : beside.volume.uncovered.value;
    double excess = 0;
    if (options_.error > 0) excess = std::max(excess, error / (diagonal * options_.error));
    if (options_.volume_error > 0) excess = std::max(excess, volume / (solid * options_.volume_error));
    return excess;
  }

 private:
  std::vector<Sphere> fitted(const SphereSetOptions& own) const {
    if (own.fit != SphereFit::cover) return detail::filled_set(surface_, own, progress_);
    std::vector<Sphere> balls = detail::cover_set(surface_, own, progress_);
    for (Sphere& ball : balls) ball.radius = std::max(ball.radius, own.min_radius);
    if (own.solid) detail::close_voids(surface_, balls);
    if (balls.size() < own.spheres) detail::add_inner_balls(surface_, own.spheres, own.min_radius, balls);
    return balls;
  }

  bool is_kept(const SphereSetBuild& result) const {
    switch (result.fit) {
      case SphereFit::cover:
        return result.audit.covered && (!options_.solid || covers_solid(surface_, result.spheres));
      case SphereFit::inside:
        return std::all_of(result.spheres.begin(), result.spheres.end(),
                           [&](const Sphere& ball) { return lies_inside(surface_, ball); });
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
  require(covers || options.min_radius == 0, "only a cover has a smallest radius");
  require(options.fit != SphereFit::balanced || options.volume_error == 0,
          "a balanced set has the volume of the solid anyhow: it has no volume error");
}

SphereSetBuild build_sphere_set(const Surface& surface, const SphereSetOptions& options, const Progress& progress) {
  require_usable(options);
  if (!surface.solid())
    throw InputError("a set of spheres needs a solid: " + surface.report().faults() + "; repair the mesh first");
  const SetBuilder builder(surface, options, progress);
  if (options.error == 0 && options.volume_error == 0) return builder.build(options.spheres);
  // Doubling, then halving what is between: errors fall with the number, if not at every step.
  Index failed = 0, tried = std::min<Index>(2, options.spheres);
  SphereSetBuild best = builder.build(tried);
  while (builder.excess(best) > 1) {
    failed = tried;
    if (tried == options.spheres) {
      best.error_reached = false;
      return best;
    }
    tried = std::min(2 * tried, options.spheres);
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

SphereTree tree_over(std::span<const Sphere> balls, const Sphere& bounds) {
  SphereTree tree;
  Sphere root = bounds;
  for (const Sphere& ball : balls)
    root.radius = std::max(root.radius, ((ball.center - root.center).norm() + ball.radius) * (1 + 1e-12));
  tree.nodes.push_back({.sphere = root, .first_child = 1, .child_count = static_cast<Index>(balls.size())});
  for (const Sphere& ball : balls) tree.nodes.push_back({.sphere = ball, .parent = 0, .level = 1});
  tree.branching = std::max<Index>(2, static_cast<Index>(balls.size()));
  return tree;
}

}  // namespace orchard
