#include "spheres/particle_report.h"

#include <fmt/core.h>

#include <algorithm>

#include "output/json_values.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

std::string overlaps_in_words(double overlap) {
  return overlap > 0 ? fmt::format("no two overlap by more than {:g} % of the smaller one", 100 * overlap)
                     : std::string("no two overlap");
}

}  // namespace

std::string particle_promise(const SphereSetOptions& options) {
  const ParticleOptions& particles = options.particles;
  return fmt::format(
      "every sphere lies in the solid; {}{}; together the centre of mass is that of the solid within {:g} % of the "
      "diagonal, and the inertia within {:g} %",
      overlaps_in_words(particles.overlap), particles.equal_radii ? "; all radii are equal" : "",
      100 * particles.center_error, 100 * particles.inertia_error);
}

std::vector<std::string> missed_by_particles(const SphereSetOptions& options, const ParticleFigures& figures,
                                             double diagonal) {
  const ParticleOptions& particles = options.particles;
  std::vector<std::string> missed;
  if (!figures.overlap_proven)
    missed.push_back(fmt::format("it is not proven that {}", overlaps_in_words(particles.overlap)));
  if (figures.center_error > particles.center_error * diagonal)
    missed.push_back(fmt::format("the centre of mass is {:.3g} % of the diagonal off, where {:g} % was allowed",
                                 100 * figures.center_error / diagonal, 100 * particles.center_error));
  if (figures.inertia_error > particles.inertia_error)
    missed.push_back(fmt::format("the inertia is {:.3g} % off, where {:g} % was allowed", 100 * figures.inertia_error,
                                 100 * particles.inertia_error));
  return missed;
}

json to_json(const ParticleFigures& figures, double diagonal) {
  const Eigen::Matrix3d& inertia = figures.body.inertia;
  json rows = json::array();
  for (int row = 0; row < 3; ++row) rows.push_back({inertia(row, 0), inertia(row, 1), inertia(row, 2)});
  const auto [a, b] = figures.overlapping;
  return {{"mass", figures.body.volume},
          {"wanted_mass", figures.wanted_mass},
          {"masses", figures.masses},
          {"mass_center", point_json(figures.body.center)},
          {"mass_center_error", figures.center_error},
          {"mass_center_error_over_diagonal", figures.center_error / diagonal},
          {"inertia", std::move(rows)},
          {"inertia_error", figures.inertia_error},
          {"largest_overlap", figures.largest_overlap},
          {"overlapping", a == kNone ? json() : json{a, b}},
          {"overlap_proven", figures.overlap_proven},
          {"volume_over_solid", figures.filled}};
}

void print_bodies(const ParticleFigures& figures, double diagonal) {
  const auto [least, most] = std::minmax_element(figures.masses.begin(), figures.masses.end());
  fmt::print("  masses                    {:.6g} in all, from {:.4g} to {:.4g} a sphere\n", figures.body.volume, *least,
             *most);
  fmt::print(
      "  together                  centre of mass {:.3g} % of the diagonal off, inertia {:.3g} % at equal mass\n",
      100 * figures.center_error / diagonal, 100 * figures.inertia_error);
  fmt::print("  overlap of two            {:.3g} % of the smaller one at most\n", 100 * figures.largest_overlap);
}

void print_particles(const ParticleFigures& figures, double diagonal) {
  print_bodies(figures, diagonal);
  fmt::print("  volume of all             {:.2f} % of the solid's; overlaps {}\n", 100 * figures.filled,
             figures.overlap_proven ? "are not above the limit: proven" : "are above the limit, or in doubt");
}

}  // namespace orchard::apps
