#pragma once
#include <optional>

#include "collision/pair_query.h"
#include "detector/half_spaces.h"
#include "detector/simple_pair.h"

namespace orchard::runtime::detail {

// What is asked at one step about two parts, the second of which may be a half-space, which no sphere is around.
struct PlacedPart : BoundingSphere {
  const Shape* shape = nullptr;
  bool rigid = true;

  PlacedPart() noexcept : BoundingSphere({}, 0) {}
  void be_in(const BoundingSphere& sphere) noexcept { static_cast<BoundingSphere&>(*this) = sphere; }
  const Pose& pose() const noexcept { return there != nullptr ? *there : *own; }
  void move_to(const Pose& pose) noexcept { there = nullptr, own = pose; }
  const Pose* there = nullptr;  // most are where their body is: that is not copied
  std::optional<Pose> own = {};
};

struct PartPair {
  PlacedPart a, b;
  bool simple() const noexcept { return !a.shape->has_tree() || !b.shape->has_tree(); }
  bool with_half_space() const noexcept { return b.shape->kind == ShapeKind::half_space; }
};

// Where bodies, parts and half-spaces are at the step under way.
class ShapePlacements {
 public:
  ShapePlacements(const ShapeTable& shapes, const BodyTable& bodies, const HalfSpaces& halves) noexcept
      : shapes_(&shapes), bodies_(&bodies), halves_(&halves) {}

  const Body& body(BodyIndex index) const noexcept {
    return is_half_space(index) ? halves_->body(index) : (*bodies_)[index];
  }
  std::uint32_t parts(BodyIndex index) const noexcept {
    return is_half_space(index) ? 1 : static_cast<std::uint32_t>((*bodies_)[index].parts().size());
  }
  void place(BodyIndex body, std::uint32_t part, PlacedPart& placed) const noexcept;
  const BoundingSphere& sphere(BodyIndex body, std::uint32_t part) const noexcept {  // not of a half-space
    return (*bodies_)[body].parts()[part].sphere;
  }
  // How far two parts are apart at least by the box or the capsule that each one's shape is in, and the other one's
  // sphere: long shapes fill little of theirs. Else at most 0.
  double bounds_gap(const BodyPair& pair, std::uint32_t part_a, std::uint32_t part_b, const BoundingSphere& a,
                    const BoundingSphere& b) const noexcept;
  // At the step before `now`; only of bodies that have been asked for then, or rest since before.
  void place_before(BodyIndex body, std::uint32_t part, Step now, PlacedPart& placed) const noexcept;
  ORCHARD_INLINE void prefetch_bodies(const BodyPair& pair) const noexcept {
    constexpr std::size_t kInCache = 2048;  // of so few bodies
    if (bodies_->slots() <= kInCache) return;
    for (const BodyIndex body : {pair.a, pair.b}) {
      if (is_half_space(body)) continue;
      const Body& of = (*bodies_)[body];
      prefetch_all(of.state.pose), prefetch(&of);
      prefetch(&of.one.sphere), prefetch(&of.one.shape), prefetch(&of.changes);
      bodies_->prefetch_sphere_cache(body);
    }
  }
  const HalfSpace& half_space(BodyIndex index) const noexcept { return halves_->shape(index).half; }

 private:
  double bounds_gap(BodyIndex body, std::uint32_t part, const BoundingSphere& sphere) const noexcept;
  void place_at(const Pose& pose, bool rigid, const PartRecord& part, PlacedPart& placed) const noexcept;
  const ShapeTable* shapes_;
  const BodyTable* bodies_;
  const HalfSpaces* halves_;
};

// Of rotations that are rotations to kRigidTolerance, and of coordinates.
inline constexpr double kPlaceRounding = 1e-11;

struct SphereGap {
  double least;  // how far apart the spheres around the two are, at least; at most 0 where they may overlap
  double most;   // and what is in them, at most
};
// `apart`: of the spheres' centres, or of a's from a half-space; `reach`, `size`: of both.
inline SphereGap sphere_gap(double apart, double reach, double size) noexcept {
  const double least = apart - reach - kPlaceRounding * size, most = std::max(0.0, apart) + reach;
  // Each solid is somewhere in its sphere.
  return {std::isfinite(least) ? least : 0, most >= 0 ? most : std::numeric_limits<double>::infinity()};
}
inline SphereGap sphere_gap(const BoundingSphere& a, const BoundingSphere& b) noexcept {
  return sphere_gap(length(b.center - a.center), a.reach + b.reach, a.size + b.size);
}
inline SphereGap sphere_gap(const BoundingSphere& a, const HalfSpace& half) noexcept {
  return sphere_gap(dot(half.normal, a.center) - half.offset, a.reach, a.size + std::fabs(half.offset));
}
// What is known of two parts that nothing was asked about.
Verdict unasked(const PartPair& pair) noexcept;

// A triangle of the tree that a simple shape was nearest to, as its last answer says: where looking for it begins.
std::uint32_t nearest_triangle(const Verdict& verdict, const PartPair& pair) noexcept;

// The whole answer, unless `work`, which it increases by what it costs, reaches `most`. `narrow` is only scratch.
Verdict answer_exactly(PairQuery& narrow, const PartPair& pair, std::uint64_t& work,
                       std::uint64_t most = std::numeric_limits<std::uint64_t>::max(),
                       std::uint32_t guess = kNoTriangle) noexcept;

// What is known of two trees whose surfaces have been asked about: of solid boxes these do not tell everything.
void make_solid(Verdict& verdict, const PartPair& pair) noexcept;

// The better of what is known of two pairs of parts, for their bodies: yes before maybe before no, then the least
// bound.
bool decides(const Verdict& verdict, const Verdict& than) noexcept;

}  // namespace orchard::runtime::detail
