#pragma once
#include <atomic>

#include "broad_phase/body_pool.h"
#include "detector/shapes.h"

namespace orchard::runtime::detail {

inline bool is_half_space(BodyIndex index) noexcept { return index >= kFirstHalfSpace && index != kNoIndex; }

inline constexpr Step kNotAsked = -2;  // not the step before any step

// Where a part is in its body's frame.
struct PartPlace {
  bool at_origin = true;  // `local` changes nothing
  Pose local{};
  Vec3 center{};     // of a sphere around it,
  double off = 0;    // which is so far from the origin,
  double reach = 0;  // and its radius
};

struct PartRecord : PartPlace {
  ShapeId shape = kNoShape;
};

// Where it was up to a step, that one included.
struct PartBefore {
  PartPlace place;
  Step until = kNotAsked;
};

// A sphere in the world around a part or a body.
struct BoundingSphere {
  Vec3 center{};
  double reach = std::numeric_limits<double>::infinity();  // its radius; infinite until it is known where it is
  double size = std::numeric_limits<double>::infinity();   // no point of it is farther from the world's origin

  BoundingSphere() = default;
  BoundingSphere(const Vec3& middle, double radius) noexcept
      : center(middle),
        reach(radius),
        size(std::fabs(middle[0]) + std::fabs(middle[1]) + std::fabs(middle[2]) + radius) {}
};

// The same in floats, enlarged by more than what that rounds, so that four of them fit in a line of memory. Two that do
// not touch are apart by their BoundingSpheres, too.
struct FloatSphere {
  float x = 0, y = 0, z = 0, radius = std::numeric_limits<float>::infinity();

  // slack: see BoundingSphereCache.
  static FloatSphere around(const BoundingSphere& sphere, double slack) noexcept;
};

// By lines of memory: what each pair asks about, what a new pose does, and the rest.
struct alignas(64) Body {
  BodyId id = kNoBody;                   // kNoBody: no body has this index now
  std::uint32_t category = 1, mask = 0;  // of its BodyFilter, as `group` and `ignores_static` are
  std::int32_t group = 0;
  std::uint32_t filters = 0;   // grows with changes of its filter and sleep
  std::uint32_t jumps = 0;     // teleports
  std::uint32_t deformed = 0;  // changes of its shapes' trees
  ShapeId shape = kNoShape;    // of its first part
  std::uint8_t importance = 0;
  bool is_static = false;
  bool asleep = false;  // wanted by the application
  bool frozen = false;  // asleep, and its state is known: never asked again
  bool suggest = false;
  bool valid = true;       // the state that is known
  bool one = false;        // it has one part,
  bool at_origin = false;  // and that in its own frame
  bool ignores_static = false;
  bool by_parts = false;       // its pairs with static bodies are found by PartPairs
  Step moved = -1;             // the last step at which the pose was another one than at the time asked before
  Step stretched = kNotAsked;  // the step after which parts went farther out than ever before
  double continuous_speed = 0;

  BodyState state;  // as known last
  Pose before;      // at the step asked before, while the table keeps it: see BodyTable::keep_before()

  double min_reach = 0;           // as the application gave it
  double reach = 0;               // around its origin: what the broad phase has been told of, at scale 1
  double told_radius = -1;        // of the sphere that the broad phase relies on; below 0: none yet
  Step since = 0;                 // the first step that it takes part in
  Step asked = kNotAsked;         // the step that `state` is of
  Step known_before = kNotAsked;  // the step that `before` is of
  std::vector<PartRecord> parts;

  // A sphere around the parts in the body's frame, where they stay as they are and it is smaller than that around the
  // origin; else its radius is infinite.
  Vec3 middle{};
  double middle_reach = std::numeric_limits<double>::infinity();
  double off_middle = 0;        // from the origin to the middle
  bool told_by_middle = false;  // what the broad phase relies on
  bool parts_moved = false;     // since their spheres were placed

  Vec3 first_center{};                   // of the first part's sphere,
  double first_reach = 0;                // and its radius
  std::vector<PartBefore> parts_before;  // of each part; empty until one moves
  // Around each part, if there are several, at the pose that is known.
  std::vector<BoundingSphere> part_spheres;
  std::vector<FloatSphere> float_part_spheres;

  bool has_middle() const noexcept { return middle_reach < reach; }

  BodyFilter filter() const noexcept { return {category, mask, group, ignores_static}; }
  void set_filter(const BodyFilter& to) noexcept {
    category = to.category, mask = to.mask, group = to.group, ignores_static = to.ignores_static;
  }
};

// Half-spaces are static, too.
inline bool filters_allow(const Body& a, const Body& b) noexcept {
  const auto at_rest = [](const Body& body) { return body.is_static || is_half_space(body.id); };
  if ((a.ignores_static && at_rest(b)) || (b.ignores_static && at_rest(a))) return false;
  return may_pair(a.filter(), b.filter());
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
  double slack =
      0;  // what the centre may be off by, and a thousandth of what the rounding of a gap between spheres may
  double turned = 0;             // how far any point has moved about the centre up to now, at most, from step to step
  std::uint32_t changes = 0;     // since what was known before says nothing of now
  std::uint32_t generation = 0;  // of the body that has the index
};
static_assert(sizeof(BoundingSphereCache) == 64);

// A pose that is rigid, and numbers that BodyState and Motion allow.
bool is_valid(const BodyState& state) noexcept;
// The radius of a sphere around the body's origin that has the parts in it.
double reach_of(std::span<const PartRecord> parts) noexcept;
double reach_of(const PartPlace& part) noexcept;
void find_middle(Body& body) noexcept;
inline void forget_middle(Body& body) noexcept { body.middle_reach = std::numeric_limits<double>::infinity(); }
bool set_local(PartPlace& part, const Shape& shape, const Pose& local) noexcept;  // false: not rigid

// Which bodies there are and, per step, where: asked for at most once a step. Indices are the broad phase's.
class BodyTable {
 public:
  explicit BodyTable(StateSource source) : source_(std::move(source)) {}

  bool has_source() const noexcept { return static_cast<bool>(source_); }
  Body& add(BodyId id, std::size_t parts);               // with room for so many
  void parts_changed(BodyIndex body) noexcept;           // what is kept of the first one beside it
  void keep_before() noexcept { keeps_before_ = true; }  // from now on; else before() is anything
  void leave(BodyIndex body) noexcept;
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

  BodyState& state(BodyIndex body) noexcept { return bodies_[body].state; }
  const BodyState& state(BodyIndex body) const noexcept { return bodies_[body].state; }
  const Pose& before(BodyIndex body) const noexcept { return bodies_[body].before; }
  // For loops over pairs, whose bodies are anywhere; nothing where there are so few that a core's cache has them.
  ORCHARD_INLINE void prefetch_body(BodyIndex body) const noexcept {
    constexpr std::size_t kInCache = 2048;
    if (bodies_.size() <= kInCache) return;
    prefetch(&bodies_[body]);
    prefetch_sphere_cache(body);
    prefetch_all(bodies_[body].state.pose);
  }
  ORCHARD_INLINE void prefetch_sphere_cache(BodyIndex body) const noexcept {  // nothing, of a half-space
    if (body < sphere_caches_.size()) prefetch(&sphere_caches_[body]);
  }
  const BoundingSphereCache& sphere_cache(BodyIndex body) const noexcept { return sphere_caches_[body]; }
  const FloatSphere& float_sphere(BodyIndex body) const noexcept { return float_spheres_[body]; }
  // Whether any body ever had several parts, and whether one of these two has.
  bool any_parts() const noexcept { return any_parts_; }
  bool either_has_parts(const BodyPair& pair) const noexcept { return !bodies_[pair.a].one || !bodies_[pair.b].one; }
  // Of its parts; that of a body of one part is its own.
  std::span<const FloatSphere> float_part_spheres(BodyIndex body) const noexcept {
    return bodies_[body].one ? std::span(&float_spheres_[body], 1) : std::span(bodies_[body].float_part_spheres);
  }
  BoundingSphere sphere_around(BodyIndex body) const noexcept;                // all of its parts
  ORCHARD_INLINE void prefetch_float_sphere(BodyIndex body) const noexcept {  // nothing, of a half-space
    if (body < float_spheres_.size()) prefetch(&float_spheres_[body]);
  }
  // Whether BoundingSphereCache::changes of any body, or of this one, have grown since forget_invalidated().
  bool any_invalidated() const noexcept { return any_invalidated_.load(std::memory_order_relaxed); }
  bool invalidated(BodyIndex body) const noexcept { return invalidated_[body] != 0; }
  void forget_invalidated() noexcept;
  // Whether no answer so far was anything but valid.
  bool all_valid() const noexcept { return !any_flawed_.load(std::memory_order_relaxed); }
  // Who calls for what ask() does not see: another pose of a body at rest, another place of a part, other triangles.
  void moved(BodyIndex body, const Pose& before) noexcept;
  void move_part(BodyIndex body, std::size_t part, const PartPlace& to, const Shape& shape) noexcept;
  void deformed(BodyIndex body) noexcept { invalidate(body); }

  // Makes all their states those of the step; a body may come up twice. What follows from many answers is worked out by
  // jobs of `executor`.
  void ask(Step step, double time, std::span<const BodyIndex> bodies, const Executor& executor = {});
  void ask_everyone(Step step, double time, const Executor& executor);
  // The states of these bodies at another time, which changes nothing here.
  void look(double time, std::span<const BodyIndex> bodies, std::span<BodyState> states) const {
    source_(time, bodies, states);
  }
  // As the broad phase wants it. Not valid if the state is not.
  Motion motion_of(BodyIndex body, double time_step) const noexcept {
    return motion_of(body, time_step, relies_on_middle(body, time_step));
  }
  Motion motion_of(BodyIndex body, double time_step, bool by_middle) const noexcept;
  // Whether that is the motion of Body::middle: it turns too slowly to get far from there in some steps.
  bool relies_on_middle(BodyIndex index, double time_step) const noexcept {
    constexpr double kSteps = 8;
    const Body& body = bodies_[index];
    return body.has_middle() &&
           kSteps * time_step * body.state.angular_speed * body.off_middle <= body.reach - body.middle_reach;
  }
  // Whether the spheres of motion_of() do not touch, where both states are known.
  bool surely_apart(const BodyPair& pair, double time_step) const noexcept;
  std::size_t memory_bytes() const noexcept;

 private:
  static void place_part(Body& body, std::size_t part) noexcept;
  static void place_parts(Body& body) noexcept;
  void add_turn(BodyIndex body, double way) noexcept;
  void invalidate(BodyIndex body) noexcept;
  void ask_source(Step step, double time, const Executor& executor);
  void take_answers(Step step, std::span<const BodyIndex> bodies, const Executor& executor);
  void take_answer(Step step, BodyIndex index, const BodyState& answer) noexcept;
  StateSource source_;
  std::vector<Body> bodies_;
  bool keeps_before_ = false, any_parts_ = false;
  std::vector<BoundingSphereCache> sphere_caches_;
  std::vector<FloatSphere> float_spheres_;
  std::vector<std::uint8_t> invalidated_;
  std::atomic<bool> any_invalidated_ = false, any_flawed_ = false;  // set by jobs
  std::vector<BodyIndex> asking_;
  std::vector<BodyState> answers_;
};

}  // namespace orchard::runtime::detail
