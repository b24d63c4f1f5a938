#include "input/repair_distance.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace orchard::apps {
namespace {

// A triangle by the places of its corners, whatever their order.
struct PlacedTriangle {
  std::array<std::array<double, 3>, 3> corners;
  Index triangle;
};

bool before(const PlacedTriangle& a, const PlacedTriangle& b) { return a.corners < b.corners; }

std::vector<PlacedTriangle> placed(const TriangleMesh& mesh) {
  std::vector<PlacedTriangle> all;
  all.reserve(mesh.triangles.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    PlacedTriangle& one = all.emplace_back(PlacedTriangle{{}, t});
    for (std::size_t i = 0; i < 3; ++i) {
      const Point& p = mesh.vertices[mesh.triangles[t][i]];
      one.corners[i] = {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};  // -0 is the same place as 0
    }
    std::sort(one.corners.begin(), one.corners.end());
  }
  std::sort(all.begin(), all.end(), before);
  return all;
}

// The triangles of `mesh` that are in `some` and not in `others`, where a second one in the same place counts as one.
TriangleMesh only_in(const TriangleMesh& mesh, const std::vector<PlacedTriangle>& some,
                     const std::vector<PlacedTriangle>& others) {
  TriangleMesh part;
  for (const PlacedTriangle& one : some) {
    if (std::binary_search(others.begin(), others.end(), one, before)) continue;
    const auto first = static_cast<Index>(part.vertices.size());
    for (const Index vertex : mesh.triangles[one.triangle]) part.vertices.push_back(mesh.vertices[vertex]);
    part.triangles.push_back({first, first + 1, first + 2});
  }
  return part;
}

// The search is finer than for a wrap, whose distance is known beforehand, because a closed crack is thin. If two flat
// parts lie on each other but are triangulated differently, the search along the dividing lines never ends. After the
// budget, about a second, the upper bound is slightly wider.
SurfaceDistanceOptions search(const TriangleMesh& from) {
  return {.tolerance = 1e-6, .max_evaluations = 200'000 + 10 * static_cast<Index>(from.triangles.size())};
}

}  // namespace

double RepairDistance::upper() const { return std::max(to_input.upper, from_input.upper); }

RepairDistance repair_distance(const TriangleMesh& input, const Surface& repaired, const Progress& progress) {
  const std::vector<PlacedTriangle> before_repair = placed(input), after_repair = placed(repaired.mesh());
  const TriangleMesh lost = only_in(input, before_repair, after_repair);
  const TriangleMesh gained = only_in(repaired.mesh(), after_repair, before_repair);
  RepairDistance distance;
  if (!gained.triangles.empty())
    distance.to_input = surface_distance(Surface(gained), Surface(input), search(gained), progress);
  if (!lost.triangles.empty()) distance.from_input = surface_distance(Surface(lost), repaired, search(lost), progress);
  return distance;
}

std::string in_words(const RepairDistance& distance, double bounding_radius) {
  if (distance.upper() == 0) return "it lies where the input does";
  const auto length = [&](double value) {
    return fmt::format("{:.6g} ({:.3g} of the bounding radius)", value, value / bounding_radius);
  };
  const double to = distance.to_input.upper, from = distance.from_input.upper;
  return (to == 0 ? "it lies on the input, " : "no point of it is farther than " + length(to) + " from the input, ") +
         (from == 0 ? "which lies on it as a whole"
                    : "no point of the input farther than " + length(from) + " from it");
}

void add_json(const RepairDistance& distance, double bounding_radius, nlohmann::json& repair) {
  repair["repaired_to_input"] = {distance.to_input.lower, distance.to_input.upper};
  repair["input_to_repaired"] = {distance.from_input.lower, distance.from_input.upper};
  repair["distance"] = distance.upper();
  repair["distance_over_radius"] = distance.upper() / bounding_radius;
}

}  // namespace orchard::apps
