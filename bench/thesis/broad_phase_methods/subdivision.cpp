#include <algorithm>
#include <cmath>

#include "intersections.h"

namespace orchard::broad_phase_methods::detail {
namespace {

constexpr int kDeepest = 10;      // levels: where many faces touch in a point, dividing does not help
constexpr int kHybridLevels = 2;  // "a few iterations of subdivision" (8.2)

struct Interval {
  double begin, end;

  bool empty() const noexcept { return !(begin <= end); }
  // Where constant + slope t >= 0.
  void clip(double constant, double slope) noexcept {
    if (slope > 0) {
      begin = std::max(begin, -constant / slope);
    } else if (slope < 0) {
      end = std::min(end, constant / -slope);
    } else if (constant < 0) {
      end = -kNoContact;
    }
  }
};

Interval common(const Interval& a, const Interval& b) noexcept {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

}  // namespace

struct Subdivision::Cell {
  Vec3 lower, upper;
  double begin, end;
  int level;
  std::vector<std::uint32_t> faces;
};

void Subdivision::run(Search& search, std::uint32_t base_case, bool hybrid) {
  for (std::size_t axis = 0; axis < 3; ++axis) run_axis(search, axis, std::max(base_case, 2u), hybrid);
}

void Subdivision::run_axis(Search& search, std::size_t axis, std::uint32_t base_case, bool hybrid) {
  const auto n = static_cast<std::uint32_t>(search.bounds.size());
  std::vector<Face> faces;
  Cell root{{}, {}, 0, search.limit(), 0, {}};
  root.lower.fill(kNoContact);
  root.upper.fill(-kNoContact);
  for (std::uint32_t i = 0; i < n; ++i) {
    const SpaceTimeBound& bound = search.bounds[i];
    for (const bool upper : {false, true}) {
      root.faces.push_back(static_cast<std::uint32_t>(faces.size()));
      faces.push_back(face_of(bound, i, axis, upper, BoundShape::hypertrapezoid));
    }
    for (const double t : {0.0, root.end}) {
      for (std::size_t d = 0; d < 3; ++d) {
        const double center = bound.center[d] + t * bound.velocity[d], half = bound.trapezoid_half(t);
        root.lower[d] = std::min(root.lower[d], center - half);
        root.upper[d] = std::max(root.upper[d], center + half);
      }
    }
  }
  std::vector<Cell> queue;  // a heap, the earliest cell first
  const auto later = [](const Cell& a, const Cell& b) { return a.begin > b.begin; };
  queue.push_back(std::move(root));
  std::vector<Cell> parts;
  while (!queue.empty() && queue.front().begin <= search.limit()) {
    std::pop_heap(queue.begin(), queue.end(), later);
    const Cell cell = std::move(queue.back());
    queue.pop_back();
    if (cell.faces.size() <= base_case || cell.level >= (hybrid ? kHybridLevels : kDeepest)) {
      ++search.counts.base_cells;
      search.counts.faces_in_cells += cell.faces.size();
      if (hybrid) {
        some_.clear();
        for (const std::uint32_t f : cell.faces) some_.push_back(faces[f]);
        sweep_.run(search, axis, some_, cell.begin, cell.end);
      } else {
        compare(search, axis, cell, faces);
      }
      continue;
    }
    parts.clear();
    divide(search, axis, cell, faces, parts);
    for (Cell& part : parts) {
      queue.push_back(std::move(part));
      std::push_heap(queue.begin(), queue.end(), later);
    }
  }
}

// The base case: all pairs of an upper and a lower face, by their projections.
void Subdivision::compare(Search& search, std::size_t axis, const Cell& cell, std::span<const Face> faces) {
  for (const std::uint32_t i : cell.faces) {
    const Face& a = faces[i];
    if (!a.upper) continue;
    for (const std::uint32_t j : cell.faces) {
      const Face& b = faces[j];
      const double gap = b.constant - a.constant, closing = a.slope - b.slope;
      if (b.upper || a.body == b.body || gap < 0 || !(closing > 0)) continue;
      // The cell's own times: a crossing outside them is another cell's.
      const double t = gap / closing, slack = kMotionSlack * search.duration;
      if (t < cell.begin - slack || t > std::min(cell.end + slack, search.limit())) continue;
      search.faces_meet(a.body, b.body, axis, t);
    }
  }
}

// Per face and dimension, the times at which its cross section touches the lower and the upper half of the cell; they
// decide which of the 16 parts hold a piece of it. All parts are closed.
void Subdivision::divide(const Search& search, std::size_t axis, const Cell& cell, std::span<const Face> faces,
                         std::vector<Cell>& parts) {
  const Vec3 middle = 0.5 * (cell.lower + cell.upper);
  const double middle_time = 0.5 * (cell.begin + cell.end);
  for (unsigned part = 0; part < 16; ++part) {
    Cell& child = parts.emplace_back(Cell{cell.lower, cell.upper, cell.begin, cell.end, cell.level + 1, {}});
    for (unsigned d = 0; d < 3; ++d) (part >> d & 1 ? child.lower : child.upper)[d] = middle[d];
    (part >> 3 ? child.begin : child.end) = middle_time;
  }
  const double slack = kMotionSlack * (std::fabs(cell.upper[axis]) + std::fabs(cell.lower[axis]));
  for (const std::uint32_t f : cell.faces) {
    const Face& face = faces[f];
    const SpaceTimeBound& bound = search.bounds[face.body];
    std::array<std::array<Interval, 2>, 3> halves;
    for (std::size_t d = 0; d < 3; ++d) {
      const double size = d == axis ? 0 : bound.size, slope = d == axis ? 0 : bound.slope;
      const double center = d == axis ? face.constant : bound.center[d];
      const double speed = d == axis ? face.slope : bound.velocity[d];
      const double edges[3] = {cell.lower[d], middle[d], cell.upper[d]};
      for (std::size_t h = 0; h < 2; ++h) {
        Interval& times = halves[d][h] = {cell.begin, cell.end};
        times.clip(center + size - edges[h] + slack, speed + slope);        // reaches above the lower edge
        times.clip(edges[h + 1] - (center - size) + slack, slope - speed);  // and below the upper one
      }
    }
    for (unsigned part = 0; part < 16; ++part) {
      Interval times = common(common(halves[0][part & 1], halves[1][part >> 1 & 1]), halves[2][part >> 2 & 1]);
      times = common(times, {parts[part].begin, parts[part].end});
      if (!times.empty()) parts[part].faces.push_back(f);
    }
  }
  std::erase_if(parts, [](const Cell& part) { return part.faces.size() < 2; });
}

}  // namespace orchard::broad_phase_methods::detail
