#include "line_chains.h"

#include <algorithm>
#include <map>

namespace orchard::detail {
namespace {

using Eigen::Vector2d;

constexpr double kStraight = 0.1;  // in points of the picture: smaller deviations cannot be seen on a page

// Limits begin and end to the part of a + t d that is in the rectangle. If begin >= end, there is none.
void clip_to(const Eigen::AlignedBox2d& sides, const Vector2d& a, const Vector2d& d, double& begin, double& end) {
  for (int k = 0; k < 2; ++k) {
    const double low = sides.min()[k] - a[k], high = sides.max()[k] - a[k];
    if (d[k] == 0) {
      if (low > 0 || high < 0) end = begin - 1;
      continue;
    }
    begin = std::max(begin, std::min(low / d[k], high / d[k]));
    end = std::min(end, std::max(low / d[k], high / d[k]));
  }
}

double distance_to(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d d = b - a;
  const double square = d.squaredNorm();
  const double t = square > 0 ? std::clamp((p - a).dot(d) / square, 0.0, 1.0) : 0;
  return (p - a - t * d).norm();
}

// Simplifies a line by the algorithm of Douglas and Peucker, without recursion.
std::vector<Vector2d> simplified(const std::vector<Vector2d>& line) {
  std::vector<bool> kept(line.size(), false);
  kept.front() = kept.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> parts{{0, line.size() - 1}};
  while (!parts.empty()) {
    const auto [first, last] = parts.back();
    parts.pop_back();
    double max = kStraight;
    std::size_t at = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double distance = distance_to(line[i], line[first], line[last]);
      if (distance > max) max = distance, at = i;
    }
    if (at == first) continue;
    kept[at] = true;
    parts.emplace_back(first, at);
    parts.emplace_back(at, last);
  }
  std::vector<Vector2d> result;
  for (std::size_t i = 0; i < line.size(); ++i)
    if (kept[i]) result.push_back(line[i]);
  return result;
}

double length_of(const std::vector<Vector2d>& line) {
  double length = 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

}  // namespace

void LineChains::add(std::pair<int, int> ends, const Vector2d& a, const Vector2d& b, double begin, double end) {
  const bool dot = ends.first == ends.second;
  if (dot && !sides_.contains(a)) return;
  if (!dot) clip_to(sides_, a, b - a, begin, end);
  if (begin >= end) return;
  Piece piece{{begin > 0 ? -1 : ends.first, end < 1 ? -1 : ends.second}, {a + begin * (b - a), a + end * (b - a)}};
  pieces_.push_back(piece);
}

std::vector<std::vector<double>> LineChains::joined() const {
  std::map<int, std::vector<std::size_t>> at;  // the pieces that end at each place
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    for (const int end : pieces_[i].ends)
      if (end >= 0) at[end].push_back(i);
  const auto next_of = [&](std::size_t piece, int end) -> std::size_t {
    if (end < 0) return piece;
    const auto& here = at.at(end);
    if (here.size() != 2) return piece;
    return here[0] == piece ? here[1] : here[0];
  };
  std::vector<bool> done(pieces_.size(), false);
  // Follows the line from a piece through its end `side` as far as possible.
  const auto follow = [&](std::size_t piece, int side, std::vector<Vector2d>& line) {
    for (;;) {
      line.push_back(pieces_[piece].places[side]);
      const int end = pieces_[piece].ends[side];
      const std::size_t next = next_of(piece, end);
      if (next == piece || done[next]) return;
      done[next] = true;
      side = pieces_[next].ends[0] == end ? 1 : 0;
      piece = next;
    }
  };
  std::vector<std::vector<double>> result;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (done[i]) continue;
    done[i] = true;
    std::vector<Vector2d> back, line;
    follow(i, 0, back);
    line.assign(back.rbegin(), back.rend());
    if (pieces_[i].ends[0] < 0 || pieces_[i].ends[0] != pieces_[i].ends[1]) {
      follow(i, 1, line);
      line = simplified(line);
      if (length_of(line) < kStraight) continue;
    }
    std::vector<double>& places = result.emplace_back();
    for (const Vector2d& place : line) places.insert(places.end(), {place.x(), place.y()});
  }
  return result;
}

}  // namespace orchard::detail
