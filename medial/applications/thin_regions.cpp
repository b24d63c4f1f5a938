#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "orchard/geometry/disjoint_sets.h"
#include "orchard/medial/thickness.h"

namespace orchard {
namespace {

constexpr double kLimitRounding = 1e-9;  // of a limit: what is below it by less is not

double area_of(const TriangleMesh& mesh, Index triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
}

// Unites triangles that are both chosen and share a corner.
DisjointSets joined_at_corners(const TriangleMesh& mesh, const std::vector<std::uint8_t>& chosen) {
  DisjointSets sets(mesh.triangles.size());
  std::vector<Index> first_at(mesh.vertices.size(), kNone);
  for (Index triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    if (!chosen[triangle]) continue;
    for (const Index corner : mesh.triangles[triangle]) {
      if (first_at[corner] == kNone) first_at[corner] = triangle;
      sets.unite(first_at[corner], triangle);
    }
  }
  return sets;
}

void add(ThinRegion& region, const TriangleMesh& mesh, Index triangle, double area, double thickness) {
  region.area += area;
  ++region.triangles;
  const auto& [a, b, c] = mesh.triangles[triangle];
  for (const Index corner : {a, b, c}) region.box.extend(mesh.vertices[corner]);
  if (region.triangles > 1 && thickness >= region.min_thickness) return;
  region.min_thickness = thickness;
  region.thinnest = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
}

// The largest region comes first; equally large ones come in the order of their first triangle.
void sort_by_area(ThinRegions& result) {
  std::vector<Index> order(result.regions.size()), place(result.regions.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return result.regions[a].area > result.regions[b].area; });
  std::vector<ThinRegion> sorted;
  for (Index i = 0; i < order.size(); ++i) {
    sorted.push_back(result.regions[order[i]]);
    place[order[i]] = i;
  }
  result.regions = std::move(sorted);
  for (Index& region : result.of_triangle) {
    if (region != kNone) region = place[region];
  }
}

}  // namespace

ThinRegions thin_regions(const LocalThickness& thickness, double below) {
  const TriangleMesh& mesh = thickness.mesh;
  const std::vector<double>& values = thickness.at_triangles.thickness;
  std::vector<std::uint8_t> thin(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) thin[i] = values[i] < (1 - kLimitRounding) * below ? 1 : 0;
  DisjointSets sets = joined_at_corners(mesh, thin);
  ThinRegions result;
  result.of_triangle.assign(values.size(), kNone);
  for (Index triangle = 0; triangle < values.size(); ++triangle) {
    const double area = area_of(mesh, triangle);
    result.total_area += area;
    if (!std::isnan(values[triangle])) result.defined_area += area;
    if (!thin[triangle]) continue;
    result.area += area;
    const Index first = sets.root(triangle);  // the lowest, so it has a region already
    if (first == triangle) result.regions.emplace_back();
    result.of_triangle[triangle] =
        first == triangle ? static_cast<Index>(result.regions.size() - 1) : result.of_triangle[first];
    add(result.regions[result.of_triangle[triangle]], mesh, triangle, area, values[triangle]);
  }
  sort_by_area(result);
  return result;
}

ThicknessHistogram thickness_histogram(const LocalThickness& thickness, Index bins) {
  ThicknessHistogram histogram;
  const ThicknessValues& values = thickness.at_triangles;
  double largest = 0;
  for (const double diameter : values.ball_diameter) {
    if (diameter > largest) largest = diameter;
  }
  histogram.bin_width = largest / bins;
  histogram.thickness.assign(bins, 0);
  histogram.ball_diameter.assign(bins, 0);
  const auto add_to = [&](std::vector<double>& areas, double value, double area) {
    if (std::isnan(value) || !(largest > 0)) return;
    const auto bin = static_cast<std::size_t>(std::floor(value / histogram.bin_width));
    areas[std::min<std::size_t>(bin, bins - 1)] += area;
  };
  for (Index triangle = 0; triangle < values.thickness.size(); ++triangle) {
    const double area = area_of(thickness.mesh, triangle);
    add_to(histogram.thickness, values.thickness[triangle], area);
    add_to(histogram.ball_diameter, values.ball_diameter[triangle], area);
  }
  return histogram;
}

}  // namespace orchard
