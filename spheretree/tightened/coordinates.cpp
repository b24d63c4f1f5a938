#include "coordinates.h"

#include <algorithm>

#include "wide.h"

namespace orchard::detail {
namespace {

struct Block {
  const double *x, *y, *z;
  std::size_t count;
  double* squared;
};

inline void measure(const Block& block, const Point& from) {
  const double cx = from.x(), cy = from.y(), cz = from.z();
  const double* __restrict x = block.x, * __restrict y = block.y, * __restrict z = block.z;
  double* __restrict squared = block.squared;
  for (std::size_t k = 0; k < block.count; ++k) {
    const double dx = x[k] - cx, dy = y[k] - cy, dz = z[k] - cz;
    squared[k] = dx * dx + (dy * dy + dz * dz);
  }
}

ORCHARD_FOR_AVX2 void measure_wide(const Block& block, const Point& from) { measure(block, from); }

}  // namespace

void Coordinates::push_back(const Point& point) {
  x.push_back(point.x());
  y.push_back(point.y());
  z.push_back(point.z());
}

std::size_t Coordinates::measure_block(std::size_t begin, const Point& from, double* squared) const {
  const Block block{x.data() + begin, y.data() + begin, z.data() + begin, std::min(kBlock, size() - begin), squared};
  wide() ? measure_wide(block, from) : measure(block, from);
  return block.count;
}

}  // namespace orchard::detail
