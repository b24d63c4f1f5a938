#include <cmath>
#include <cstddef>
#include <vector>

#include "models.h"
#include "parts.h"

namespace orchard::models {

namespace {

constexpr double kBaseHeight = 0.24;
constexpr double kCollarHeight = 0.12;
constexpr double kKnuckleRadius = 0.2;
constexpr double kKnuckleHalfWidth = 0.2;
constexpr double kArmLength = 1.7;
constexpr int kRodSides = 4;
constexpr double kRodRadius = 0.05;
constexpr double kRodOffset = 0.11;

// Directions in the plane of the arm, in degrees from the x axis.
constexpr double kLowerArm = 115.0;
constexpr double kUpperArm = 22.0;
constexpr double kShade = -62.0;

Vec3 in_arm_plane(double degrees) { return {std::cos(radians(degrees)), std::sin(radians(degrees)), 0.0}; }

// A short cylinder across the arm. Its flat sides carry the rods and stems that meet in it.
struct Knuckle {
  Loop back;
  Loop front;
  Openings openings;
};

Knuckle start_knuckle(SolidBuilder& solid, Vec3 centre, const std::vector<double>& sides) {
  const Section section = tangent_polygon(sides, kKnuckleRadius);
  const Frame middle{centre, kAxisX, kAxisY};
  return {solid.add_loop(middle.ahead(-kKnuckleHalfWidth), section),
          solid.add_loop(middle.ahead(kKnuckleHalfWidth), section),
          {}};
}

void finish_knuckle(SolidBuilder& solid, const Knuckle& knuckle) {
  solid.add_walls(knuckle.back, knuckle.front, knuckle.openings);
  solid.add_face(knuckle.front);
  solid.add_face(reversed(knuckle.back));
}

// Twin rods leave a gap between them, so every arm is a closed ring.
void add_rods(SolidBuilder& solid, Knuckle& from, std::size_t from_side, Knuckle& to, std::size_t to_side) {
  const Frame start = solid.wall_frame(from.back, from.front, from_side);
  const Frame end = solid.wall_frame(to.back, to.front, to_side);
  for (const double offset : {-kRodOffset, kRodOffset}) {
    const Section rod = shifted(regular_polygon(kRodSides, kRodRadius), {0.0, offset});
    const Loop lower = solid.add_loop(start, rod);
    const Loop upper = solid.add_projected_loop(lower, start.normal(), end);
    solid.add_walls(lower, upper);
    from.openings[from_side].push_back(lower);
    to.openings[to_side].push_back(upper);
  }
}

void add_base(SolidBuilder& solid, Knuckle& knuckle, std::size_t side) {
  const Frame floor = frame_along({}, kAxisY, kAxisX);
  const Section disc = regular_polygon(18, 0.95);
  const Loop bottom = solid.add_loop(floor, disc);
  solid.add_face(reversed(bottom));
  const Loop top = grow_rings(solid, bottom, floor, disc, {{0.16, 1.0}, {kBaseHeight, 0.86}});

  const Section round = regular_polygon(8, 0.22);
  const Frame desk = floor.ahead(kBaseHeight);
  const Loop collar = solid.add_loop(desk, round);
  const Section key = shifted(regular_polygon(6, 0.09), {0.55, 0.0});
  const Loop button = solid.add_loop(desk, key);
  solid.add_face(top, {collar, button});
  solid.add_face(grow_rings(solid, button, desk, key, {{0.06, 1.0}}));

  const Loop collar_top = grow_rings(solid, collar, desk, round, {{kCollarHeight, 0.7}});
  const Loop stem = solid.add_loop(desk.ahead(kCollarHeight), regular_polygon(6, 0.07));
  solid.add_face(collar_top, {stem});
  const Loop arrival = solid.add_projected_loop(stem, kAxisY, solid.wall_frame(knuckle.back, knuckle.front, side));
  solid.add_walls(stem, arrival);
  knuckle.openings[side].push_back(arrival);
}

void add_bulb(SolidBuilder& solid, const Loop& ceiling, const Frame& frame) {
  const Section round = regular_polygon(8, 0.1);
  const Loop socket = solid.add_loop(frame, round);
  solid.add_face(ceiling, {socket});
  const Loop neck = grow_rings(solid, socket, frame, round, {{0.16, 1.0}});
  grow_ball(solid, neck, frame.ahead(0.16), round, 0.1, 0.2, 4);
}

void add_shade(SolidBuilder& solid, Knuckle& knuckle, std::size_t side) {
  constexpr double kStem = 0.1;
  constexpr double kSocketEnd = 0.42;
  constexpr double kRim = 1.25;
  const Frame frame = solid.wall_frame(knuckle.back, knuckle.front, side);
  const Section thin = regular_polygon(6, 0.07);
  const Loop stem = solid.add_loop(frame, thin);
  knuckle.openings[side].push_back(stem);
  const Loop stem_end = grow_rings(solid, stem, frame, thin, {{kStem, 1.0}});

  const Section round = regular_polygon(16, 1.0);
  const Loop back = solid.add_loop(frame.ahead(kStem), scaled(round, 0.22));
  solid.add_face(reversed(back), {stem_end});
  const Loop ceiling =
      grow_rings(solid, back, frame, round,
                 {{kStem + 0.06, 0.26}, {kSocketEnd, 0.26}, {kRim, 0.78}, {kRim, 0.74}, {kSocketEnd + 0.02, 0.225}});
  add_bulb(solid, ceiling, frame.ahead(kSocketEnd + 0.02));
}

}  // namespace

TriangleMesh make_lamp() {
  SolidBuilder solid;
  const Vec3 foot{0.0, kBaseHeight + kCollarHeight + 0.1 + kKnuckleRadius, 0.0};
  const Vec3 elbow = foot + in_arm_plane(kLowerArm) * kArmLength;
  const Vec3 head = elbow + in_arm_plane(kUpperArm) * kArmLength;

  // The sides that carry something face its direction and have equal neighbours.
  Knuckle low = start_knuckle(solid, foot, {-90, -42, 12, 67, kLowerArm, 163, 222});
  Knuckle middle = start_knuckle(solid, elbow, {-108.5, kLowerArm - 180, -21.5, kUpperArm, 65.5, 112, 158, 205});
  Knuckle high = start_knuckle(solid, head, {-110, kShade, -14, 28, 70, 112, 154, kUpperArm + 180});

  add_base(solid, low, 0);
  add_rods(solid, low, 4, middle, 1);
  add_rods(solid, middle, 3, high, 7);
  add_shade(solid, high, 1);
  finish_knuckle(solid, low);
  finish_knuckle(solid, middle);
  finish_knuckle(solid, high);
  return solid.triangulated();
}

}  // namespace orchard::models
