#include "output/sphere_arrays.h"

namespace orchard::apps {
namespace {

void add_sphere(const Sphere& sphere, std::vector<double>& rows) {
  rows.insert(rows.end(), {sphere.center.x(), sphere.center.y(), sphere.center.z(), sphere.radius});
}

}  // namespace

std::vector<NamedArray> tree_arrays(const SphereTree& tree) {
  std::vector<double> spheres, inaccuracies;
  std::vector<std::int32_t> levels, parents;
  for (const SphereNode& node : tree.nodes) {
    add_sphere(node.sphere, spheres);
    inaccuracies.push_back(node.inaccuracy);
    levels.push_back(static_cast<std::int32_t>(node.level));
    parents.push_back(node.parent == kNone ? -1 : static_cast<std::int32_t>(node.parent));
  }
  return {{"spheres", {"x", "y", "z", "radius"}, std::move(spheres)},
          {"inaccuracy", {"inaccuracy"}, std::move(inaccuracies)},
          {"level", {"level"}, std::move(levels)},
          {"parent", {"parent"}, std::move(parents)}};
}

std::vector<NamedArray> set_arrays(std::span<const Sphere> spheres, std::span<const double> masses) {
  std::vector<double> rows;
  for (const Sphere& sphere : spheres) add_sphere(sphere, rows);
  std::vector<NamedArray> arrays{{"spheres", {"x", "y", "z", "radius"}, std::move(rows)}};
  if (!masses.empty()) arrays.push_back({"mass", {"mass"}, std::vector<double>(masses.begin(), masses.end())});
  return arrays;
}

}  // namespace orchard::apps
