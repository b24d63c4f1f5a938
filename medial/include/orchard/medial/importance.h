#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"

// Measures of how much a place of a medial axis matters, by which axes are pruned and coloured.
namespace orchard {

// What importance() measures at a ball. Balls that touch the surface at one place only have an angle, a loss, a lambda
// and a path of 0.
enum class ImportanceMeasure : std::uint8_t {
  // The angle at which the two contacts are seen that are seen farthest apart: MedialAxis::angles. Twice the object
  // angle.
  angle,
  // How far the surface lies beyond the ball between these contacts if the axis ends here and the surface is an edge of
  // two planes: r (1 / cos(a / 2) - 1) for a ball of radius r and the angle a; infinite at a half turn.
  border_loss,
  // The radius of the smallest ball that encloses all contacts. Source: Chazal, Lieutier: The lambda medial axis,
  // Graphical Models 67 (4), 2005.
  lambda,
  // The smallest factor s by which all balls can be scaled about their centres such that another one contains this
  // one; infinite for the largest ball. Source: Giesen, Miklos, Pauly, Wormser: The scale axis transform, SCG 2009.
  scale,
  // The erosion thickness: the time at which a fire from the borders of the axis arrives, minus the radius
  // (burn_times()); infinite on closed sheets. Source: Yan, Sykes, Chambers, Letscher, Ju: Erosion thickness on medial
  // axes of 3D shapes, ACM Transactions on Graphics 35 (4), 2016.
  erosion,
  // The length of the shortest path on the surface between the two contacts; infinite where no path joins them. It is
  // found in a graph on the surface, and so an upper bound, by up to a twentieth and one edge of the graph, which is
  // 1/128 of the diagonal long. Source: Dey, Sun: Defining and computing curve-skeletons with medial geodesic function,
  // SGP 2006.
  geodesic,
};
inline constexpr std::array kImportanceMeasures{ImportanceMeasure::angle,   ImportanceMeasure::border_loss,
                                                ImportanceMeasure::lambda,  ImportanceMeasure::scale,
                                                ImportanceMeasure::erosion, ImportanceMeasure::geodesic};

// Returns the name of a measure, which is that of its enumerator, such as "border_loss".
const char* name_of(ImportanceMeasure measure);
// Returns whether the values of a measure are lengths; if not, they are angles or factors.
bool is_length(ImportanceMeasure measure);

// Returns the importance of each vertex of an axis, built or imported: in radians for `angle`, a factor of at least 1
// for `scale`, mesh units for the others. Throws InputError if the axis has no vertices. Deterministic; the work is
// parallel. O(n log n) for n vertices, but for `geodesic`, which in addition visits a part of the surface for each
// vertex: some milliseconds where the contacts lie on opposite sides of a thick part.
std::vector<double> importance(const Surface& surface, const MedialAxis& axis, ImportanceMeasure measure,
                               const Progress& progress = {});

}  // namespace orchard
