#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "orchard/geometry/surface.h"
#include "weight_field.h"

namespace orchard::detail {

// Points spread evenly through the box around a solid, and how many balls hold each. A search of balls that fill the
// solid's volume uses them after every step. A point inside the solid adds 1 (or its own weight) once a ball holds it;
// a point outside costs a weight.
class VolumePoints {
 public:
  // Spreads points evenly through the box of the solid, so densely that about `inside` of them are in the solid. The
  // box is enlarged by `margin` times its longest side. `weights` has the weight of each place.
  VolumePoints(const Surface& surface, std::size_t inside, double margin, const WeightField& weights = {});

  std::size_t inside_count() const { return inside_count_; }
  const Box& box() const { return box_; }
  // Sets what each held point outside costs; 1 if it is not called.
  void set_outside_weight(double weight);

  void add(const Sphere& ball) { count(ball, 1); }
  void remove(const Sphere& ball) { count(ball, -1); }

  // Return by how much the worth of all held points changes if a ball is added, removed or replaced by another.
  double gain_of(const Sphere& ball) const { return worth_in(ball, 0); }
  double loss_of(const Sphere& ball) const { return worth_in(ball, 1); }
  double gain_of_change(const Sphere& from, const Sphere& to) const;

  // The number of points in the solid that no ball holds, and of points outside that a ball holds.
  std::size_t inside_open() const { return inside_count_ - inside_held_; }
  std::size_t outside_held() const { return outside_held_; }

 private:
  bool is_in(const Sphere& ball, Index point) const;
  double worth_in(const Sphere& ball, std::uint16_t holders) const;
  void count(const Sphere& ball, int change);
  void sort_into_cells(const std::vector<Point>& points, const std::vector<char>& inside);
  template <class Visit>
  void for_each_near(const Box& box, const Visit& visit) const;

  std::size_t cell_at(int x, int y, int z) const {
    const auto size = [&](std::size_t axis) { return static_cast<std::size_t>(cells_[axis]); };
    return (static_cast<std::size_t>(z) * size(1) + static_cast<std::size_t>(y)) * size(0) +
           static_cast<std::size_t>(x);
  }

  Box box_;
  double cell_ = 1;  // mesh units
  std::array<int, 3> cells_{1, 1, 1};
  std::vector<Index> begin_;  // by cell: its first point; the number of points follows at the end
  std::vector<double> x_, y_, z_;
  std::vector<char> inside_;
  std::vector<double> weights_, worth_;
  std::vector<std::uint16_t> held_;
  std::size_t inside_count_ = 0, inside_held_ = 0, outside_held_ = 0;
};

}  // namespace orchard::detail
