#pragma once
#include <optional>

#include "orchard/runtime/broad_phase.h"
#include "orchard/runtime/pose.h"

// Queries about the bounding spheres of a broad phase's bodies: rays, segments, contacts with a sphere or a box, and
// nearest bodies.
namespace orchard::runtime {

// Which bodies a query includes, in Box2D's terms: those whose category has a bit of `mask`, and whose mask has a bit
// of `category`. The default includes all bodies except those whose category or mask is 0. Groups and PairFilter do not
// apply.
struct QueryFilter {
  std::uint32_t category = 0xffffffffu;
  std::uint32_t mask = 0xffffffffu;
};

// The place where a ray enters a body's sphere: origin + along * direction. `along` is 0 if the ray begins inside.
struct BodyHit {
  BodyIndex body = kNoIndex;
  double along = 0;
};

// A body near a point.
struct NearBody {
  BodyIndex body = kNoIndex;
  double distance = 0;  // The distance of the point from the body's sphere, 0 inside.
};

// Answers queries about the bounding spheres of the bodies at time(). The source is asked for the motions at this time.
// Only their positions and radii count, not their bounds. Spheres are closed, and the tests are in double precision.
// The queries see the present bodies, including those that were added or teleported since the last report. A body with
// an invalid motion is not found. The boxes of the broad phase select the bodies that are asked for, so a body may be
// missed if its motion does not keep its bounds and cancel() was not called.
//
// Cost, for the default algorithm:
// - A query reads the cells that it meets, and asks for the motion of each body whose box it meets.
// - It also asks for each body that was added or cancelled since the last step, that waits for a budget, or that is as
//   large as several cells. At the step before many bounds expire together, that may be half of the bodies.
// - A query that meets more cells than there are bodies tests the box of each body instead of the cells.
// With another algorithm, every query asks for the motion of each body.
//
// A query is refused if a number is not finite or above kMaxNumber (a ray may be infinitely long), if the direction is
// 0, if a radius or length is negative, if a lower corner of a box is above the upper one, if the broad phase is not
// valid(), or if one of its callbacks makes the query. A refused query has no answer, and refused() is true.
//
// A returned span is valid until the next query of the same object. The object reuses its memory, so it soon allocates
// nothing. Any number of objects may query the same broad phase, one at a time, and not while it advances. Throws
// std::bad_alloc and what the source throws; then nothing has changed.
class BodyQueries {
 public:
  // `world` outlives this object and stays in its place.
  explicit BodyQueries(BroadPhase& world) noexcept : world_(&world) {}

  // Returns the time to which the answers refer. Everything has been reported up to some time; this is the last step
  // that is not after it. Before the first step, it is the time of the first step.
  double time() const noexcept;
  bool refused() const noexcept { return refused_; }  // Whether the last query was refused.

  // Returns the body whose sphere the ray enters first; if it enters several at once, the one with the lowest index.
  std::optional<BodyHit> first_hit(const Ray& ray, const QueryFilter& filter = {});
  // Returns all bodies that the ray enters, ordered by `along`, then by body.
  std::span<const BodyHit> all_hits(const Ray& ray, const QueryFilter& filter = {});
  // Do the same for the segment from p to q, both ends included; `along` is 1 at q. The two may be the same point.
  std::optional<BodyHit> first_on_segment(const Vec3& p, const Vec3& q, const QueryFilter& filter = {});
  std::span<const BodyHit> all_on_segment(const Vec3& p, const Vec3& q, const QueryFilter& filter = {});

  // Return the bodies, in ascending order, whose spheres have a point in common with a solid sphere or with a solid
  // axis-aligned box.
  std::span<const BodyIndex> touching_sphere(const Vec3& center, double radius, const QueryFilter& filter = {});
  std::span<const BodyIndex> touching_box(const Vec3& lower, const Vec3& upper, const QueryFilter& filter = {});

  // Returns the k bodies whose spheres are nearest to the point, ordered by distance, then by body; all bodies if there
  // are no more.
  std::span<const NearBody> nearest(const Vec3& point, std::size_t k, const QueryFilter& filter = {});

  std::size_t memory_bytes() const noexcept;  // On the heap.

 private:
  struct Line;  // A ray or a segment with a direction of length 1.
  std::int64_t step() const noexcept;
  bool begin(bool valid);
  std::span<const BodyIndex> new_ones(std::span<const BodyIndex> bodies, const QueryFilter& filter);
  template <typename Use>
  void use_motions(std::span<const BodyIndex> bodies, const QueryFilter& filter, const Use& use);
  template <typename Touches>
  std::span<const BodyIndex> touching(const Vec3& lower, const Vec3& upper, const QueryFilter& filter,
                                      const Touches& touches);
  std::span<const BodyHit> along(const Line& line, const QueryFilter& filter, bool first);
  std::optional<BodyHit> first_along(const Line& line, const QueryFilter& filter);
  std::span<const BodyIndex> all_bodies();

  BroadPhase* world_;
  bool refused_ = false;
  std::vector<std::uint32_t> seen_;  // For each body, the number of the last query that tested it.
  std::uint32_t query_ = 0;
  std::vector<BodyIndex> candidates_, asked_, found_;
  std::vector<Motion> motions_;
  std::vector<BodyHit> hits_;
  std::vector<NearBody> near_;
};

}  // namespace orchard::runtime
