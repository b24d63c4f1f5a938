#include "linear_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace orchard::broad_phase_methods {
namespace {

using Row = std::array<double, 5>;  // coefficients of x, y, z, t and what they may come to at most

std::vector<Row> constraints(const SpaceTimeBound& a, const SpaceTimeBound& b, double duration) {
  std::vector<Row> rows = {{0, 0, 0, -1, 0}, {0, 0, 0, 1, duration}};
  for (const SpaceTimeBound* s : {&a, &b}) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (const double side : {1.0, -1.0}) {
        Row row{};
        row[i] = side;
        row[3] = -(side * s->velocity[i] + s->slope);
        row[4] = side * s->center[i] + s->size;
        rows.push_back(row);
      }
    }
    if (s->has_plane()) {
      rows.push_back({s->normal[0], s->normal[1], s->normal[2], -(dot(s->normal, s->velocity) + s->cut_growth),
                      dot(s->normal, s->center) + s->cut});
    }
  }
  return rows;
}

// Gauss with pivoting; false if nearly singular.
bool solve(std::array<Row, 4> m, std::array<double, 4>& x) {
  for (std::size_t c = 0; c < 4; ++c) {
    std::size_t best = c;
    for (std::size_t r = c + 1; r < 4; ++r) best = std::fabs(m[r][c]) > std::fabs(m[best][c]) ? r : best;
    if (std::fabs(m[best][c]) < 1e-9) return false;
    std::swap(m[c], m[best]);
    for (std::size_t r = 0; r < 4; ++r) {
      if (r == c) continue;
      const double f = m[r][c] / m[c][c];
      for (std::size_t k = c; k < 5; ++k) m[r][k] -= f * m[c][k];
    }
  }
  for (std::size_t c = 0; c < 4; ++c) x[c] = m[c][4] / m[c][c];
  return true;
}

}  // namespace

double min_time(const SpaceTimeBound& a, const SpaceTimeBound& b, double duration) {
  const std::vector<Row> rows = constraints(a, b, duration);
  double least = kNoContact;
  const std::size_t n = rows.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      for (std::size_t k = j + 1; k < n; ++k) {
        for (std::size_t l = k + 1; l < n; ++l) {
          std::array<double, 4> x{};
          if (!solve({rows[i], rows[j], rows[k], rows[l]}, x) || x[3] >= least) continue;
          bool feasible = true;
          for (const Row& row : rows) {
            feasible = feasible && row[0] * x[0] + row[1] * x[1] + row[2] * x[2] + row[3] * x[3] <= row[4] + 1e-9;
          }
          if (feasible) least = std::max(0.0, x[3]);
        }
      }
    }
  }
  return least;
}

}  // namespace orchard::broad_phase_methods
