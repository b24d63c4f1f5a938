#include <algorithm>

#include "boundary_reach.h"
#include "deep_dents.h"
#include "one_sided.h"
#include "shell_dents.h"

namespace orchard::detail {
namespace {

// Dents deeper than a certain depth are searched in cubes, the others in the shell above that depth. The time for the
// cubes is inversely proportional to the square of the depth; the shell takes more time the more of the solid is as
// thin as it. The numbers that choose the depth:
constexpr double kDeepDent = 3;        // times the dent that is already known
constexpr double kMinDeepDent = 4e-3;  // of the diagonal, at least
constexpr double kOfDeep = 0.1;        // accuracy: what cubes leave open is in the shell

}  // namespace

SearchedMax max_dent(const Surface& surface, const Reconstruction& reconstruction, double known, double accuracy,
                     Index max_parts) {
  if (!one_sided(surface)) return max_deep_dent(surface, reconstruction, known, accuracy, max_parts);
  const double diagonal = surface.bounding_box().diagonal().norm();
  const double deep = std::max(kDeepDent * std::max(known, accuracy), kMinDeepDent * diagonal);
  SearchedMax in_cubes = max_deep_dent(surface, reconstruction, deep, std::max(accuracy, kOfDeep * deep), max_parts);
  if (in_cubes.max > deep) {  // searched again as finely as was asked for
    SearchedMax again = max_deep_dent(surface, reconstruction, in_cubes.max, accuracy, max_parts);
    if (again.max > in_cubes.max) return again;
    in_cubes.upper = again.upper;
    return in_cubes;
  }
  return max_shell_dent(surface, reconstruction, known, in_cubes.upper, accuracy, max_parts);
}

}  // namespace orchard::detail
