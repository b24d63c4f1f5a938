#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"

// Reduces a medial axis to a curve skeleton. docs/guide/skeletons.md explains it with pictures.
namespace orchard {

// The options of curve_skeleton(). Lengths are fractions of the diagonal of the surface's bounding box.
//
// A fire that starts at the borders of the axis with the radius there as its time, and that runs along the axis at unit
// speed, burns a point of a sheet at its burn time. Fires that meet leave a curve behind, which a second fire burns
// from its ends. The significance of a place of a curve is the time between both fires: how much longer the curve
// reaches, measured along itself, than the sheets beside it are wide. Along the curve it grows at the rate 1 - cos(a),
// where a is the angle between the curve and the fire of the sheets: not at all where the fire runs along with the
// curve, as on the conical sheet at the flat end of a cylinder, and by the length where it runs across. Where the axis
// is a curve itself, the rate is that at which the radius does not change.
// The end of a curve lies where the fire turns from one to the other: where the significance, less options.ratio for
// each unit of length, is least.
struct SkeletonOptions {
  // The smallest significance, at least 0. Shorter branches are removed; higher values remove more. 0.01 keeps branches
  // that reach 1 % of the diagonal farther than the sheets beside them. Below three edges (edge_length), a branch
  // cannot be told from the triangulation, so the larger of both counts.
  double erosion = 0.01;
  // The smallest rate at which the significance grows, in [0.2, 1), and the smallest significance as a fraction of the
  // time of the second fire. In a branch that runs into a corner of w degrees of a plate, or into the tip of a cone,
  // the rate is 1 - sin(w / 2): 0.29 at 90 degrees. The default of 0.35 removes such branches at corners of more than
  // 81 degrees. The triangulation may change a rate by about 0.07.
  double ratio = 0.35;
  // The longest edge of the complex that burns, and so of the skeleton, above 0. Lower values place the skeleton more
  // accurately, at a cost that grows with the square. It is raised where the complex would have more than about two
  // million triangles.
  double edge_length = 0.0075;
  // The number of rounds in which the curves are straightened, at least 0. A vertex moves by at most two edge lengths.
  int smoothing = 20;
};

// The curves of an axis. Lengths are in mesh units.
struct CurveSkeleton {
  std::vector<Point> vertices;
  std::vector<double> radii;       // The exact distance of each vertex to the surface.
  std::vector<double> burn_times;  // The time at which the first fire reaches each vertex, at least the radius.
  std::vector<std::array<Index, 2>> edges;  // Between vertices, each with the lower vertex first, ascending.

  // A curve between two nodes. A closed curve without another node has its lowest vertex as both ends.
  struct Arc {
    Index from = 0, to = 0;       // Vertices.
    std::vector<Index> vertices;  // Along the curve, ends included.
    double length = 0;
    double min_radius = 0, mean_radius = 0;  // Over the vertices.
    // The largest significance along the curve; infinite for loops and for what joins loops, which no fire burns.
    double significance = 0;
    bool of_axis = false;  // Whether all of it is a curve of the axis too, which has no sheets there.
  };
  std::vector<Index> nodes;  // Vertices at which curves end or meet, and points without curves; ascending.
  std::vector<Arc> arcs;

  // The triangles of closed sheets, with vertices of the skeleton as corners: sheets around cavities have no border at
  // which a fire could start, so that no curve can replace them.
  std::vector<std::array<Index, 3>> sheets;

  double edge_length = 0;  // The longest edge of the complex that burned.
  // The largest distance between a vertex of the skeleton and its place in the complex before it was straightened.
  double max_moved = 0;
  // A proven upper bound on the distance of any place of the skeleton from the axis. Vertices lie on the axis, up to
  // rounding; edges that were moved are chords of its sheets.
  double axis_distance = 0;
};

// Reduces a medial axis to curves. `axis` is the axis of the solid inside `surface`, for example that of
// medial_mesh(build_medial_axis(surface).axis).
// The axis, divided into small triangles, loses its triangles by elementary collapses in the order of their burn times,
// and then the ends of insignificant curves. Collapses keep the homotopy type, so the skeleton has that of the axis:
// its components, loops and cavities, whatever the options are. Straightening then moves the curves within the balls of
// the solid around their places, which is a homotopy in the solid; a vertex that has no room for that stays.
// Throws InputError unless validate(axis) passes and options are in range. The result is deterministic, and the same
// on any number of threads. O(n log n) for n triangles of the divided axis.
// Source: burn times and erosion thickness are those of Yan, Sykes, Chambers, Letscher, Ju: Erosion thickness on medial
// axes of 3D shapes, ACM Transactions on Graphics 35 (4), 2016. The order of collapses and the significance of curves
// are those of Liu, Chambers, Letscher, Ju: A simple and robust thinning algorithm on cell complexes, Computer Graphics
// Forum 29 (7), 2010.
CurveSkeleton curve_skeleton(const Surface& surface, const MedialMesh& axis, const SkeletonOptions& options = {},
                             const Progress& progress = {});

// Returns the skeleton as a medial mesh: its vertices with their radii, its edges, and the triangles of its sheets.
MedialMesh medial_mesh(const CurveSkeleton& skeleton);

// Returns the burn time of every vertex of an axis (SkeletonOptions), in mesh units. Minus the radius of the vertex it
// is the erosion thickness of Yan et al., which is small at spurs of noise and at the border of sheets. It is infinite
// on closed sheets. `edge_length` is that of SkeletonOptions, as a fraction of `diagonal` (mesh units, above 0). Throws
// InputError as curve_skeleton() does.
std::vector<double> burn_times(const MedialMesh& axis, double diagonal,
                               double edge_length = SkeletonOptions{}.edge_length);

// The text of a skeleton in a file format. Numbers have the fewest digits that read back as the same value.
// SWC: a line "number kind x y z radius parent" for each vertex, numbered from 1, with kind 0. The format holds a
// forest, so that every loop is cut at one edge. Comment lines name the edges that were left out, as "# left out: a b",
// and say how many triangles of closed sheets were. The root of a component is its vertex with the largest radius.
std::string to_swc(const CurveSkeleton& skeleton);
// GraphML: the nodes with x, y, z, radius; the arcs with length, mean_radius, min_radius and their kind: "curve" if the
// axis is a curve there, "ridge" if it is a sheet.
std::string to_graphml(const CurveSkeleton& skeleton);
// Wavefront OBJ: vertices, a polyline for each arc, and a triangle for each one of closed sheets.
std::string to_obj(const CurveSkeleton& skeleton);
// CSV: a line "arc,position,x,y,z,radius,burn_time" for each vertex of each arc; the position is the length from the
// start of the arc.
std::string to_csv(const CurveSkeleton& skeleton);
// Returns the edges that to_swc() leaves out, as indices into skeleton.edges, ascending.
std::vector<Index> left_out_of_swc(const CurveSkeleton& skeleton);

}  // namespace orchard
