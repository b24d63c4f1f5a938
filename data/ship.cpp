#include <cmath>
#include <cstddef>
#include <vector>

#include "models.h"
#include "parts.h"

namespace orchard::models {

namespace {

// The nose points to +z. Sides of the hull section, as numbered by its corners.
constexpr std::size_t kRight = 0;
constexpr std::size_t kUpperRight = 2;
constexpr std::size_t kTop = 3;
constexpr std::size_t kUpperLeft = 4;
constexpr std::size_t kLeft = 6;
constexpr std::size_t kBottom = 9;

// Wide flat sides where something is attached, narrow ones between them.
Section hull_section() {
  return {{0.40, -0.12}, {0.40, 0.12},   {0.33, 0.26},   {0.20, 0.35},   {-0.20, 0.35}, {-0.33, 0.26},
          {-0.40, 0.12}, {-0.40, -0.12}, {-0.32, -0.24}, {-0.18, -0.32}, {0.18, -0.32}, {0.32, -0.24}};
}

// A thin plate with sharp edges; the chord runs along y.
Section blade(double chord, double thickness) {
  const double c = 0.5 * chord;
  const double t = 0.5 * thickness;
  return {{0.0, -c}, {t, -0.7 * c}, {t, 0.6 * c}, {0.0, c}, {-t, 0.6 * c}, {-t, -0.7 * c}};
}

Frame at_station(double z) { return {{0.0, 0.0, z}, kAxisX, kAxisY}; }

// The part of the hull between two of its loops, with what is attached to it.
struct Segment {
  Loop back;
  Loop front;
  Openings openings;

  [[nodiscard]] Frame wall(const SolidBuilder& solid, std::size_t side, double shift) const {
    const Frame frame = solid.wall_frame(back, front, side);
    return frame.moved(kAxisZ * shift);
  }
};

// A tapering blade in two pieces whose walls lie in common planes.
Loop grow_blade(SolidBuilder& solid, const Loop& root, const Frame& frame, const Section& profile, Vec3 span,
                double taper) {
  const Loop middle = solid.grow(root, frame.moved(span * 0.5), scaled(profile, 0.5 * (1.0 + taper)));
  return solid.grow(middle, frame.moved(span), scaled(profile, taper));
}

// Wings droop and end in fins that bend further down.
void add_wing(SolidBuilder& solid, Segment& hull, std::size_t side, double right) {
  const Frame root = hull.wall(solid, side, 0.0);
  const Section profile = blade(0.8, 0.07);
  Loop loop = solid.add_loop(root, profile);
  hull.openings[side].push_back(loop);

  constexpr double kTaper = 0.64;
  const Vec3 span{right * 0.76, -0.48, -0.25};
  const Section tip = scaled(profile, kTaper);
  loop = grow_blade(solid, loop, root, profile, span, kTaper);
  Frame frame = root.moved(span);

  constexpr double kBendRadius = 0.14;
  const Frame start = frame;
  for (const double degrees : {35.0, 70.0}) {
    frame = start.turned(start.origin - kAxisY * kBendRadius, -kAxisZ * right, radians(degrees));
    loop = solid.grow(loop, frame, tip);
  }
  frame = frame.ahead(0.72).moved(kAxisZ * -0.22);
  loop = solid.grow(loop, frame, scaled(tip, 0.6));
  solid.add_face(loop);
}

void add_tail_fin(SolidBuilder& solid, Segment& hull) {
  const Frame root = hull.wall(solid, kTop, -0.05);
  const Section profile = blade(0.7, 0.07);
  const Loop foot = solid.add_loop(root, profile);
  hull.openings[kTop].push_back(foot);
  const Loop end = grow_blade(solid, foot, root, profile, {0.0, 0.85, -0.45}, 0.5);
  solid.add_face(end);
}

// Engine nacelle on a strut that leaves the hull at a right angle.
void add_nacelle(SolidBuilder& solid, Segment& hull, std::size_t side) {
  constexpr double kRadius = 0.22;
  constexpr double kStrut = 0.95;
  constexpr double kSweep = -0.25;
  constexpr int kSides = 12;
  const Frame root = hull.wall(solid, side, 0.0);
  const Vec3 out = root.normal();
  const Vec3 axis = root.origin + out * (kStrut + kRadius);
  const Section round = regular_polygon(kSides, kRadius / std::cos(kPi / kSides), std::atan2(-out.y, -out.x));

  const Frame frame{{axis.x, axis.y, 0.0}, kAxisX, kAxisY};
  const Loop floor = solid.add_loop(frame.ahead(-1.25), scaled(round, 0.5));
  solid.add_face(reversed(floor));
  const Loop back = grow_rings(solid, floor, frame, round, {{-1.5, 0.68}, {-1.5, 0.8}, {-1.2, 1.0}});
  const Loop front = solid.add_loop(frame.ahead(-0.4), round);

  const Loop foot = solid.add_loop(root, blade(0.55, 0.06));
  const Loop arrival =
      solid.add_projected_loop(foot, out + kAxisZ * (kSweep / kStrut), solid.wall_frame(back, front, 0));
  solid.add_walls(foot, arrival);
  hull.openings[side].push_back(foot);
  solid.add_walls(back, front, {{0, {arrival}}});

  const Loop nose = grow_rings(solid, front, frame, round, {{-0.3, 1.2}, {-0.1, 1.2}, {0.1, 0.85}, {0.2, 0.45}});
  solid.add_tip(nose, frame.ahead(0.25).origin);
}

void add_dome(SolidBuilder& solid, Segment& hull, std::size_t side, double radius) {
  const Frame frame = hull.wall(solid, side, 0.0);
  const Section round = regular_polygon(12, radius);
  const Loop foot = solid.add_loop(frame, round);
  hull.openings[side].push_back(foot);
  grow_ball(solid, foot, frame, round, radius, 1.03 * radius, 4);
}

void add_pod(SolidBuilder& solid, Segment& hull, std::size_t side) {
  constexpr double kStem = 0.06;
  const Frame frame = hull.wall(solid, side, 0.0);
  const Section round = regular_polygon(8, kStem);
  const Loop foot = solid.add_loop(frame, round);
  hull.openings[side].push_back(foot);
  const Loop neck = grow_rings(solid, foot, frame, round, {{0.2, 1.0}});
  grow_ball(solid, neck, frame.ahead(0.2), round, kStem, 0.2, 6);
}

void add_nose(SolidBuilder& solid, const Loop& from, const Section& hull) {
  const Loop cap = grow_rings(solid, from, at_station(0.0), hull, {{1.3, 0.8}, {1.55, 0.52}, {1.7, 0.2}});
  const Section thin = regular_polygon(6, 0.03);
  const Frame frame = at_station(1.7);
  const Loop foot = solid.add_loop(frame, thin);
  solid.add_face(cap, {foot});
  solid.add_face(grow_rings(solid, foot, frame, thin, {{0.3, 0.7}}));
}

}  // namespace

TriangleMesh make_ship() {
  SolidBuilder solid;
  const Section section = hull_section();
  const Loop floor = solid.add_loop(at_station(-1.15), scaled(section, 0.5));
  solid.add_face(reversed(floor));
  const Loop tail = grow_rings(solid, floor, at_station(0.0), section,
                               {{-1.4, 0.66}, {-1.4, 0.76}, {-1.1, 0.76}, {-1.1, 0.9}, {-0.95, 1.0}});
  const Loop waist = solid.add_loop(at_station(-0.05), section);
  const Loop chest = solid.add_loop(at_station(0.5), section);
  const Loop neck = solid.add_loop(at_station(1.0), section);

  Segment rear{tail, waist, {}};
  add_wing(solid, rear, kRight, 1.0);
  add_wing(solid, rear, kLeft, -1.0);
  add_nacelle(solid, rear, kUpperRight);
  add_nacelle(solid, rear, kUpperLeft);
  add_tail_fin(solid, rear);
  solid.add_walls(rear.back, rear.front, rear.openings);
  solid.add_walls(waist, chest);

  Segment fore{chest, neck, {}};
  add_dome(solid, fore, kTop, 0.17);
  add_dome(solid, fore, kBottom, 0.14);
  add_pod(solid, fore, kRight);
  add_pod(solid, fore, kLeft);
  solid.add_walls(fore.back, fore.front, fore.openings);
  add_nose(solid, neck, section);
  return solid.triangulated();
}

}  // namespace orchard::models
