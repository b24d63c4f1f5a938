#pragma once
#include <optional>

#include "orchard/runtime/broad_phase.h"
#include "orchard/runtime/pose.h"

// Questions about the bounding spheres of a broad phase's bodies: rays, segments, what touches a sphere or a box, the
// nearest ones.
namespace orchard::runtime {

// Which bodies count, in Box2D's terms: those whose category has a bit of `mask`, and whose mask has one of `category`.
// All do, unless their category or mask is 0. Groups and PairFilter mean nothing here.
struct QueryFilter {
  std::uint32_t category = 0xffffffffu;
  std::uint32_t mask = 0xffffffffu;
};

// The ray enters the body's sphere at origin + along * direction; 0 if it begins inside.
struct BodyHit {
  BodyIndex body = kNoIndex;
  double along = 0;
};

struct NearBody {
  BodyIndex body = kNoIndex;
  double distance = 0;  // of the point from the body's sphere, 0 inside
};

// Where bodies are: as the source says, when it is asked for time(); positions and radii are these, not bounds, and
// spheres are closed, in double. Bodies are those there are now, what has been added or teleported since the last
// report included. One whose motion is not valid is not found. That a body is near is told by the broad phase's boxes,
// which hold if the motions keep their bounds, and cancel() is called where they do not, as for pairs.
//
// Cost, for the constructor's broad phase: of what lies in the cells that the query meets, and a motion for each body
// whose box it meets; besides, a motion for each body that was added or cancelled since the last step, waits for a
// budget, or is as large as several cells. At the step before many bounds expire together that may be half of the
// bodies. For a query that meets more cells than there are bodies, or up to 192 bodies: a box for each body; but for a
// ray among these, and for other methods, a motion for each.
//
// What is refused has no answer, and refused() is true: numbers that are not finite or above kMaxNumber (a ray may
// be infinitely long), a direction of 0, a negative radius or length, a box whose lower corner is above its upper one,
// anything asked of a broad phase that is not valid(), or from one of its callbacks.
//
// Spans and their order are valid until the object's next query. It keeps its memory: nothing is allocated once warm.
// Any number of objects may ask the same broad phase, one at a time, and not while it advances. Throws std::bad_alloc
// and what the source throws, and nothing has changed then.
class BodyQueries {
 public:
  explicit BodyQueries(BroadPhase& world) noexcept : world_(&world) {}  // it outlives this, and stays where it is

  // The last step's that is not after the time up to which everything has been reported; the first step's before that.
  double time() const noexcept;
  bool refused() const noexcept { return refused_; }  // the last query

  // The body whose sphere the ray enters first; of several the one of the smallest index.
  std::optional<BodyHit> first_hit(const Ray& ray, const QueryFilter& filter = {});
  // All that the ray enters, by `along`, then by body.
  std::span<const BodyHit> all_hits(const Ray& ray, const QueryFilter& filter = {});
  // The same for the points between p and q, both included; `along` is 1 at q. They may be the same point.
  std::optional<BodyHit> first_on_segment(const Vec3& p, const Vec3& q, const QueryFilter& filter = {});
  std::span<const BodyHit> all_on_segment(const Vec3& p, const Vec3& q, const QueryFilter& filter = {});

  // Bodies, in ascending order, whose spheres have a point in common with a solid sphere or an upright box.
  std::span<const BodyIndex> touching_sphere(const Vec3& center, double radius, const QueryFilter& filter = {});
  std::span<const BodyIndex> touching_box(const Vec3& lower, const Vec3& upper, const QueryFilter& filter = {});

  // The k bodies whose spheres are nearest to the point, by distance, then by body; all, if there are no more.
  std::span<const NearBody> nearest(const Vec3& point, std::size_t k, const QueryFilter& filter = {});

  std::size_t memory_bytes() const noexcept;  // held on the heap

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
