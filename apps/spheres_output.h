#pragma once
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "orchard/spheretree/sphere_set.h"
#include "promises.h"
#include "svg_plot.h"

// What `orchard spheres` writes and says of the sets that it made.
namespace orchard::apps {

const char* name(SphereFit fit);
// What the set promises, and that it is proven, in a sentence without its full stop; or what is not kept.
std::string promise_in_words(const SphereSetOptions& options, const SphereSetBuild& build);
Broken broken(const SphereSetOptions& options, const SphereSetBuild& build);

// Lines of x y z r. `head`: lines that begin the file as comments.
std::string to_text(std::span<const Sphere> spheres, const std::vector<std::string>& head);
std::string to_csv(std::span<const Sphere> spheres);
nlohmann::json to_json(std::span<const Sphere> spheres);                        // {centers, radii}
std::string to_yaml(std::span<const Sphere> spheres, const std::string& link);  // collision_spheres of cuRobo
std::string set_as_urdf(std::span<const Sphere> spheres, const std::string& link);

// Sets of several numbers of spheres: a table, and a plot of how far off each is. Lengths over the diagonal, in
// percent.
std::string curve_csv(std::span<const SphereSetBuild> sets, double diagonal);
std::vector<plot::Plot> curve_plots(std::span<const SphereSetBuild> sets, double diagonal, const std::string& title);

}  // namespace orchard::apps
