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

// A hit of a ray: it enters the body's sphere at origin + along * direction. `along` is 0 if the ray begins inside.
struct BodyHit {
  BodyIndex body = kNoIndex;
  double along = 0;
};

// A body near a point.
struct NearBody {
  BodyIndex body = kNoIndex;
  double distance = 0;  // The distance of the point from the body's sphere, 0 inside.
};

// Queries about the places of bodies. The source gives the places when it is asked for time(); positions and radii are
// these and not bounds, and spheres are closed, in double. The queries see the present bodies, including those that
// were added or teleported since the last report. A body with an invalid motion is not found. The boxes of the broad
// phase select the candidates; they are correct if the motions keep their bounds and cancel() is called otherwise, as
// for pairs.
//
// Cost, for the default algorithm: what lies in the cells that the query meets, and a motion for each body whose box it
// meets. In addition, one motion for each body that was added or cancelled since the last step, waits for a budget, or
// is as large as several cells. At the step before many bounds expire together, that may be half of the bodies. A query
// that meets more cells than there are bodies, or a world of up to 192 bodies, costs a box for each body; a ray in this
// case, and every query of another algorithm, costs a motion for each body.
//
// A refused query has no answer, and refused() is true. Refused are numbers that are not finite or above kMaxNumber (a
// ray may be infinitely long), a direction of 0, a negative radius or length, a box whose lower corner is above its
// upper one, and all queries to a broad phase that is not valid() or from one of its callbacks.
//
// Spans and their order are valid until the next query of the object. It keeps its memory and allocates nothing once
// warm. Any number of objects may query the same broad phase, one at a time, and not while it advances. Throws
// std::bad_alloc and what the source throws; then nothing has changed.
class BodyQueries {
 public:
  // `world` outlives this object and stays in its place.
  explicit BodyQueries(BroadPhase& world) noexcept : world_(&world) {}

  // Returns the time of the last step that is not after the time up to which everything has been reported; before the
  // first step, the time of that step.
  double time() const noexcept;
  bool refused() const noexcept { return refused_; }  // Whether the last query was refused.

  // Returns the body whose sphere the ray enters first; of several, the one with the lowest index.
  std::optional<BodyHit> first_hit(const Ray& ray, const QueryFilter& filter = {});
  // Returns all bodies that the ray enters, ordered by `along`, then by body.
  std::span<const BodyHit> all_hits(const Ray& ray, const QueryFilter& filter = {});
  // Does the same for the points from p to q, both included; `along` is 1 at q. The two may be the same point.
  std::optional<BodyHit> first_on_segment(const Vec3& p, const Vec3& q, const QueryFilter& filter = {});
  std::span<const BodyHit> all_on_segment(const Vec3& p, const Vec3& q, const QueryFilter& filter = {});

  // Returns the bodies, in ascending order, whose spheres have a point in common with a solid sphere or an axis-aligned
  // box.
  std::span<const BodyIndex> touching_sphere(const Vec3& center, double radius, const QueryFilter& filter = {});
  std::span<const BodyIndex> touching_box(const Vec3& lower, const Vec3& upper, const QueryFilter& filter = {});

  // Returns the k bodies whose spheres are nearest to the point, ordered by distance, then by body; all bodies if there
  // are no more.
  std::span<const NearBody> nearest(const Vec3& point, std::size_t k, const QueryFilter& filter = {});

  std::size_t memory_bytes() const noexcept;  // On the heap.

 private:
  struct Line;  // from a point in a direction of length 1
  struct FirstHit;
  struct AllHits;
  std::int64_t step() const noexcept;
  bool begin(bool valid);
  std::span<const BodyIndex> new_ones(std::span<const BodyIndex> bodies, const QueryFilter& filter);
  template <typename Use>
  void use_motions(std::span<const BodyIndex> bodies, const QueryFilter& filter, const Use& use);
  template <typename Touches>
  std::span<const BodyIndex> touching(const Vec3& lower, const Vec3& upper, const QueryFilter& filter,
                                      const Touches& touches);
  template <typename Hits>
  void walk(const Line& line, Hits& hits);
  std::optional<BodyHit> first_along(const Line& line, const QueryFilter& filter);
  std::span<const BodyHit> all_along(const Line& line, const QueryFilter& filter);
  std::span<const BodyIndex> all_bodies();

  BroadPhase* world_;
  bool refused_ = false;
  std::vector<std::uint32_t> seen_;  // by body: the last query that it was looked at in
  std::uint32_t query_ = 0;
  std::vector<BodyIndex> candidates_, asked_, found_;
  std::vector<Motion> motions_;
  std::vector<BodyHit> hits_;
  std::vector<NearBody> near_;
};

}  // namespace orchard::runtime
