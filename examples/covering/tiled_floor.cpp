// Is an L-shaped floor covered by tiles, a round rug and a cut tile in the corner? The boundary lemma proves it, or
// says where a gap begins. Build: cmake --build build/release --target orchard_covering_example; then run
// build/release/examples/covering/orchard_covering_example.
#include <cstdio>
#include <vector>

#include "orchard/covering/planar_cover.h"

using orchard::PlanarShape;
using orchard::PlanePoint;

namespace {

const char* const kNames[] = {"the tile below on the left", "the tile below on the right", "the rug", "the tile above",
                              "the cut tile"};

void report(const std::vector<PlanePoint>& floor, const std::vector<PlanarShape>& pieces) {
  const orchard::PlanarCover cover = orchard::cover_of_polygon(floor, pieces);
  if (cover.covered) {
    std::printf("The floor is covered: proven.\n");
    return;
  }
  for (const orchard::PlanarGap& gap : cover.gaps)
    std::printf("not covered: beside %s, from (%.4f, %.4f) to (%.4f, %.4f)\n", kNames[gap.shape], gap.begin.x(),
                gap.begin.y(), gap.end.x(), gap.end.y());
}

}  // namespace

int main() {
  // Metres. Two tiles share an edge, as tiles do; each neighbour's corner may lie anywhere along it.
  const std::vector<PlanePoint> floor{{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}};
  std::vector<PlanarShape> pieces{
      PlanarShape::rectangle({0, 0}, {1.7, 2}),
      PlanarShape::rectangle({1.7, 0}, {4, 2}),
      PlanarShape::disk({1.2, 2.6}, 1.3),
      PlanarShape::rectangle({0, 2.9}, {2, 4}),
      PlanarShape::polygon({{0, 2}, {0.8, 2}, {0, 3}}),
  };
  report(floor, pieces);

  // A smaller rug leaves gaps.
  pieces[2].radius = 0.9;
  report(floor, pieces);
}
