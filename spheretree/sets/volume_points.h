#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/surface.h"
#include "weight_field.h"

namespace orchard::detail {

// Points spread evenly through the box around a solid, and how many balls hold each: what a search of balls that fill a
// volume asks after every step. A point inside the solid is worth 1 once a ball holds it, one outside costs a weight.
class VolumePoints {
 public:
  // About `inside` points in the solid, and as many around it as its box has, enlarged by `margin` of its longest side.
  // `weights`: what a point counts more.
  VolumePoints(const Surface& surface, std::size_t inside, double margin, const WeightField& weights = {});

  std::size_t inside_count() const { return inside_count_; }
  const Box& box() const { return box_; }
  // What a held point outside costs, all alike; until then 1.
  void set_outside_weight(double weight);

  void add(const Sphere& ball) { count(ball, 1); }
  void remove(const Sphere& ball) { count(ball, -1); }

  // What the worth of all held points changes by: with one ball more, one less, or one in another's place.
  double gain_of(const Sphere& ball) const { return worth_in(ball, 0); }
  double loss_of(const Sphere& ball) const { return worth_in(ball, 1); }
  double gain_of_change(const Sphere& from, const Sphere& to) const;

  // How many points in the solid no ball holds, and how many outside are held.
  std::size_t inside_open() const { return inside_count_ - inside_held_; }
  std::size_t outside_held() const { return outside_held_; }

 private:
  bool is_in(const Sphere& ball, Index point) const;
  double worth_in(const Sphere& ball, std::uint16_t holders) const;
  void count(const Sphere& ball, int change);
  void sort_into_cells(const std::vector<Point>& points, const std::vector<char>& inside);
  template <class Visit>
  void for_each_near(const Box& box, const Visit& visit) const;

  Box box_;
  double cell_ = 1;  // mesh units
  std::array<int, 3> cells_{1, 1, 1};
  std::vector<Index> begin_;  // of each cell's points, and one more
  std::vector<double> x_, y_, z_;
  std::vector<char> inside_;
  std::vector<double> weights_, worth_;
  std::vector<std::uint16_t> held_;
  std::size_t inside_count_ = 0, inside_held_ = 0, outside_held_ = 0;
};

}  // namespace orchard::detail
