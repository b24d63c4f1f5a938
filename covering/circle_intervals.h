#pragma once
#include <span>
#include <vector>

namespace orchard::detail {

inline constexpr double kTwoPi = 6.283185307179586;

// A part of a circle in radians: none of it, all of it, or the arc from `begin` counter-clockwise to `end`, where
// begin lies in [0, 2 pi) and end in (begin, begin + 2 pi).
struct Arc {
  enum class Kind { none, some, all } kind = Kind::none;
  double begin = 0, end = 0;

  static Arc none() { return {}; }
  static Arc all() { return {Kind::all, 0, kTwoPi}; }
  static Arc around(double middle, double half_angle);
};

// Sorted disjoint closed intervals inside [0, 2 pi]: the one-dimensional arithmetic that the boundary lemma turns
// covering problems into (dissertation 5.3.3).
class CircleIntervals {
 public:
  struct Interval {
    double begin, end;
  };
  void clear() { intervals_.clear(); }
  void assign(double begin, double end) { intervals_.assign(1, {begin, end}); }  // of another parameter than an angle
  void set_all() { intervals_.assign(1, {0, kTwoPi}); }
  bool empty() const { return intervals_.empty(); }
  std::span<const Interval> intervals() const { return intervals_; }

  void subtract(const Arc& arc);
  bool subtract(double begin, double end) { return subtract_interval(begin, end); }
  bool subtract(const CircleIntervals& other);  // returns whether anything was removed
  void assign_intersection(const CircleIntervals& other, const Arc& arc);

 private:
  bool subtract_interval(double begin, double end);
  void append_clipped(const CircleIntervals& other, double begin, double end);
  std::vector<Interval> intervals_;
};

}  // namespace orchard::detail
