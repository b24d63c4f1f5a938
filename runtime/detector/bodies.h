#pragma once
#include <atomic>

#include "broad_phase/body_pool.h"
#include "detector/shapes.h"

namespace orchard::runtime::detail {

inline bool is_half_space(BodyIndex index) noexcept { return index >= kFirstHalfSpace && index != kNoIndex; }

inline constexpr Step kNotAsked = -2;  // not the step before any step

// A sphere in the world around a part or a body.
struct BoundingSphere {
  Vec3 center{};
  double reach = kInfinity;  // its radius; infinite until it is known where it is
  double size = kInfinity;   // no point of it is farther from the world's origin

  BoundingSphere() = default;
  BoundingSphere(const Vec3& middle, double radius) noexcept
      : center(middle),
        reach(radius),
        size(std::fabs(middle[0]) + std::fabs(middle[1]) + std::fabs(middle[2]) + radius) {}
};

// A part, and where it is in its body's frame. What a new pose needs comes first.
struct PartRecord {
  Vec3 center{};          // of a sphere around it,
  double reach = 0;       // and its radius
  BoundingSphere sphere;  // at the pose of the body that is known
  double off = 0;         // of the center from the origin
  Pose local{};
  bool at_origin = true;  // `local` changes nothing
  ShapeId shape = kNoShape;
};

// Where it was up to a step, that one included.
struct PartBefore {
  PartRecord place;
  Step until = kNotAsked;
};

// By lines of memory: the first five are what a new pose needs of a body of one part, as most are.
struct alignas(64) Body {
  BodyId id = kNoBody;  // kNoBody: no body has this index now
  bool is_static = false;
  bool asleep = false;    // wanted by the application
  bool frozen = false;    // asleep, and its state is known: never asked again
  bool valid = true;      // the state that is known
  bool by_parts = false;  // its pairs with static bodies are found by PartPairs
  struct Steps {
    Step moved = -1;                // the last one at which the pose was another one than at the time asked before
    Step asked = kNotAsked;         // that `state` is of
    Step known_before = kNotAsked;  // that `before` is of
  };
  Steps steps;
  std::vector<PartRecord> several;  // all parts, if there is more than one

  BodyState state;      // as known last
  PartRecord one;       // the part, if there is one
  BodyOptions options;  // as the application wants them
  struct Changes {
    std::uint32_t filters = 0;   // of its filter
    std::uint32_t jumps = 0;     // teleports
    std::uint32_t deformed = 0;  // of its shapes' trees
  };
  Changes changes;
  struct Extent {      // at scale 1
    double reach = 0;  // around the origin: what the broad phase has been told of
    // A sphere around the parts, where they stay as they are and it is smaller than that around the origin; else its
    // radius is infinite.
    Vec3 middle{};
    double middle_reach = kInfinity;
    double off_middle = 0;  // from the origin to the middle
  };
  Extent extent;
  struct Told {          // what the broad phase relies on, if bodies are watched
    double radius = -1;  // below 0: nothing yet
    bool by_middle = false;
  };
  Told told;
  Step since = 0;                        // the first step that it takes part in
  Step stretched = kNotAsked;            // the one after which parts went farther out than ever before
  Pose before;                           // at the step asked before, once there are continuous bodies
  std::vector<PartBefore> parts_before;  // of each part; empty until one moves

  std::span<PartRecord> parts() noexcept { return several.empty() ? std::span(&one, 1) : std::span(several); }
  std::span<const PartRecord> parts() const noexcept {
    return several.empty() ? std::span(&one, 1) : std::span(several);
  }
  bool is_continuous() const noexcept { return options.continuous_speed > 0; }
  bool is_asked() const noexcept { return !is_static && !frozen && id != kNoBody; }  // for its states
  bool has_middle() const noexcept { return extent.middle_reach < extent.reach; }
  void find_middle() noexcept;
  void forget_middle() noexcept { extent.middle_reach = kInfinity; }
  // As the broad phase wants it. Not valid if the state is not.
  Motion motion(double time_step, bool by_middle) const noexcept;
  Motion motion(double time_step) const noexcept { return motion(time_step, relies_on_middle(time_step)); }
  // Whether that is the motion of the middle: it turns too slowly to get far from there in some steps.
  bool relies_on_middle(double time_step) const noexcept {
    constexpr double kSteps = 8;
    return has_middle() &&
           kSteps * time_step * state.angular_speed * extent.off_middle <= extent.reach - extent.middle_reach;
  }
  BoundingSphere sphere() const noexcept;  // around all parts
};

// Half-spaces are static, too.
inline bool filters_allow(const Body& a, const Body& b) noexcept {
  const auto at_rest = [](const Body& body) { return body.is_static || is_half_space(body.id); };
  const BodyFilter &of_a = a.options.filter, &of_b = b.options.filter;
  if ((of_a.ignores_static && at_rest(b)) || (of_b.ignores_static && at_rest(a))) return false;
  return may_pair(of_a, of_b);
}

// What a gap between spheres may be rounded by, in units of BoundingSphereCache::slack.
inline constexpr double kRoundingOfGaps = 1e3;

// What shows whether a body may have come closer to another one, and nothing else: it is read for each pair of a step,
// and fills one line of memory. Points of the body are where the sphere's centre is, but for what they have turned
// about it.
struct alignas(64) BoundingSphereCache {
  // Of its only part; of a body of several parts, or one that is continuous or not valid, the radius is infinite. The
  // centre of several parts is the body's origin.
  BoundingSphere sphere;
  // What the centre may be off by, and a thousandth of what the rounding of a gap between spheres may.
  double slack = 0;
  double turned = 0;             // how far any point has moved about the centre up to now, at most, from step to step
  std::uint32_t changes = 0;     // since what was known before says nothing of now
  std::uint32_t generation = 0;  // of the body that has the index
};
static_assert(sizeof(BoundingSphereCache) == 64);

// A pose that is rigid, and numbers that BodyState and Motion allow.
bool is_valid(const BodyState& state) noexcept;
// The radius of a sphere around the body's origin that has the parts in it.
double reach_of(std::span<const PartRecord> parts) noexcept;
double reach_of(const PartRecord& part) noexcept;
bool set_local(PartRecord& part, const Shape& shape, const Pose& local) noexcept;  // false: not rigid

// Which bodies there are, where they are, and what that means for pairs. Indices are the broad phase's.
class BodyTable {
 public:
  Body& add(BodyId id, std::size_t parts);  // with room for so many
  void leave(BodyIndex body) noexcept { bodies_[body].id = kNoBody; }
  bool contains(BodyId id) const noexcept {
    return id.index < bodies_.size() && bodies_[id.index].id == id && id != kNoBody;
  }
  // Both are the bodies that had these generations together, and none of them is gone.
  bool are_there(const BodyPair& pair, std::uint32_t generations) const noexcept {
    return bodies_[pair.a].id != kNoBody && bodies_[pair.b].id != kNoBody &&
           generations == sphere_caches_[pair.a].generation + sphere_caches_[pair.b].generation;
  }
  Body& operator[](BodyIndex body) noexcept { return bodies_[body]; }
  const Body& operator[](BodyIndex body) const noexcept { return bodies_[body]; }
  std::size_t slots() const noexcept { return bodies_.size(); }
  const BoundingSphereCache& sphere_cache(BodyIndex body) const noexcept { return sphere_caches_[body]; }
  ORCHARD_INLINE void prefetch_pose(BodyIndex index) const noexcept {  // and what a new one changes
    const Body& body = bodies_[index];
    prefetch_all(body.steps), prefetch_all(body.state), prefetch_all(body.one.sphere);
    prefetch(&sphere_caches_[index]);
  }
  ORCHARD_INLINE void prefetch_sphere_cache(BodyIndex body) const noexcept {  // nothing, of a half-space
    if (body < sphere_caches_.size()) prefetch(&sphere_caches_[body]);
  }

  // After any change of its pose or its validity.
  void moved(BodyIndex body, const Pose& before) noexcept;
  void move_part(BodyIndex body, std::size_t part, const PartRecord& to, const Shape& shape) noexcept;
  void invalidate(BodyIndex body) noexcept;  // what was known before says nothing of now
  // Whether either of two has been invalidated since forget_invalidated().
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
