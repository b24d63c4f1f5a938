#include "set_options.h"

#include "a_number.h"
#include "list_option.h"

namespace orchard::apps {

void add_set_options(CLI::App& command, SpheresCommand& spheres) {
  SphereSetOptions& options = spheres.options;
  command.add_option("-n,--spheres", options.spheres, "How many: exactly so many, or with an error at most")
      ->check(CLI::Range(1, static_cast<int>(kMaxSetSpheres)))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--fit",
          [&options](const std::string& name) {
            options.fit = name == "inside"     ? SphereFit::inside
                          : name == "balanced" ? SphereFit::balanced
                                               : SphereFit::cover;
          },
          "The promise: cover (hold the whole surface, the default), inside (lie in the solid) or balanced (the "
          "solid's "
          "volume, and a boundary near its surface)")
      ->check(CLI::IsMember({"cover", "inside", "balanced"}));
  command
      .add_option(
          "--error", spheres.error,
          "The fewest spheres with this error, in percent of the diagonal: how far a cover sticks out, how far the "
          "surface is from spheres inside, the mean two-sided distance of balanced ones")
      ->check(ANumber(CLI::Range(1e-4, 100.0)));
  command
      .add_option(
          "--volume-error", spheres.volume_error,
          "The same by volume, in percent of the solid's: what of a cover lies outside, what is left out inside")
      ->check(ANumber(CLI::Range(1e-3, 1000.0)));
  command.add_flag("--solid", options.solid, "A cover of the whole solid, not of its surface alone");
  command
      .add_option("--padding", options.padding,
                  "A cover of every point up to this far from the surface, in mesh units: added to all radii")
      ->check(ANumber(CLI::Range(0.0, 1e15)))
      ->capture_default_str();
  command.add_option("--min-radius", options.min_radius, "No sphere of a cover is smaller, in mesh units")
      ->check(ANumber(CLI::Range(0.0, 1e15)))
      ->capture_default_str();
  command
      .add_option_function<std::string>(
          "--effort",
          [&options](const std::string& name) {
            options.effort = name == "low" ? Effort::low : name == "high" ? Effort::high : Effort::standard;
          },
          "How long to search: low, standard (default) or high")
      ->check(CLI::IsMember({"low", "standard", "high"}));
  command.add_option("--seed", options.seed, "Of all random choices")->capture_default_str();
  add_list(command, "--curve", spheres.curve,
           "Make sets of these numbers of spheres as well, and write how far off each is: MODEL-set-curve.csv and .svg",
           1, kMaxSetSpheres);
}

}  // namespace orchard::apps
