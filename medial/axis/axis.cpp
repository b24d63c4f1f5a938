#include "orchard/medial/axis.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "coalesce.h"
#include "contact_angles.h"
#include "incidence.h"
#include "interior.h"
#include "keep_topology.h"
#include "medial_faces.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"
#include "point_normals.h"

namespace orchard {
namespace {

bool is_stem(const std::vector<Index>& stems, Index vertex) { return !stems.empty() && stems[vertex] != kNone; }

// Whether an edge of the diagram is kept in the axis. Vertices that a stem joins (keep_topology.h) keep only their
// stem.
bool joined(const std::vector<Index>& stems, Index a, Index b) {
  return (!is_stem(stems, a) && !is_stem(stems, b)) || stems[a] == b || stems[b] == a;
}

// Returns the medial vertex of each Voronoi vertex; kNone for vertices outside. Vertices that hang on a stem are never
// merged with others, because that might close a loop.
std::vector<Index> number_medial_vertices(const VoronoiDiagram& diagram, const std::vector<std::uint8_t>& inside,
                                          const std::vector<Index>& stems, double coalesce, MedialAxis& axis) {
  std::vector<Index> interior;
  std::vector<Point> centers;
  for (Index i = 0; i < inside.size(); ++i) {
    if (!inside[i] || is_stem(stems, i)) continue;
    interior.push_back(i);
    centers.push_back(diagram.vertices[i].center);
  }
  const std::vector<Index> representatives = detail::representatives_of_coincident(centers, coalesce);
  std::vector<Index> medial(diagram.vertices.size(), kNone);
  for (Index i = 0; i < interior.size(); ++i) {
    if (representatives[i] == i) {
      medial[interior[i]] = axis.size();
      axis.centers.push_back(centers[i]);
    } else {
      // The representative has a lower index, so it already has its number.
      medial[interior[i]] = medial[interior[representatives[i]]];
    }
  }
  for (Index i = 0; i < inside.size(); ++i) {
    if (!inside[i] || !is_stem(stems, i)) continue;
    medial[i] = axis.size();
    axis.centers.push_back(diagram.vertices[i].center);
    ++axis.stems;
  }
  return medial;
}

void connect(const VoronoiDiagram& diagram, const std::vector<Index>& medial, const detail::KeptTopology& kept,
             MedialAxis& axis) {
  std::vector<std::array<Index, 2>> forming, adjacent;
  for (Index i = 0; i < medial.size(); ++i) {
    if (medial[i] == kNone) continue;
    const VoronoiVertex& vertex = diagram.vertices[i];
    for (const Index point : vertex.forming_points) forming.push_back({medial[i], point});
    for (const Index next : vertex.neighbors) {
      if (next != kNone && medial[next] != kNone && medial[next] != medial[i] && joined(kept.stems, i, next)) {
        adjacent.push_back({medial[i], medial[next]});
      }
    }
  }
  for (const auto& [a, b] : kept.bridges) {
    if (medial[a] == medial[b]) continue;
    adjacent.push_back({medial[a], medial[b]});
    adjacent.push_back({medial[b], medial[a]});
    ++axis.bridges;
  }
  axis.forming_points = detail::rows_of(forming, axis.size());
  axis.neighbors = detail::rows_of(adjacent, axis.size());
}

// Sets each radius to the distance of the farthest forming point. The radius of the diagram would not do: coalescing
// has moved centres a little, robust diagrams approximate some centres, and merging needs balls that contain their
// forming points.
void measure_radii(MedialAxis& axis) {
  axis.radii.resize(axis.size());
  for (Index i = 0; i < axis.size(); ++i) {
    double squared = 0;
    for (const Index point : axis.forming_points[i]) {
      squared = std::max(squared, (axis.points[point] - axis.centers[i]).squaredNorm());
    }
    axis.radii[i] = std::sqrt(squared);
  }
}

[[noreturn]] void fail(const char* what, Index where) {
  throw Error("medial axis: " + std::string(what) + " at vertex " + std::to_string(where));
}

void validate_row(std::span<const Index> row, Index limit, const char* what, Index where) {
  for (std::size_t k = 0; k < row.size(); ++k) {
    if (row[k] >= limit || (k > 0 && row[k - 1] >= row[k])) fail(what, where);
  }
}

void validate_faces(const Rows& faces, const std::vector<std::array<Index, 2>>& face_points, Index vertices,
                    Index points) {
  for (Index face = 0; face < faces.size(); ++face) {
    if (faces[face].size() < 3) throw Error("medial axis: face " + std::to_string(face) + " has no area");
    for (const Index corner : faces[face]) {
      if (corner >= vertices)
        throw Error("medial axis: face " + std::to_string(face) + " names a vertex that does not exist, or one twice");
    }
    for (const Index point : face_points[face]) {
      if (point >= points)
        throw Error("medial axis: face " + std::to_string(face) +
                    " names a point that does not exist, or the same one twice");
    }
  }
}

}  // namespace

MedialAxis medial_axis(const Surface& surface, const SurfaceSampling& sampling, const VoronoiDiagram& diagram,
                       const AxisOptions& options, const Progress& progress) {
  MedialAxis axis;
  detail::add_points(surface, sampling, axis);
  std::vector<std::uint8_t> inside = detail::interior_vertices(surface, diagram, progress);
  report_progress(progress, "medial axis", 0.3);
  const VoronoiFaces faces = voronoi_faces(diagram);
  detail::KeptTopology kept;
  if (options.keep_topology) kept = detail::keep_topology(surface, sampling, diagram, faces, inside);
  axis.left_out = kept.left_out;
  const std::vector<Index> medial =
      number_medial_vertices(diagram, inside, kept.stems, options.coalesce * surface.bounding_radius(), axis);
  report_progress(progress, "medial axis", 0.6);
  connect(diagram, medial, kept, axis);
  measure_radii(axis);
  detail::find_contact_angles(surface, sampling, axis);
  detail::find_medial_faces(surface, sampling, faces, medial, kept.stems, axis);
  report_progress(progress, "medial axis", 1);
  return axis;
}

std::vector<Index> connected_components(const MedialAxis& axis, Index& count) {
  std::vector<Index> components(axis.size(), kNone);
  std::vector<Index> open;
  count = 0;
  for (Index start = 0; start < axis.size(); ++start) {
    if (components[start] != kNone) continue;
    components[start] = count;
    open.push_back(start);
    while (!open.empty()) {
      const Index vertex = open.back();
      open.pop_back();
      for (const Index next : axis.neighbors[vertex]) {
        if (components[next] != kNone) continue;
        components[next] = count;
        open.push_back(next);
      }
    }
    ++count;
  }
  return components;
}

void validate(const MedialAxis& axis, const Surface& surface) {
  const Index size = axis.size();
  const Index points = static_cast<Index>(axis.points.size());
  if (axis.normals.size() != points || axis.turns.size() != points || axis.radii.size() != size ||
      axis.angles.size() != size || axis.forming_points.size() != size || axis.neighbors.size() != size ||
      axis.face_points.size() != axis.faces.size() || axis.topology_face_points.size() != axis.topology_faces.size() ||
      axis.origins.size() != points) {
    throw Error("medial axis: arrays of different lengths");
  }
  for (Index i = 0; i < size; ++i) {
    validate_row(axis.forming_points[i], points, "bad forming points", i);
    validate_row(axis.neighbors[i], size, "bad neighbours", i);
    if (axis.forming_points[i].size() < 4) fail("fewer than four forming points", i);
    for (const Index next : axis.neighbors[i]) {
      const auto back = axis.neighbors[next];
      if (next == i || !std::binary_search(back.begin(), back.end(), i)) fail("adjacency is not symmetric", i);
    }
    if (!(axis.radii[i] > 0)) fail("no radius", i);
    if (!surface.inside(axis.centers[i])) fail("centre outside the surface", i);
  }
  validate_faces(axis.faces, axis.face_points, size, points);
  validate_faces(axis.topology_faces, axis.topology_face_points, size, points);
}

}  // namespace orchard
