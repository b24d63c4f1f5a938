#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "orchard/spheretree/sphere_set.h"
#include "output/promises.h"
#include "svg_plot.h"

// What `orchard spheres` writes and says of the sets that it made.
namespace orchard::apps {

const char* name(SphereFit fit);
// What the set promises, and that it is proven, in a sentence without its full stop; or what is not kept.
std::string promise_in_words(const SphereSetOptions& options, const SphereSetBuild& build);
// `diagonal`: of the solid's bounding box.
Broken broken(const SphereSetOptions& options, const SphereSetBuild& build, double diagonal);

// Lines of x y z r, and the mass if there are masses. `head`: lines that begin the file as comments.
std::string to_text(std::span<const Sphere> spheres, std::span<const double> masses,
                    const std::vector<std::string>& head);
std::string to_csv(std::span<const Sphere> spheres, std::span<const double> masses);
// {centers, radii}, and masses if there are any.
nlohmann::json to_json(std::span<const Sphere> spheres, std::span<const double> masses);
std::string to_yaml(std::span<const Sphere> spheres, const std::string& link);  // collision_spheres of cuRobo
// `figures`: of particles, as the link's inertia; nullptr: none.
std::string set_as_urdf(std::span<const Sphere> spheres, const std::string& link, const ParticleFigures* figures);

// Sets of several numbers of spheres: a table, and a plot of how far off each is. Lengths over the diagonal, in
// percent.
nlohmann::json error_curve_json(std::span<const SphereSetBuild> sets, double diagonal);
std::string error_curve_csv(std::span<const SphereSetBuild> sets, double diagonal);
std::vector<plot::Plot> error_curve_plots(std::span<const SphereSetBuild> sets, double diagonal,
                                          const std::string& title);

}  // namespace orchard::apps
