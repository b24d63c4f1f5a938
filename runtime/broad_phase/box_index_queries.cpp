#include <cmath>

#include "broad_phase/box_index.h"

// Queries find the bodies that they may concern by the boxes. A box contains the sphere of its body from the step of
// its update to the end of its window.
namespace orchard::runtime::detail {
namespace {

constexpr double kSpare = 1;           // quanta; more than all rounding errors within the grid
constexpr double kFarOrigin = 0x1p44;  // quanta; farther away, rounding errors are too large
constexpr double kBeyond = std::numeric_limits<double>::infinity();
constexpr std::size_t kPortion = 16;    // about so many bodies are visited together
constexpr std::size_t kFewCells = 64;   // so many cells may be read even if there are fewer bodies
constexpr double kCellsPerSlab = 2.25;  // the most cells of a ray in a slab, on average

std::uint32_t quantum_below(double q) noexcept {
  const double down = std::floor(q - kSpare);
  return !(down > 0) ? 0 : down >= kLastQuantum ? kLastQuantum : static_cast<std::uint32_t>(down);
}
std::uint32_t quantum_above(double q) noexcept {
  const double up = std::ceil(q + kSpare);
  return !(up > 0) ? 0 : up >= kLastQuantum ? kLastQuantum : static_cast<std::uint32_t>(up);
}

// Returns what both boxes have in common. It is empty (a lower end is above its upper end) if there is nothing.
QuantizedAabb common(const QuantizedAabb& a, const QuantizedAabb& b) noexcept {
  QuantizedAabb both{};
  for (std::size_t d = 0; d < 3; ++d) {
    both.lower[d] = std::max(a.lower[d], b.lower[d]);
    both.upper[d] = std::min(a.upper[d], b.upper[d]);
  }
  return both;
}

// Returns the number of cells that have to be read; 0 for an empty box.
double cells_in(const QuantizedAabb& box) noexcept {
  double cells = 1;
  for (std::size_t d = 0; d < 3; ++d) {
    const bool empty = box.lower[d] > box.upper[d];
    cells *= empty ? 0 : (box.upper[d] >> kQuantumBits) - (box.lower[d] >> kQuantumBits) + 1.0;
  }
  return cells;
}

}  // namespace

// A ray in quanta, from `begin` to `end` along a direction of length 1.
struct BoxIndex::GridRay {
  std::array<double, 3> origin, way;
  double begin, end;
  std::size_t axis = 0;  // the axis along which it is fastest

  double at(std::size_t d, double t) const noexcept { return origin[d] + t * way[d]; }
  void clip(const QuantizedAabb& box) noexcept {
    for (std::size_t d = 0; d < 3; ++d) {
      // A box at an end of the quantized grid may stand for one that reaches beyond it.
      const double lower = box.lower[d] == 0 ? -kBeyond : box.lower[d] - 2 * kSpare,
                   upper = box.upper[d] == kLastQuantum ? kBeyond : box.upper[d] + 2 * kSpare;
      if (way[d] == 0) {
        if (!(lower <= origin[d] && origin[d] <= upper)) end = -1;
        continue;
      }
      const double enter = (lower - origin[d]) / way[d], leave = (upper - origin[d]) / way[d];
      begin = std::max(begin, std::min(enter, leave));
      end = std::min(end, std::max(enter, leave));
    }
  }
  bool meets(const QuantizedAabb& box) const noexcept {
    GridRay part = *this;
    part.clip(box);
    return part.begin <= part.end;
  }
};

void BoxIndex::append_in_cells(const QuantizedAabb& box, std::vector<BodyIndex>& bodies) const {
  grid_.visit_cells(box, [&](BodyIndex body) {
    if (boxes_[body].meets(box)) bodies.push_back(body);
  });
}

std::size_t BoxIndex::fewest_cells() const noexcept { return std::max(kFewCells, places_.size()); }

Near BoxIndex::near_box(const QuantizedGrid& grid, const Vec3& lower, const Vec3& upper,
                        std::vector<BodyIndex>& bodies) const {
  QuantizedAabb box{};
  for (std::size_t d = 0; d < 3; ++d) {
    box.lower[d] = quantum_below(grid.quantum(lower[d], d));
    box.upper[d] = quantum_above(grid.quantum(upper[d], d));
  }
  const QuantizedAabb inside = common(box, extent_);
  const double cells = cells_in(inside);
  if (cells > static_cast<double>(fewest_cells())) {
    for (BodyIndex body = 0; body < places_.size(); ++body) {
      if (places_[body] == Place::inside && boxes_[body].meets(box)) bodies.push_back(body);
    }
  } else if (cells > 0) {
    append_in_cells(inside, bodies);
  }
  bool whole = inside.lower == extent_.lower && inside.upper == extent_.upper;
  for (const Oversized& large : oversized_) {
    const bool meets = large.box.meets(box);
    if (meets) bodies.push_back(large.body);
    whole = whole && meets;
  }
  return whole ? Near::all : Near::some;
}

// Visits the bodies near the ray in one slab of cells after another. Slabs are across the axis along which the ray is
// fastest, because it crosses few cells in each. Returns false if visit() has returned false.
bool BoxIndex::walk_slabs(const QuantizedGrid& grid, const GridRay& ray, std::vector<BodyIndex>& portion,
                          const VisitPortion& visit) const {
  const std::size_t m = ray.axis;
  const auto slab_at = [&](double t) {
    return static_cast<std::int64_t>(std::floor(std::clamp(ray.at(m, t), 0.0, double{kLastQuantum}) / kQuanta));
  };
  const std::int64_t step = ray.way[m] > 0 ? 1 : -1, last = slab_at(ray.end);
  for (std::int64_t slab = slab_at(ray.begin);; slab += step) {
    const double near = static_cast<double>(kQuanta * (step > 0 ? slab : slab + 1)),
                 far = static_cast<double>(kQuanta * (step > 0 ? slab + 1 : slab));
    const auto time_at = [&](double q) { return (q - ray.origin[m]) / ray.way[m]; };
    const double spare = kSpare * static_cast<double>(step);
    const double from = std::max(ray.begin, time_at(near - spare)), to = std::min(ray.end, time_at(far + spare));
    QuantizedAabb box{};
    for (std::size_t d = 0; d < 3; ++d) {
      box.lower[d] = quantum_below(std::min(ray.at(d, from), ray.at(d, to)));
      box.upper[d] = quantum_above(std::max(ray.at(d, from), ray.at(d, to)));
    }
    box.lower[m] = static_cast<std::uint32_t>(std::min(near, far));
    box.upper[m] = box.lower[m] + (kQuanta - 1);
    append_in_cells(box, portion);
    if (slab == last) break;
    if (portion.size() < kPortion) continue;
    if (!visit(portion, time_at(far - spare) / grid.quanta(1))) return false;
    portion.clear();
  }
  return true;
}

bool BoxIndex::along(const QuantizedGrid& grid, const Vec3& origin, const Vec3& way, double length,
                     std::vector<BodyIndex>& portion, const VisitPortion& visit) const {
  GridRay ray{{}, way, 0, grid.quanta(length)};
  for (std::size_t d = 0; d < 3; ++d) {
    ray.origin[d] = grid.quantum(origin[d], d);
    if (!(std::fabs(ray.origin[d]) <= kFarOrigin)) return false;
    if (std::fabs(way[d]) > std::fabs(way[ray.axis])) ray.axis = d;
  }
  for (const Oversized& large : oversized_) {
    if (ray.meets(large.box)) portion.push_back(large.body);
  }
  const bool any = extent_.lower[0] <= extent_.upper[0];
  if (any) ray.clip(extent_);
  if (any && ray.begin <= ray.end) {
    const double slabs = std::fabs(ray.at(ray.axis, ray.end) - ray.at(ray.axis, ray.begin)) / kQuanta;
    if (kCellsPerSlab * slabs <= static_cast<double>(fewest_cells())) {
      if (!walk_slabs(grid, ray, portion, visit)) return true;
    } else {
      for (BodyIndex body = 0; body < places_.size(); ++body) {
        if (places_[body] == Place::inside && ray.meets(boxes_[body].whole())) portion.push_back(body);
      }
    }
  }
  visit(portion, length);
  return true;
}

}  // namespace orchard::runtime::detail
