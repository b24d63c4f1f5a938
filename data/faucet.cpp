#include <cstddef>
#include <vector>

#include "models.h"
#include "parts.h"

namespace orchard::models {

namespace {

constexpr double kPlateTop = 0.5;
constexpr double kHandleOffset = 3.3;
constexpr int kSpoutSides = 12;
constexpr double kBodyRadius = 0.95;
constexpr double kSpoutRadius = 0.5;

// Towards +x is where the water goes; z runs from handle to handle.
Frame plate_frame() { return frame_along({}, kAxisY, kAxisZ); }

// A bend of the spout in the plane z = 0. The hinge lies in the plane of the loop, so all walls
// are planar. A positive angle bends forwards and down.
struct Bend {
  double radius = 1.0;
  double angle = 0.0;
  int steps = 1;
};

void grow_bend(SolidBuilder& solid, Loop& loop, Frame& frame, const Section& section, const Bend& bend) {
  const Vec3 towards_hinge = cross(frame.normal(), kAxisZ);
  const Vec3 pivot = frame.origin + towards_hinge * bend.radius;
  const Frame start = frame;
  for (int i = 1; i <= bend.steps; ++i) {
    frame = start.turned(pivot, -kAxisZ, bend.angle * i / bend.steps);
    loop = solid.grow(loop, frame, section);
  }
}

void add_spout(SolidBuilder& solid, Loop loop, Frame frame) {
  const Section body = regular_polygon(kSpoutSides, 1.0);
  loop = grow_rings(solid, loop, frame, body, {{0.2, 0.9}, {0.45, 0.68}, {1.5, kSpoutRadius}});
  frame = frame.ahead(1.5);

  grow_bend(solid, loop, frame, scaled(body, kSpoutRadius), {1.5, radians(80.0), 5});
  constexpr double kReach = 1.6;
  constexpr double kThin = 0.42;
  frame = frame.ahead(kReach);
  loop = solid.grow(loop, frame, scaled(body, kThin));
  grow_bend(solid, loop, frame, scaled(body, kThin), {0.75, radians(100.0), 4});

  // The outlet: a wider ring around a recess.
  const Loop floor =
      grow_rings(solid, loop, frame, body, {{0.3, kThin}, {0.35, 0.49}, {0.65, 0.49}, {0.65, 0.36}, {0.4, 0.32}});
  solid.add_face(floor);
}

void add_spoke(SolidBuilder& solid, const Loop& root, const Frame& frame, const Section& round) {
  const Loop end = grow_rings(solid, root, frame, round, {{0.62, 0.8}, {0.8, 1.5}, {1.0, 1.2}});
  solid.add_face(end);
}

// A cross handle: the spokes leave gaps to the plate and to each other.
void add_handle(SolidBuilder& solid, const Loop& foot, const Frame& frame, const Section& round) {
  const Loop hub_bottom = grow_rings(solid, foot, frame, round, {{0.25, 0.95}, {0.7, 0.55}, {1.1, 0.42}, {1.1, 0.62}});
  const Frame hub = frame.ahead(1.75);
  const Loop hub_top = solid.add_loop(hub, scaled(round, 0.62));
  const Loop dome = grow_rings(solid, hub_top, hub, round, {{0.2, 0.4}});
  solid.add_face(dome);

  const Section spoke = regular_polygon(6, 0.13);
  Openings openings;
  for (std::size_t side = 0; side < round.size(); side += round.size() / 4) {
    const Frame wall = solid.wall_frame(hub_bottom, hub_top, side);
    const Loop root = solid.add_loop(wall, spoke);
    openings[side] = {root};
    add_spoke(solid, root, wall, spoke);
  }
  solid.add_walls(hub_bottom, hub_top, openings);
}

// The rod that works the drain, with a knob to pull.
void add_lift_rod(SolidBuilder& solid, const Loop& root, const Frame& frame, const Section& round, double radius) {
  const Loop neck = grow_rings(solid, root, frame, round, {{1.3, 1.0}});
  grow_ball(solid, neck, frame.ahead(1.3), round, radius, 0.2, 4);
}

}  // namespace

TriangleMesh make_faucet() {
  SolidBuilder solid;
  const Frame ground = plate_frame();
  constexpr int kSteps = 6;
  constexpr int kPieces = 4;
  const Section outline = stadium(3.6, 1.4, kSteps, kPieces);
  const Loop bottom = solid.add_loop(ground, outline);
  solid.add_face(reversed(bottom));
  const Loop edge = solid.grow(bottom, ground.ahead(0.35), outline);
  const Frame top = ground.ahead(kPlateTop);
  const Loop plate = solid.grow(edge, top, stadium(3.6, 1.25, kSteps, kPieces));

  const Loop body_root = solid.add_loop(top, regular_polygon(kSpoutSides, kBodyRadius));

  const Section round = regular_polygon(12, 1.0);
  const Frame left = top.moved(kAxisZ * -kHandleOffset);
  const Frame right = top.moved(kAxisZ * kHandleOffset);
  const Loop left_root = solid.add_loop(left, round);
  const Loop right_root = solid.add_loop(right, round);

  constexpr double kRodRadius = 0.08;
  const Section thin = regular_polygon(6, kRodRadius);
  const Frame rod = top.moved(kAxisX * -1.09);
  const Loop rod_root = solid.add_loop(rod, thin);

  solid.add_face(plate, {body_root, left_root, right_root, rod_root});
  add_spout(solid, body_root, top);
  add_handle(solid, left_root, left, round);
  add_handle(solid, right_root, right, round);
  add_lift_rod(solid, rod_root, rod, thin, kRodRadius);
  return solid.triangulated();
}

}  // namespace orchard::models
