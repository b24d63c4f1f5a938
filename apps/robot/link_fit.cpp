#include "robot/link_fit.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "orchard/covering/coverage.h"
#include "orchard/geometry/error.h"
#include "orchard/spheretree/tree.h"

namespace orchard::robot {
namespace {

constexpr double kDigits = 1e7;  // of metres: a tenth of a micrometre
constexpr int kMaxGrowths = 3;

// The final measurement is accurate to about one per cent. With few large spheres it takes longest of all steps.
const SphereAuditOptions kFinalAudit{.surface_samples = 4000, .sphere_samples = 8000};

double to_digits(double value) { return std::round(value * kDigits) / kDigits; }

// GCC 12 omits both conversions if it makes them for two coordinates at once; volatile prevents that.
double as_float(double value) {
  const volatile float held = static_cast<float>(value);
  return static_cast<double>(held);
}

// Returns the sphere as a program that reads floats sees it.
Sphere in_floats(const Sphere& sphere) {
  return {Point(as_float(sphere.center.x()), as_float(sphere.center.y()), as_float(sphere.center.z())),
          as_float(sphere.radius)};
}

std::vector<Sphere> in_floats(std::vector<Sphere> spheres) {
  for (Sphere& sphere : spheres) sphere = in_floats(sphere);
  return spheres;
}

// Whether `outer` contains `inner`, with a margin for rounding errors of this test.
bool contains(const Sphere& outer, const Sphere& inner) {
  const double scale = outer.center.cwiseAbs().maxCoeff() + outer.radius;
  return (outer.center - inner.center).norm() + inner.radius + 0x1p-48 * scale <= outer.radius;
}

bool covers(const Surface& surface, const std::vector<Sphere>& spheres) {
  const Point origin = surface.bounding_box().center();
  return surface_coverage(surface, path_balls(spheres, origin), origin).complete();
}

// The surfaces that a cover is to hold.
class CoverProof {
 public:
  explicit CoverProof(const LinkShape& shape)
      : shape_(shape), solid_(shape.wrapped || shape.deviation > 0), original_(shape.original) {}

  bool needs_solid() const { return solid_; }

  bool holds(const std::vector<Sphere>& spheres) const { return holds_as(spheres) && holds_as(in_floats(spheres)); }

  // How far a point may be from the spheres.
  double gap(const std::vector<Sphere>& spheres) const {
    return std::max(audit_spheres(original_, spheres).largest_gap.upper,
                    audit_spheres(shape_.surface, spheres).largest_gap.upper);
  }

 private:
  bool holds_as(const std::vector<Sphere>& spheres) const {
    if (!covers(original_, spheres)) return false;
    if (!solid_ && !shape_.repaired) return true;
    return covers(shape_.surface, spheres) && (!solid_ || covers_solid(shape_.surface, spheres));
  }

  const LinkShape& shape_;
  bool solid_;
  Surface original_;
};

void grow_until_proven(const CoverProof& proof, LinkFit& fit) {
  fit.kept = proof.holds(fit.spheres);
  for (int round = 0; round < kMaxGrowths && !fit.kept; ++round) {
    const double growth = std::max(proof.gap(fit.spheres), 1 / kDigits);
    for (Sphere& sphere : fit.spheres) sphere = rounded({sphere.center, sphere.radius + growth}, true);
    fit.grown += growth;
    fit.kept = proof.holds(fit.spheres);
  }
}

LinkFit fit_link(const LinkShape& shape, Index spheres, const FitOptions& options, const Progress& progress) {
  LinkFit result;
  const auto own_fit = options.fit_of.find(shape.link);
  result.fit = own_fit == options.fit_of.end() ? options.fit : own_fit->second;
  const bool cover = result.fit == SphereFit::cover;
  const CoverProof proof(shape);
  SphereSetOptions own{.fit = result.fit, .spheres = spheres, .effort = options.effort, .find_enough = false};
  own.seed = options.seed;
  own.solid = cover && proof.needs_solid();
  if (cover) own.audit = kQuickAudit;
  const SphereSetBuild build = build_sphere_set(shape.surface, own, progress);
  for (const Sphere& sphere : build.spheres) {
    const Sphere round = rounded(sphere, result.fit != SphereFit::inside);
    if (round.radius > 0) result.spheres.push_back(round);
  }
  result.kept = build.kept;
  if (cover) grow_until_proven(proof, result);
  result.audit = audit_spheres(shape.surface, result.spheres, kFinalAudit, progress);
  if (cover && options.padding > 0)
    for (Sphere& sphere : result.spheres) sphere = rounded({sphere.center, sphere.radius + options.padding}, true);
  return result;
}

}  // namespace

Sphere rounded(const Sphere& sphere, bool outward) {
  Sphere result{Point(to_digits(sphere.center.x()), to_digits(sphere.center.y()), to_digits(sphere.center.z())),
                std::max(0.0, to_digits(sphere.radius))};
  const auto right = [&] {
    const Sphere held = in_floats(result);
    return outward ? contains(result, sphere) && contains(held, sphere)
                   : contains(sphere, result) && contains(sphere, held);
  };
  // The step doubles in each round, since floats may be coarser than the digits.
  for (double step = 1 / kDigits; !right(); step *= 2) {
    result.radius = to_digits(result.radius + (outward ? step : -step));
    if (result.radius <= 0 && !outward) return {result.center, 0};
  }
  return result;
}

std::vector<LinkFit> fit_links(const Robot& robot, const std::vector<LinkShape>& shapes, const FitOptions& options,
                               const Progress& progress) {
  for (const LinkShape& shape : shapes)
    if (!shape.surface.solid())
      throw InputError(fmt::format("{}: link {} is no solid: {}", robot.file.string(), robot.links[shape.link].name,
                                   shape.surface.report().faults()));
  const std::vector<Index> counts = share_spheres(robot, shapes, options, progress);
  report_progress(progress, "fitting spheres", 0);
  std::vector<LinkFit> fits(shapes.size());
  tbb::parallel_for(std::size_t{0}, shapes.size(),
                    [&](std::size_t i) { fits[i] = fit_link(shapes[i], counts[i], options, {}); });
  return fits;
}

}  // namespace orchard::robot
