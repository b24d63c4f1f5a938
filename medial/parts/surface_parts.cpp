#include "orchard/medial/surface_parts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include "../applications/divided_mesh.h"
#include "../axis/incidence.h"
#include "../skeleton/fine_complex.h"
#include "orchard/geometry/error.h"
#include "orchard/medial/structure.h"
#include "orchard/medial/thickness.h"
#include "patches.h"
#include "radius_regions.h"

namespace orchard {
namespace {

// The average area of a triangle after its edges have been halved until they are short enough, over the squared longest
// edge. Measured on meshes with few long edges.
constexpr double kAreaOfDividedEdge = 0.21;

void require_part_options(const PartOptions& options) {
  if (!(options.neck >= 0 && options.neck <= 1)) throw InputError("parts: neck must be between 0 and 1");
  if (!(options.min_area >= 0 && std::isfinite(options.min_area)))
    throw InputError("parts: min_area must be at least 0 and finite");
  if (options.samples == 0) throw InputError("parts: samples must be at least 1");
  if (options.smoothing < 0) throw InputError("parts: smoothing must be at least 0");
  if (!(options.edge_length > 0 && std::isfinite(options.edge_length)))
    throw InputError("parts: edge_length must be above 0 and finite");
}

// A divided axis as triangles that can be searched. Degenerate triangles represent edges without triangles and single
// vertices.
class SearchedAxis {
 public:
  explicit SearchedAxis(const MedialMesh& mesh)
      : mesh_(mesh), structure_(medial_structure(mesh)), cells_(cells_of(mesh, structure_)), surface_(cells_.mesh) {}

  // Returns the part of the structure that is nearest to a place, and the nearest vertex.
  std::pair<Index, Index> nearest(const Point& place) const {
    const ClosestPoint found = surface_.closest(place);
    Index vertex = kNone;
    for (const Index corner : cells_.corners[found.triangle]) {
      if (vertex == kNone || distance(corner, found.position) < distance(vertex, found.position)) vertex = corner;
    }
    return {cells_.parts[found.triangle], vertex};
  }

 private:
  struct Cells {
    TriangleMesh mesh;
    std::vector<std::array<Index, 3>> corners;  // vertices of the axis
    std::vector<Index> parts;
  };

  double distance(Index vertex, const Point& place) const { return (mesh_.centers[vertex] - place).norm(); }

  static Cells cells_of(const MedialMesh& mesh, const MedialStructure& structure) {
    Cells cells{.mesh = {mesh.centers, mesh.triangles}, .corners = mesh.triangles, .parts = structure.of_face};
    const auto add_flat = [&](Index a, Index b, Index part) {
      const Index first = static_cast<Index>(cells.mesh.vertices.size());
      for (const Index corner : {a, b, b}) cells.mesh.vertices.push_back(mesh.centers[corner]);
      cells.mesh.triangles.push_back({first, first + 1, first + 2});
      cells.corners.push_back({a, b, b});
      cells.parts.push_back(part);
    };
    const detail::CellIncidence at(mesh.edges, mesh.triangles, mesh.size());
    for (const Index edge : at.bare_edges())
      add_flat(mesh.edges[edge][0], mesh.edges[edge][1], structure.of_edge[edge]);
    for (const Index vertex : at.lone_vertices()) add_flat(vertex, vertex, structure.of_vertex[vertex]);
    return cells;
  }

  const MedialMesh& mesh_;
  MedialStructure structure_;
  Cells cells_;
  Surface surface_;
};

// The label of a triangle before labels are numbered: the part of the structure and the region. Either is kNone if it
// is not used.
using RawLabel = std::pair<Index, Index>;

std::vector<RawLabel> raw_labels(const Surface& surface, const SearchedAxis& axis, const std::vector<Index>& regions,
                                 PartKind kind, const Progress& progress, SurfaceParts& parts) {
  std::vector<SurfacePlace> middles;
  for (std::size_t i = 0; i < parts.mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = parts.mesh.triangles[i];
    const auto& vertices = parts.mesh.vertices;
    middles.push_back({(vertices[a] + vertices[b] + vertices[c]) / 3, parts.of_triangle[i], Feature::face});
  }
  const std::vector<ThicknessAt> balls = thickness_at(surface, middles, {}, progress);
  std::vector<RawLabel> labels(middles.size());
  parts.radii.assign(middles.size(), 0);
  tbb::parallel_for(std::size_t{0}, middles.size(), [&](std::size_t i) {
    if (std::isfinite(balls[i].diameter)) parts.radii[i] = balls[i].diameter / 2;
    const auto [sheet, vertex] = axis.nearest(middles[i].position - parts.radii[i] * balls[i].normal);
    labels[i] = {kind == PartKind::necks ? kNone : sheet, kind == PartKind::sheets ? kNone : regions[vertex]};
  });
  return labels;
}

// Numbers the labels in their order, and sorts the parts of the result by area.
void set_parts(const std::vector<RawLabel>& raw, const PartOptions& options, SurfaceParts& parts) {
  std::map<RawLabel, Index> numbers;
  for (const RawLabel& label : raw) numbers.try_emplace(label, 0);
  std::vector<RawLabel> names;
  names.reserve(numbers.size());
  for (auto& [label, number] : numbers) {
    number = static_cast<Index>(names.size());
    names.push_back(label);
  }
  std::vector<Index> labels;
  labels.reserve(raw.size());
  for (const RawLabel& label : raw) labels.push_back(numbers.at(label));
  const detail::PatchMesh patches(parts.mesh);
  patches.smooth(labels, options.smoothing);
  const double total = std::accumulate(patches.areas().begin(), patches.areas().end(), 0.0);
  patches.join_small(labels, options.min_area * total);

  std::vector<SurfaceParts::Part> found(names.size());
  Index patch_count = 0;
  const std::vector<Index> patch = patches.patches(labels, patch_count);
  std::vector<std::uint8_t> seen(patch_count, 0);
  for (Index t = 0; t < labels.size(); ++t) {
    SurfaceParts::Part& part = found[labels[t]];
    ++part.triangles;
    part.area += patches.areas()[t];
    part.max_radius = std::max(part.max_radius, parts.radii[t]);
    if (!std::exchange(seen[patch[t]], std::uint8_t{1})) ++part.patches;
  }
  std::vector<Index> order;
  for (Index i = 0; i < found.size(); ++i) {
    std::tie(found[i].sheet, found[i].region) = names[i];
    if (found[i].triangles > 0) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return found[a].area > found[b].area; });
  std::vector<Index> renumbered(found.size(), kNone);
  for (const Index i : order) {
    renumbered[i] = static_cast<Index>(parts.parts.size());
    parts.parts.push_back(found[i]);
  }
  for (const Index label : labels) parts.parts_of.push_back(renumbered[label]);
}

}  // namespace

SurfaceParts surface_parts(const Surface& surface, const MedialMesh& axis, const PartOptions& options,
                           const Progress& progress) {
  require_part_options(options);
  if (!surface.solid())
    throw InputError("parts: a closed, consistently oriented manifold is needed: " + surface.report().faults() +
                     "; repair the mesh first");
  validate(axis);
  report_progress(progress, "parts", 0);
  const double wanted = options.edge_length * surface.bounding_box().diagonal().norm();
  const MedialMesh fine = detail::divided(axis, detail::affordable_edge_length(axis, wanted));
  const SearchedAxis searched(fine);
  detail::RadiusRegions regions = detail::radius_regions(fine, options.neck);
  detail::DividedMesh divided =
      detail::divided_mesh(surface, std::sqrt(surface.report().area / (kAreaOfDividedEdge * options.samples)));
  SurfaceParts parts;
  parts.mesh = std::move(divided.mesh);
  parts.of_triangle = std::move(divided.of_triangle);
  const std::vector<RawLabel> raw = raw_labels(surface, searched, regions.of_vertex, options.kind, progress, parts);
  set_parts(raw, options, parts);
  parts.regions = regions.count;
  parts.necks = std::move(regions.necks);
  report_progress(progress, "parts", 1);
  return parts;
}

TriangleMesh part_mesh(const SurfaceParts& parts, Index part) {
  TriangleMesh mesh;
  std::vector<Index> renumbered(parts.mesh.vertices.size(), kNone);
  for (std::size_t t = 0; t < parts.parts_of.size(); ++t) {
    if (parts.parts_of[t] != part) continue;
    for (const Index corner : parts.mesh.triangles[t]) renumbered[corner] = 0;
  }
  for (std::size_t v = 0; v < renumbered.size(); ++v) {
    if (renumbered[v] == kNone) continue;
    renumbered[v] = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.push_back(parts.mesh.vertices[v]);
  }
  for (std::size_t t = 0; t < parts.parts_of.size(); ++t) {
    if (parts.parts_of[t] != part) continue;
    const auto& [a, b, c] = parts.mesh.triangles[t];
    mesh.triangles.push_back({renumbered[a], renumbered[b], renumbered[c]});
  }
  return mesh;
}

}  // namespace orchard
