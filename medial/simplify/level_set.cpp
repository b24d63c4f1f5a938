#include "level_set.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace orchard::detail {
namespace {

constexpr double kLipschitzSlack = 1e-9;  // larger than the rounding error of a bound
// Of a grid edge: vertices are at least this far from its ends, so that no two coincide.
constexpr double kFromEdgeEnd = 1e-4;
constexpr int kIllinoisSteps = 40;   // maximum number of steps in the search for a vertex
constexpr double kOnSurface = 1e-9;  // cells

using Lattice = std::array<std::uint32_t, 3>;

// Returns a place of the lattice as a number by which places can be sorted. The lowest three bits are free for the
// edges that start there.
std::uint64_t key_of(const Lattice& at) { return (((std::uint64_t{at[0]} << 20) | at[1]) << 20 | at[2]) << 3; }
Lattice lattice_of(std::uint64_t key) {
  constexpr std::uint64_t kMask = (1u << 20) - 1;
  return {static_cast<std::uint32_t>(key >> 43 & kMask), static_cast<std::uint32_t>(key >> 23 & kMask),
          static_cast<std::uint32_t>(key >> 3 & kMask)};
}
// Returns the corner of a cube, given one bit for each axis.
Lattice corner_of(const Lattice& cube, unsigned bits) {
  return {cube[0] + (bits & 1), cube[1] + (bits >> 1 & 1), cube[2] + (bits >> 2 & 1)};
}

void sort_unique_keys(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

// The corners of a tetrahedron ascend along the diagonal of the cube, so each edge starts at its lower corner.
std::uint64_t edge_of(const Lattice& cube, unsigned from, unsigned to) {
  if (from > to) std::swap(from, to);
  return key_of(corner_of(cube, from)) | (to ^ from);
}

}  // namespace

LevelSet::LevelSet(std::function<double(const Point&)> value, const Box& box, double cell, const Progress& progress,
                   const char* stage)
    : value_(std::move(value)),
      progress_(progress),
      stage_(stage),
      cell_(cell),
      origin_(box.min() - Vector::Constant(1.5 * cell)) {
  const double extent = box.sizes().maxCoeff() + 3 * cell_;
  while (static_cast<double>(1u << levels_) * cell_ < extent) ++levels_;
}

TriangleMesh LevelSet::mesh() {
  find_cubes();
  report_progress(progress_, stage_, 0.2);
  find_signs();
  report_progress(progress_, stage_, 0.5);
  cut_cubes();
  TriangleMesh result = place_vertices();
  report_progress(progress_, stage_, 1);
  return result;
}

Point LevelSet::place(const Lattice& at) const { return origin_ + cell_ * Vector(at[0], at[1], at[2]); }

// Finds all of the smallest cubes that the surface may pass through. This works because the function is 1-Lipschitz.
void LevelSet::find_cubes() {
  cubes_ = {0};
  for (int level = levels_; level >= 0; --level) {
    const double half = 0.5 * cell_ * static_cast<double>(1u << level),
                 reach = (1 + kLipschitzSlack) * half * std::sqrt(3.0);
    std::vector<std::uint8_t> met(cubes_.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cubes_.size(), 64), [&](const auto& range) {
      for (std::size_t i = range.begin(); i != range.end(); ++i) {
        const Point middle = place(lattice_of(cubes_[i])) + Vector::Constant(half);
        met[i] = std::abs(value_(middle)) <= reach ? 1 : 0;
      }
    });
    std::vector<std::uint64_t> next;
    for (std::size_t i = 0; i < cubes_.size(); ++i) {
      if (!met[i]) continue;
      if (level == 0) {
        next.push_back(cubes_[i]);
        continue;
      }
      const Lattice cube = lattice_of(cubes_[i]);
      const std::uint32_t step = 1u << (level - 1);
      for (unsigned bits = 0; bits < 8; ++bits) {
        const Lattice offset = corner_of({0, 0, 0}, bits);
        next.push_back(key_of({cube[0] + step * offset[0], cube[1] + step * offset[1], cube[2] + step * offset[2]}));
      }
    }
    cubes_ = std::move(next);
  }
  sort_unique_keys(cubes_);
}

void LevelSet::find_signs() {
  for (const std::uint64_t cube : cubes_) {
    for (unsigned bits = 0; bits < 8; ++bits) corners_.push_back(key_of(corner_of(lattice_of(cube), bits)));
  }
  sort_unique_keys(corners_);
  values_.resize(corners_.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, corners_.size(), 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) values_[i] = value_(place(lattice_of(corners_[i])));
  });
}
double LevelSet::value_at(std::uint64_t corner) const {
  return values_[static_cast<std::size_t>(std::lower_bound(corners_.begin(), corners_.end(), corner) -
                                          corners_.begin())];
}

// Divides each cube into Kuhn's six tetrahedra, one for each order of the axes on the way from the first corner of the
// cube to its last.
void LevelSet::cut_cubes() {
  std::array<int, 3> axes{0, 1, 2};
  std::array<std::array<unsigned, 4>, 6> tetrahedra{};
  std::array<bool, 6> mirrored{};
  for (std::size_t k = 0; k < 6; ++k) {
    const unsigned first = 1u << axes[0], second = first | 1u << axes[1];
    tetrahedra[k] = {0, first, second, 7};
    mirrored[k] = (axes[0] > axes[1]) ^ (axes[0] > axes[2]) ^ (axes[1] > axes[2]);
    std::next_permutation(axes.begin(), axes.end());
  }
  std::array<double, 8> values{};
  for (const std::uint64_t cube : cubes_) {
    const Lattice at = lattice_of(cube);
    for (unsigned bits = 0; bits < 8; ++bits) values[bits] = value_at(key_of(corner_of(at, bits)));
    for (std::size_t k = 0; k < 6; ++k) cut(at, tetrahedra[k], mirrored[k], values);
  }
}

void LevelSet::cut(const Lattice& cube, const std::array<unsigned, 4>& corners, bool mirrored,
                   const std::array<double, 8>& values) {
  std::array<std::size_t, 4> in{}, out{};
  std::size_t count_in = 0, count_out = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (values[corners[i]] < 0) {
      in[count_in++] = i;
    } else {
      out[count_out++] = i;
    }
  }
  if (count_in == 0 || count_out == 0) return;
  const auto between = [&](std::size_t i, std::size_t k) { return edge_of(cube, corners[i], corners[k]); };
  // Whether the order of the corners, with the inner ones first, is an even permutation of the order in the
  // tetrahedron.
  std::array<std::size_t, 4> order{};
  std::copy_n(in.begin(), count_in, order.begin());
  std::copy_n(out.begin(), count_out, order.begin() + static_cast<std::ptrdiff_t>(count_in));
  bool odd = mirrored;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = i + 1; k < 4; ++k) odd ^= order[i] > order[k];
  }
  const auto add = [&](std::uint64_t a, std::uint64_t b, std::uint64_t c) {
    if (odd) std::swap(b, c);
    triangles_.push_back({a, b, c});
  };
  if (count_in == 1) {
    add(between(in[0], out[0]), between(in[0], out[1]), between(in[0], out[2]));
  } else if (count_in == 3) {
    add(between(in[0], out[0]), between(in[1], out[0]), between(in[2], out[0]));
  } else {
    const std::uint64_t a = between(in[0], out[0]), b = between(in[0], out[1]), c = between(in[1], out[1]),
                        d = between(in[1], out[0]);
    add(a, b, c);
    add(a, c, d);
  }
}

TriangleMesh LevelSet::place_vertices() const {
  TriangleMesh result;
  std::vector<std::uint64_t> edges;
  edges.reserve(3 * triangles_.size());
  for (const auto& triangle : triangles_) edges.insert(edges.end(), triangle.begin(), triangle.end());
  sort_unique_keys(edges);
  result.vertices.resize(edges.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, edges.size(), 64), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) result.vertices[i] = vertex_on(edges[i]);
  });
  const auto number = [&](std::uint64_t edge) {
    return static_cast<Index>(std::lower_bound(edges.begin(), edges.end(), edge) - edges.begin());
  };
  for (const auto& [a, b, c] : triangles_) result.triangles.push_back({number(a), number(b), number(c)});
  return result;
}

// Finds the place where the surface crosses an edge by the Illinois method.
Point LevelSet::vertex_on(std::uint64_t edge) const {
  const Lattice from = lattice_of(edge);
  const unsigned bits = static_cast<unsigned>(edge & 7);
  const std::uint64_t start = edge & ~std::uint64_t{7}, end = key_of(corner_of(from, bits));
  const Point a = place(from), b = place(lattice_of(end));
  double low = 0, high = 1, at_low = value_at(start), at_high = value_at(end), share = 0.5;
  int side = 0;
  for (int step = 0; step < kIllinoisSteps; ++step) {
    share = at_high != at_low ? low - at_low * (high - low) / (at_high - at_low) : 0.5 * (low + high);
    share = std::clamp(share, kFromEdgeEnd, 1 - kFromEdgeEnd);
    const double value = value_(a + share * (b - a));
    if (std::abs(value) <= kOnSurface * cell_) break;
    if ((value < 0) == (at_low < 0)) {
      low = share;
      at_low = value;
      if (side == -1) at_high /= 2;
      side = -1;
    } else {
      high = share;
      at_high = value;
      if (side == 1) at_low /= 2;
      side = 1;
    }
  }
  return a + share * (b - a);
}

// Whether a place of the lattice is inside. Cubes that the surface cannot pass through have no values here, but their
// neighbours do.
bool LevelSet::inside(const Lattice& at) const {
  const std::uint64_t key = key_of(at);
  const auto found = std::lower_bound(corners_.begin(), corners_.end(), key);
  return found != corners_.end() && *found == key && values_[static_cast<std::size_t>(found - corners_.begin())] < 0;
}

bool LevelSet::lost_at(const Point& point) const {
  const Vector at = (point - origin_) / cell_;  // at least 1.5
  const Lattice cube{static_cast<std::uint32_t>(at.x()), static_cast<std::uint32_t>(at.y()),
                     static_cast<std::uint32_t>(at.z())};
  if (!std::binary_search(cubes_.begin(), cubes_.end(), key_of(cube))) return false;
  for (std::uint32_t i = 0; i < 64; ++i)
    if (inside({cube[0] + i % 4 - 1, cube[1] + i / 4 % 4 - 1, cube[2] + i / 16 - 1})) return false;
  return true;
}

}  // namespace orchard::detail
