#include "shell_piece.h"

#include <algorithm>
#include <utility>

namespace orchard::detail {
namespace {

constexpr double kDepthRounding = 1e-12;  // of a depth: the two halves of a range of depths overlap by this

}  // namespace

MeanNormal mean_normal(std::span<const NormalColumn> columns) {
  Vector sum = Vector::Zero();
  for (const NormalColumn& column : columns) sum += column.inward;
  const double length = sum.norm();
  if (!(length > 0)) return {sum, 0};
  MeanNormal axis{sum / length, 1};
  for (const NormalColumn& column : columns) axis.cosine = std::min(axis.cosine, axis.direction.dot(column.inward));
  return axis;
}

bool cut_at(std::span<NormalColumn> columns, const Point& other) {
  for (NormalColumn& column : columns) {
    const Vector way = other - column.foot;
    const double along = 2 * column.inward.dot(way);
    if (!(along > 0)) return false;
    column.top = way.squaredNorm() / along;
  }
  return true;
}

std::vector<Vector> hull_of(std::span<const NormalColumn> columns, const Vector& direction) {
  const Vector side = direction.unitOrthogonal(), other = direction.cross(side);
  struct Place {
    double x, y;
    Vector normal;
  };
  std::vector<Place> places;
  for (const auto& [foot, normal, top] : columns) {
    const double along = normal.dot(direction);
    places.push_back({normal.dot(side) / along, normal.dot(other) / along, normal});
  }
  std::sort(places.begin(), places.end(),
            [](const Place& a, const Place& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  const auto turns_left = [](const Place& a, const Place& b, const Place& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0;
  };
  std::vector<Vector> hull;
  for (int half = 0; half < 2; ++half) {  // the lower side, then the upper one
    std::vector<Place> chain;
    for (const Place& place : places) {
      while (chain.size() > 1 && !turns_left(chain[chain.size() - 2], chain.back(), place)) chain.pop_back();
      chain.push_back(place);
    }
    for (std::size_t k = 0; k + 1 < chain.size(); ++k) hull.push_back(chain[k].normal);
    std::reverse(places.begin(), places.end());
  }
  return hull;
}

std::size_t corners_of(const ShellPiece& piece, Point* corners) {
  std::size_t count = 0;
  const auto columns = piece.in_use();
  for (const NormalColumn& column : columns) {
    if (column.top >= piece.from && column.top <= piece.to) corners[count++] = column.foot + column.top * column.inward;
  }
  for (const double level : {piece.from, piece.to}) {
    const bool all =
        std::all_of(columns.begin(), columns.end(), [&](const NormalColumn& column) { return column.top >= level; });
    for (const NormalColumn& high : columns) {
      if (!(high.top > level)) continue;
      const Point top = high.foot + high.top * high.inward;
      const auto add_way_to = [&](const Point& low, double depth) {
        const double share = (level - depth) / (high.top - depth);
        corners[count++] = low + share * (top - low);
      };
      add_way_to(high.foot, 0);
      if (all) continue;
      for (const NormalColumn& low : columns) {
        if (low.top < level) add_way_to(low.foot + low.top * low.inward, low.top);
        if (&low != &high && !piece.one_normal()) add_way_to(low.foot, 0);
      }
    }
  }
  return count;
}

double max_depth(const ShellPiece& piece) {
  double depth = 0;
  for (const NormalColumn& column : piece.in_use()) depth = std::max(depth, std::min(column.top, piece.to));
  return depth;
}

std::array<ShellPiece, 2> halves_of(const ShellPiece& piece) {
  std::array<ShellPiece, 2> halves{piece, piece};
  const auto& c = piece.columns;
  const double to = max_depth(piece);
  const auto size = [&](std::size_t a, std::size_t b) {
    return (c[a].foot - c[b].foot).norm() + to * (c[a].inward - c[b].inward).norm();
  };
  std::size_t longest = 0;
  double max = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const double length = piece.count == 4 && k == 1 ? 0 : size(k, (k + 1) % 3);
    if (length > max) max = length, longest = k;
  }
  if (to - piece.from > max) {
    halves[0].to = halves[1].from = 0.5 * (piece.from + to);
    halves[1].to = std::min(piece.to, to * (1 + kDepthRounding));
    return halves;
  }
  const auto split = [&](std::size_t a, std::size_t b) {
    const NormalColumn middle{0.5 * (c[a].foot + c[b].foot), 0.5 * (c[a].inward + c[b].inward)};
    halves[0].columns[b] = middle;
    halves[1].columns[a] = middle;
  };
  if (piece.count == 3) {
    split(longest, (longest + 1) % 3);
  } else if (longest == 0) {
    split(0, 1);
    split(2, 3);
  } else {
    split(0, 2);
    split(1, 3);
  }
  return halves;
}

}  // namespace orchard::detail
