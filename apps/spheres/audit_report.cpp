#include "spheres/audit_report.h"

#include <fmt/core.h>

#include <algorithm>

#include "output/json_values.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

// If the box of a set is this many times smaller or larger than the mesh's, the set is in another unit.
constexpr double kOtherUnit = 0.05;

double diagonal(const Surface& surface) { return surface.bounding_box().diagonal().norm(); }

json curobo_json(const CuroboFigures& figures) {
  return {{"curobo_num_spheres", figures.num_spheres},
          {"curobo_coverage", figures.coverage},
          {"curobo_protrusion", figures.protrusion},
          {"curobo_protrusion_dist_mean", figures.protrusion_dist_mean},
          {"curobo_protrusion_dist_p95", figures.protrusion_dist_p95},
          {"curobo_surface_gap_mean", figures.surface_gap_mean},
          {"curobo_surface_gap_p95", figures.surface_gap_p95},
          {"curobo_max_uncovered_gap", figures.max_uncovered_gap},
          {"curobo_volume_ratio", figures.volume_ratio}};
}

json beside_json(const SphereAudit::BesideSolid& beside, const Surface& surface) {
  const UnionVolume& volume = beside.volume;
  const auto over_solid = [&](const Estimate& estimate) {
    return json{{"value", estimate.value / volume.solid}, {"standard_error", estimate.error / volume.solid}};
  };
  json report{
      {"protrusion_max", bounds_json(beside.protrusion)},
      {"protrusion_max_over_diagonal", bounds_json(beside.protrusion, diagonal(surface))},
      {"protrusion_mean", beside.mean.protrusion},
      {"protruding_sphere", beside.protruding == kNone ? json() : json(beside.protruding)},
      {"boundary_outside_share", beside.mean.outside_share},
      {"solid_volume", volume.solid},
      {"union_over_solid", over_solid(volume.balls)},
      {"outside_over_solid", over_solid(volume.outside)},
      {"uncovered_over_solid", over_solid(volume.uncovered)},
      {"surface_to_union_mean", beside.mean.surface_to_union},
      {"union_to_surface_mean", beside.mean.union_to_surface},
      {"two_sided_mean", beside.mean.two_sided()},
      {"gap_mean", beside.mean.gap},
      {"mass_center_error", (volume.of_balls.center - volume.of_solid.center).norm()},
      {"mass_center_error_over_diagonal", (volume.of_balls.center - volume.of_solid.center).norm() / diagonal(surface)},
      {"inertia_error_equal_density", inertia_difference(volume.of_balls, volume.of_solid, false)},
      {"inertia_error_equal_mass", inertia_difference(volume.of_balls, volume.of_solid, true)}};
  report.update(curobo_json(beside.curobo));
  return report;
}

void print_beside(const SphereAudit::BesideSolid& beside, const Surface& surface) {
  const double size = diagonal(surface);
  const UnionVolume& volume = beside.volume;
  const auto percent = [&](double part) { return 100 * part / volume.solid; };
  fmt::print(
      "  sticks out at most        {:.4g} ({:.3g} % of the diagonal; proven: {:.4g} to {:.4g}), in the mean {:.4g}\n",
      beside.protrusion.lower, 100 * beside.protrusion.lower / size, beside.protrusion.lower, beside.protrusion.upper,
      beside.mean.protrusion);
  fmt::print(
      "  volume of the union       {:.2f} % of the solid's (+- {:.2f}); outside {:.2f} %, solid left out {:.2f} %\n",
      percent(volume.balls.value), 2 * percent(volume.balls.error), percent(volume.outside.value),
      percent(volume.uncovered.value));
  fmt::print("  two-sided mean distance   {:.4g}\n", beside.mean.two_sided());
  fmt::print(
      "  as a body                 centre of mass {:.3g} % of the diagonal off, inertia {:.3g} % at equal density, "
      "{:.3g} % at equal mass\n",
      100 * (volume.of_balls.center - volume.of_solid.center).norm() / size,
      100 * inertia_difference(volume.of_balls, volume.of_solid, false),
      100 * inertia_difference(volume.of_balls, volume.of_solid, true));
  const CuroboFigures& c = beside.curobo;
  fmt::print(
      "  by cuRobo's definitions   coverage {:.3f}, protrusion {:.3f} (mean {:.4g}, p95 {:.4g}), surface gap mean "
      "{:.4g}, "
      "p95 {:.4g}, max {:.4g}, volume ratio {:.3f}\n",
      c.coverage, c.protrusion, c.protrusion_dist_mean, c.protrusion_dist_p95, c.surface_gap_mean, c.surface_gap_p95,
      c.max_uncovered_gap, c.volume_ratio);
}

// How many spheres have a point of the surface, or lie in the solid, after a change of the unit about the origin.
std::size_t touching(const Surface& surface, std::span<const Sphere> spheres, double scale, const Vector& offset) {
  return static_cast<std::size_t>(std::count_if(spheres.begin(), spheres.end(), [&](const Sphere& sphere) {
    const Point center = scale * sphere.center + offset;
    return surface.distance(center) <= scale * sphere.radius || (surface.solid() && surface.inside(center));
  }));
}

}  // namespace

json to_json(const SphereAudit& audit, const Surface& surface) {
  const double size = diagonal(surface);
  json report{{"spheres", audit.spheres},
              {"area", audit.area},
              {"closed", !is_open(audit, surface)},
              {"proven_closed", audit.covered},
              {"touches", audit.touches},
              {"open_area", bounds_json(audit.open_area)},
              {"open_share", bounds_json(audit.open_area, audit.area)},
              {"open_share_likely", audit.likely_open_area / audit.area},
              {"largest_gap", bounds_json(audit.largest_gap)},
              {"largest_gap_over_diagonal", bounds_json(audit.largest_gap, size)},
              {"largest_gap_place", audit.covered ? json() : point_json(audit.gap_place)}};
  if (audit.beside_solid) report.update(beside_json(*audit.beside_solid, surface));
  return report;
}

void print_audit(const SphereAudit& audit, const Surface& surface) {
  const double size = diagonal(surface);
  if (audit.covered) {
    fmt::print("  surface left open         nothing: proven\n");
  } else {
    const auto percent = [&](double part) { return 100 * part / audit.area; };
    fmt::print("  surface left open         {:.4g} % of its area (proven: {:.4g} to {:.4g})\n",
               percent(audit.likely_open_area), percent(audit.open_area.lower), percent(audit.open_area.upper));
    fmt::print(
        "  largest gap               {:.4g} ({:.3g} % of the diagonal; proven: {:.4g} to {:.4g}) at ({:.6g}, {:.6g}, "
        "{:.6g})\n",
        audit.largest_gap.lower, 100 * audit.largest_gap.lower / size, audit.largest_gap.lower, audit.largest_gap.upper,
        audit.gap_place.x(), audit.gap_place.y(), audit.gap_place.z());
  }
  if (audit.beside_solid)
    print_beside(*audit.beside_solid, surface);
  else
    fmt::print("  volumes and protrusion    not measured: the mesh bounds no solid ({})\n", surface.report().faults());
}

bool is_open(const SphereAudit& audit, const Surface& surface) {
  return !audit.covered && !audit.only_tangent(surface.bounding_radius());
}

std::string verdict(const SphereAudit& audit, const Surface& surface) {
  if (audit.covered) return "CLOSED: every point of the surface lies in a sphere; proven";
  if (!is_open(audit, surface))
    return fmt::format("CLOSED but for rounding: spheres meet without overlapping, and no gap is wider than {:.2g}",
                       audit.largest_gap.upper);
  if (!audit.touches) return "OPEN: no sphere touches the mesh";
  return fmt::format("OPEN: {:.3g} % of the surface is in no sphere, up to {:.4g} away from the next one",
                     100 * audit.likely_open_area / audit.area, audit.largest_gap.lower);
}

std::string suggested_frame(const Surface& surface, std::span<const Sphere> spheres) {
  Box box;
  for (const Sphere& sphere : spheres) {
    box.extend(Point(sphere.center - Vector::Constant(sphere.radius)));
    box.extend(Point(sphere.center + Vector::Constant(sphere.radius)));
  }
  const double ratio = box.diagonal().norm() / diagonal(surface);
  const bool as_large = ratio > 0.5 && ratio < 2;
  if (touching(surface, spheres, 1, Vector::Zero()) > 0 && ratio > kOtherUnit && ratio < 1 / kOtherUnit) return {};
  const Vector offset = surface.bounding_box().center() - box.center();
  if (as_large && 2 * touching(surface, spheres, 1, offset) > spheres.size())
    return fmt::format(
        "Most would touch it if they were moved by ({:.4g}, {:.4g}, {:.4g}): are they in the frame of a link, and the "
        "mesh is not?",
        offset.x(), offset.y(), offset.z());
  for (const double scale : {1000.0, 0.001, 100.0, 0.01, 25.4, 1 / 25.4}) {
    if (scale * ratio < kOtherUnit || scale * ratio > 1 / kOtherUnit) continue;
    if (2 * touching(surface, spheres, scale, Vector::Zero()) > spheres.size())
      return fmt::format("Most would touch it if their numbers were multiplied by {:g}: is the unit another one?",
                         scale);
  }
  return {};
}

}  // namespace orchard::apps
