// Box modelling of closed solids: rings of points, walls between rings, flat faces with openings.
//
// A part starts as a loop drawn on a flat face (the opening), grows by walls from loop to loop and
// ends with a face or a point. Since a part and its face share the opening's points, the result is
// closed and has no overlaps to cut away.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <vector>

#include "section.h"
#include "vec3.h"

namespace orchard::models {

/// Point indices of a flat polygon, counter-clockwise about the direction in which the part grows.
using Loop = std::vector<std::size_t>;

[[nodiscard]] Loop reversed(const Loop& loop);

/// Loops cut out of the walls between two loops, by wall number.
using Openings = std::map<std::size_t, std::vector<Loop>>;

struct TriangleMesh {
  std::vector<Vec3> points;
  std::vector<std::array<std::size_t, 3>> triangles;
};

/// Digits after the decimal point of every coordinate of a finished model.
inline constexpr int kDecimals = 8;

class SolidBuilder {
 public:
  /// Adds the section's points only; walls and faces come later.
  Loop add_loop(const Frame& frame, const Section& section);

  /// Adds the images of `loop`, moved along `direction` until they lie in the plane of `target`.
  Loop add_projected_loop(const Loop& loop, Vec3 direction, const Frame& target);

  /// A flat polygon, counter-clockwise seen from outside, with openings of either direction.
  void add_face(const Loop& outer, const std::vector<Loop>& openings = {});

  /// One quadrilateral per side. `from` and `to` have equally many points.
  void add_walls(const Loop& from, const Loop& to, const Openings& openings = {});

  /// Triangles from every side of the loop to one new point.
  void add_tip(const Loop& from, Vec3 tip);

  /// add_loop() and add_walls() in one.
  Loop grow(const Loop& from, const Frame& frame, const Section& section);

  /// Frame in the middle of wall `side` between two loops: its x axis runs along the side, its
  /// y axis towards `to`, its normal outwards.
  [[nodiscard]] Frame wall_frame(const Loop& from, const Loop& to, std::size_t side) const;

  /// Triangulates every face. Throws std::logic_error when a face is not flat.
  [[nodiscard]] TriangleMesh triangulated() const;

 private:
  struct Face {
    std::vector<Loop> rings;  // the outer one first
  };

  std::vector<Vec3> points_;
  std::vector<Face> faces_;
};

}  // namespace orchard::models
