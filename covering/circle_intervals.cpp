#include "circle_intervals.h"

#include <algorithm>

namespace orchard::detail {

Arc Arc::around(double middle, double half_angle) {
  if (half_angle <= 0) return none();
  if (2 * half_angle >= kTwoPi) return all();
  double begin = middle - half_angle;
  if (begin < 0) begin += kTwoPi;
  if (begin >= kTwoPi) begin -= kTwoPi;
  return {Kind::some, begin, begin + 2 * half_angle};
}

void CircleIntervals::subtract(const Arc& arc) {
  if (arc.kind == Arc::Kind::none) return;
  if (arc.kind == Arc::Kind::all) return clear();
  subtract_interval(arc.begin, std::min(arc.end, kTwoPi));
  if (arc.end > kTwoPi) subtract_interval(0, arc.end - kTwoPi);
}

bool CircleIntervals::subtract(const CircleIntervals& other) {
  bool changed = false;
  for (const Interval& interval : other.intervals_) changed |= subtract_interval(interval.begin, interval.end);
  return changed;
}

// Intervals without length are dropped, because the lemma may ignore finitely many points.
bool CircleIntervals::subtract_interval(double begin, double end) {
  bool changed = false;
  for (std::size_t i = 0; i < intervals_.size();) {
    const Interval old = intervals_[i];
    if (old.end <= begin || old.begin >= end) {
      ++i;
      continue;
    }
    changed = true;
    const bool head = old.begin<begin, tail = old.end> end;
    if (head) intervals_[i].end = begin;
    if (head && tail) {
      intervals_.insert(intervals_.begin() + static_cast<std::ptrdiff_t>(i) + 1, {end, old.end});
      return true;
    }
    if (tail) intervals_[i].begin = end;
    if (head || tail) {
      ++i;
    } else {
      intervals_.erase(intervals_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  return changed;
}

void CircleIntervals::assign_intersection(const CircleIntervals& other, const Arc& arc) {
  clear();
  if (arc.kind == Arc::Kind::none) return;
  if (arc.kind == Arc::Kind::all) {
    intervals_ = other.intervals_;
    return;
  }
  if (arc.end > kTwoPi) append_clipped(other, 0, arc.end - kTwoPi);
  append_clipped(other, arc.begin, std::min(arc.end, kTwoPi));
}

void CircleIntervals::append_clipped(const CircleIntervals& other, double begin, double end) {
  for (const Interval& interval : other.intervals_) {
    const Interval clipped{std::max(interval.begin, begin), std::min(interval.end, end)};
    if (clipped.begin < clipped.end) intervals_.push_back(clipped);
  }
}

}  // namespace orchard::detail
