#pragma once
#include <vector>

#include "../axis/incidence.h"
#include "borders.h"
#include "free_extension.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// The state of a complex while its sheets are extended from their borders, with the cells and borders from before the
// first triangle was added. `options` and everything passed by reference must outlive it.
struct SheetExtension {
  SheetExtension(const Surface& surface_of_solid, BallComplex& extended, const BorderOptions& border_options)
      : surface(surface_of_solid),
        complex(extended),
        options(border_options),
        at(extended.edges, extended.triangles, extended.size()),
        borders(at.border_edges()),
        triangles(extended) {}

  Index other_end(Index e, Index v) const {
    return complex.edges[e][0] == v ? complex.edges[e][1] : complex.edges[e][0];
  }

  const Surface& surface;
  BallComplex& complex;
  const BorderOptions& options;
  const CellIncidence at;
  const std::vector<Index> borders;  // edges
  FreeExtension triangles;
};

}  // namespace orchard::detail
