#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface_distance.h"

// Makes a closed surface of points with normals, such as a scanner gives.
namespace orchard {

// Points of a surface with the outward direction at each.
struct OrientedPoints {
  std::vector<Point> points;
  std::vector<Vector> normals;  // of length one
};

// Reads points with normals: a .ply file without faces whose vertices have nx, ny and nz, or an .xyz file with six
// numbers on each line. `format` overrides the extension. Returns nullopt if the file is of another kind: a mesh, or a
// format that has no normals. Throws InputError, which names the line or byte and the remedy, if points have no normal,
// or one that is zero or not finite.
std::optional<OrientedPoints> read_oriented_points(const std::filesystem::path& file, const std::string& format = {});

// The options of reconstruct_surface().
struct ReconstructOptions {
  // The largest distance between the mesh and the implicit surface, in mean distances between neighbouring points.
  // Lower values keep smaller features and give more triangles.
  double distance = 0.25;
  // The largest radius of the triangles, in the same unit.
  double radius = 3;
};

// A surface that was made of points.
struct ReconstructedMesh {
  TriangleMesh mesh;
  double spacing = 0;           // The mean distance from a point to its six nearest ones, in mesh units.
  double mean_from_points = 0;  // The mean distance from a point to the surface.
  double max_from_points = 0;   // The largest one.
  SurfaceDistance to_points;  // Proven bounds on the largest distance from a place of the surface to the nearest point.
};

// Returns a closed surface near the points, by Poisson reconstruction. It is smooth, and it closes holes between the
// points; `to_points` tells how wide they are. Throws InputError if there are fewer than 16 points, or if no surface
// can be made of them, and nothing about their quality: see the distances. O(n log n), about 20 us a point. Source:
// CGAL's Poisson_surface_reconstruction_3; Kazhdan, Bolitho and Hoppe 2006.
ReconstructedMesh reconstruct_surface(const OrientedPoints& points, const ReconstructOptions& options = {},
                                      const Progress& progress = {});

}  // namespace orchard
