#include "label_layout.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace orchard::detail {
namespace {

using Eigen::Vector2d;
using WordBox = Eigen::AlignedBox2d;

WordBox box_of(const PlacedWord& word, double margin) {
  const Vector2d half = 0.5 * word.size + Vector2d::Constant(margin);
  return {word.middle - half, word.middle + half};
}

double overlap(const WordBox& a, const WordBox& b) {
  const WordBox common = a.intersection(b);
  return common.isEmpty() ? 0 : common.volume();
}

// Whether the segment from a to b meets the box.
bool meets(const Vector2d& a, const Vector2d& b, const WordBox& box) {
  double begin = 0, end = 1;
  for (int k = 0; k < 2; ++k) {
    const double d = b[k] - a[k], low = box.min()[k] - a[k], high = box.max()[k] - a[k];
    if (d == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    begin = std::max(begin, std::min(low / d, high / d));
    end = std::min(end, std::max(low / d, high / d));
  }
  return begin <= end;
}

// Returns a cost for the position of a word, which is 0 if it covers nothing.
double cost_of(const PlacedWord& word, const std::vector<PlacedWord>& words, std::size_t placed, const WordBox& room) {
  const double margin = 0.15 * word.size.y(), area = word.size.prod();
  const WordBox own = box_of(word, margin);
  double cost = own.volume() - overlap(own, room);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (own.contains(words[i].anchor)) cost += 0.5 * area;
    if (i >= placed) continue;
    const WordBox other = box_of(words[i], margin);
    cost += 4 * overlap(own, other);
    if (meets(word.anchor, word.middle, other)) cost += area;
    if (meets(words[i].anchor, words[i].middle, own)) cost += area;
  }
  return cost;
}

}  // namespace

void place_words(std::vector<PlacedWord>& words, const Vector2d& low, const Vector2d& high, const Vector2d& center) {
  const WordBox room(low, high);
  constexpr int kRings = 14, kTurns = 24;
  for (std::size_t i = 0; i < words.size(); ++i) {
    PlacedWord& word = words[i];
    const Vector2d outward = word.anchor - center;
    const double start = outward.norm() > 0 ? std::atan2(outward.y(), outward.x()) : 0;
    double best = -1;
    Vector2d chosen = word.anchor;
    for (int ring = 0; ring < kRings && best != 0; ++ring) {
      const double away = 0.5 * word.size.norm() + (0.9 + 0.8 * ring) * word.size.y();
      for (int turn = 0; turn < kTurns && best != 0; ++turn) {
        // 0, 1, -1, 2, -2 ..
        const int step = turn % 2 == 0 ? -turn / 2 : (turn + 1) / 2;
        const double angle = start + 2 * std::numbers::pi * step / kTurns;
        word.middle = word.anchor + away * Vector2d(std::cos(angle), std::sin(angle));
        const double cost = cost_of(word, words, i, room);
        if (best < 0 || cost < best) {
          best = cost;
          chosen = word.middle;
        }
      }
    }
    word.middle = chosen;
  }
}

}  // namespace orchard::detail
