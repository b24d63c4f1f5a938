#pragma once
#include <atomic>

#include "broad_phase/body_pool.h"
#include "detector/shapes.h"

namespace orchard::runtime::detail {

inline bool is_half_space(BodyIndex index) noexcept { return index >= kFirstHalfSpace && index != kNoIndex; }

inline constexpr Step kNotAsked = -2;  // not a step; -1 would be the one before step 0

// A sphere in the world around a part or a body.
struct BoundingSphere {
  Vec3 center{};
  double reach = kInfinity;  // the radius; infinite while the position is not known
  double size = kInfinity;   // an upper bound on the distance of its points from the world's origin

  BoundingSphere() = default;
  BoundingSphere(const Vec3& middle, double radius) noexcept
      : center(middle),
        reach(radius),
        size(std::fabs(middle[0]) + std::fabs(middle[1]) + std::fabs(middle[2]) + radius) {}
};

// A part of a body: its shape and its place in the body's frame. The members that are read when the body gets a new
// pose come first.
struct PartRecord {
  Vec3 center{};          // the centre of a sphere around the part, in the body's frame
  double reach = 0;       // the radius of that sphere
  BoundingSphere sphere;  // that sphere in the world, at the last known pose of the body
  double off = 0;         // the distance of `center` from the body's origin
  Pose local{};
  bool at_origin = true;  // `local` is the identity
  ShapeId shape = kNoShape;
};

// Where a part was in its body's frame before it was moved there.
struct PartBefore {
  PartRecord place;
  Step until = kNotAsked;  // the last step at which it was there
};

// A body of the world. Its members are ordered by cache lines: a new pose of a body with one part, as most have, needs
// only the first five lines.
struct alignas(64) Body {
  BodyId id = kNoBody;  // kNoBody while no body has this index
  bool is_static = false;
  bool asleep = false;    // the application has called sleep()
  bool frozen = false;    // asleep, and its state is known; the source is not asked for it until the body wakes
  bool valid = true;      // `state` is valid
  bool by_parts = false;  // its pairs with static bodies are found by PartPairs
  struct Steps {
    Step moved = -1;                // the last step at which the pose, a part or the validity was new
    Step asked = kNotAsked;         // the step of `state`
    Step known_before = kNotAsked;  // the step of `before`
  };
  Steps steps;
  std::vector<PartRecord> several;  // all parts, if there is more than one

  BodyState state;               // the last known one
  PartRecord one;                // the only part, if `several` is empty
  BodyOptions options;           // as the application has set them
  struct Changes {               // counters; pairs compare them with the values that they saw last
    std::uint32_t filters = 0;   // changes of the filter
    std::uint32_t jumps = 0;     // teleports
    std::uint32_t deformed = 0;  // changes of the trees of its shapes
  };
  Changes changes;
  struct Extent {      // of the parts, at scale 1
    double reach = 0;  // the radius around the body's origin that the broad phase relies on
    // The centre and the radius of a smaller sphere around the parts, in the body's frame. The radius is infinite if
    // this sphere is not used: it would be hardly smaller than the one around the origin, or parts have moved, or an
    // option needs the origin.
    Vec3 middle{};
    double middle_reach = kInfinity;
    double off_middle = 0;  // the distance of `middle` from the origin
  };
  Extent extent;
  struct Told {              // what the broad phase relies on, if bodies are watched
    double radius = -1;      // below 0: it relies on nothing
    bool by_middle = false;  // its motion is that of the middle
  };
  Told told;
  Step since = 0;                        // the first step that it takes part in
  Step stretched = kNotAsked;            // the last step before parts reached farther out than ever before
  Pose before;                           // the pose at the step known_before, kept once there are continuous bodies
  std::vector<PartBefore> parts_before;  // by part; empty until a part moves while there are continuous bodies

  std::span<PartRecord> parts() noexcept { return several.empty() ? std::span(&one, 1) : std::span(several); }
  std::span<const PartRecord> parts() const noexcept {
    return several.empty() ? std::span(&one, 1) : std::span(several);
  }
  bool is_continuous() const noexcept { return options.continuous_speed > 0; }
  // Returns whether the source is asked for its state.
  bool is_asked() const noexcept { return !is_static && !frozen && id != kNoBody; }
  bool has_middle() const noexcept { return extent.middle_reach < extent.reach; }
  void find_middle() noexcept;  // sets `extent` to use the middle, if the sphere around it is much smaller
  void forget_middle() noexcept { extent.middle_reach = kInfinity; }
  // Returns the motion bound for the broad phase, of the middle or else of the origin. It is invalid (its radius is
  // negative) if the state is.
  Motion motion(double time_step, bool by_middle) const noexcept;
  Motion motion(double time_step) const noexcept { return motion(time_step, relies_on_middle(time_step)); }
  // Returns whether the broad phase gets the motion of the middle. It does if the body turns slowly: in eight steps,
  // the middle moves about the origin by no more than what the smaller radius saves.
  bool relies_on_middle(double time_step) const noexcept {
    constexpr double kSteps = 8;
    return has_middle() &&
           kSteps * time_step * state.angular_speed * extent.off_middle <= extent.reach - extent.middle_reach;
  }
  BoundingSphere sphere() const noexcept;  // around all parts
};

// Returns whether the filters of two bodies allow them to be a pair. Half-spaces are static, too.
inline bool filters_allow(const Body& a, const Body& b) noexcept {
  const auto at_rest = [](const Body& body) { return body.is_static || is_half_space(body.id); };
  const BodyFilter &of_a = a.options.filter, &of_b = b.options.filter;
  if ((of_a.ignores_static && at_rest(b)) || (of_b.ignores_static && at_rest(a))) return false;
  return may_pair(of_a, of_b);
}

// A bound on the rounding error of a gap between two spheres, in units of BoundingSphereCache::slack.
inline constexpr double kRoundingOfGaps = 1e3;

// All that is needed to decide whether a body may have come closer to another one, and nothing else: it is read for
// each pair of a step, and fills one cache line. The points of the body have moved as the centre of the sphere has,
// except for their motion about it, which `turned` bounds.
struct alignas(64) BoundingSphereCache {
  // The sphere of the only part. Its radius is infinite if the body has several parts, is continuous or is not valid.
  // The centre of several parts is the body's origin.
  BoundingSphere sphere;
  // A bound on the rounding error of the centre, and a thousandth of that of a gap between spheres.
  double slack = 0;
  double turned = 0;             // a bound on how far any point has moved about the centre, summed over all steps
  std::uint32_t changes = 0;     // the number of calls of invalidate()
  std::uint32_t generation = 0;  // of the body that has the index
};
static_assert(sizeof(BoundingSphereCache) == 64);

// Returns whether the pose is rigid and the numbers are in the ranges that BodyState and Motion allow.
bool is_valid(const BodyState& state) noexcept;
// Returns the radius of a sphere around the body's origin that contains the parts.
double reach_of(std::span<const PartRecord> parts) noexcept;
double reach_of(const PartRecord& part) noexcept;
// Places a part in the frame of its body. Returns false if `local` is not rigid, or so large that the sphere of the
// part is not finite.
bool set_local(PartRecord& part, const Shape& shape, const Pose& local) noexcept;

// The bodies of a world, except half-spaces, and their spheres. Their indices are those of the broad phase.
class BodyTable {
 public:
  Body& add(BodyId id, std::size_t parts);  // with room for `parts` parts, which the caller sets
  void leave(BodyIndex body) noexcept { bodies_[body].id = kNoBody; }
  bool contains(BodyId id) const noexcept {
    return id.index < bodies_.size() && bodies_[id.index].id == id && id != kNoBody;
  }
  // Returns whether both indices still belong to the bodies whose generations had the sum `generations`.
  bool are_there(const BodyPair& pair, std::uint32_t generations) const noexcept {
    return bodies_[pair.a].id != kNoBody && bodies_[pair.b].id != kNoBody &&
           generations == sphere_caches_[pair.a].generation + sphere_caches_[pair.b].generation;
  }
  Body& operator[](BodyIndex body) noexcept { return bodies_[body]; }
  const Body& operator[](BodyIndex body) const noexcept { return bodies_[body]; }
  std::size_t slots() const noexcept { return bodies_.size(); }
  const BoundingSphereCache& sphere_cache(BodyIndex body) const noexcept { return sphere_caches_[body]; }
  ORCHARD_INLINE void prefetch_pose(BodyIndex index) const noexcept {  // and what a new pose changes
    const Body& body = bodies_[index];
    prefetch_all(body.steps), prefetch_all(body.state), prefetch_all(body.one.sphere);
    prefetch(&sphere_caches_[index]);
  }
  ORCHARD_INLINE void prefetch_sphere_cache(BodyIndex body) const noexcept {  // does nothing for a half-space
    if (body < sphere_caches_.size()) prefetch(&sphere_caches_[body]);
  }

  // Updates the spheres of a body. Call it after every change of the pose or the validity.
  void moved(BodyIndex body, const Pose& before) noexcept;
  // Moves a part in the frame of its body, and updates the spheres.
  void move_part(BodyIndex body, std::size_t part, const PartRecord& to, const Shape& shape) noexcept;
  // Notes that nothing that is remembered of the body's pairs holds any more.
  void invalidate(BodyIndex body) noexcept;
  // Returns whether a body of the pair has been invalidated since forget_invalidated().
  bool invalidated(const BodyPair& pair) const noexcept {
    return any_invalidated_.load(std::memory_order_relaxed) &&
           (invalidated_[pair.a] != 0 || (!is_half_space(pair.b) && invalidated_[pair.b] != 0));
  }
  void forget_invalidated() noexcept;
  std::size_t memory_bytes() const noexcept;

 private:
  void add_turn(BodyIndex body, double way) noexcept;

  std::vector<Body> bodies_;
  std::vector<BoundingSphereCache> sphere_caches_;
  std::vector<std::uint8_t> invalidated_;
  std::atomic<bool> any_invalidated_ = false;  // set by jobs
};

}  // namespace orchard::runtime::detail
