#pragma once
#include <optional>

#include "collision/pair_query.h"
#include "detector/half_spaces.h"
#include "detector/simple_pair.h"

namespace orchard::runtime::detail {

// A part of a body at its pose of one step, with the sphere around it; or a half-space, which has no sphere.
struct PlacedPart : BoundingSphere {
  const Shape* shape = nullptr;
  bool rigid = true;

  PlacedPart() noexcept : BoundingSphere({}, 0) {}
  void be_in(const BoundingSphere& sphere) noexcept { static_cast<BoundingSphere&>(*this) = sphere; }
  const Pose& pose() const noexcept { return there != nullptr ? *there : *own; }
  void move_to(const Pose& pose) noexcept { there = nullptr, own = pose; }
  const Pose* there = nullptr;  // the pose of the body, which most parts have and which is not copied; null: `own`
  std::optional<Pose> own = {};
};

// Two parts at the poses of one step. Only `b` may be a half-space.
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
  // Returns a lower bound on the distance of two parts: from the box or the capsule around one of them to the sphere
  // around the other. For long shapes, which fill little of their spheres, it is sharper than that of the spheres. It
  // is at most 0 if nothing is known.
  double bounds_gap(const BodyPair& pair, std::uint32_t part_a, std::uint32_t part_b, const BoundingSphere& a,
                    const BoundingSphere& b) const noexcept;
  // Places a part where it was at the step before `now`. Precondition: the state of the body was asked for at that
  // step, or the body rests since then.
  void place_before(BodyIndex body, std::uint32_t part, Step now, PlacedPart& placed) const noexcept;
  ORCHARD_INLINE void prefetch_bodies(const BodyPair& pair) const noexcept {
    constexpr std::size_t kInCache = 2048;  // so few bodies are in the cache anyway
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

// A bound on the relative error of a place, from coordinates that are rounded and rotations that are exact to
// kRigidTolerance only.
inline constexpr double kPlaceRounding = 1e-11;

// Bounds from the spheres around two parts.
struct SphereGap {
  double least;  // a lower bound on the distance of the spheres; at most 0 if they may overlap
  double most;   // an upper bound on the distance of what is in them
};
// `apart` is the distance of the centres, or of a's centre from a half-space. `reach` and `size` are sums over both.
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
// Returns what the spheres around two parts say about them, without any other test.
Verdict unasked(const PartPair& pair) noexcept;

// Returns the triangle of a tree that a simple shape touched, by their last answer, so that the next search begins with
// it; kNoTriangle if they did not touch.
std::uint32_t nearest_triangle(const Verdict& verdict, const PartPair& pair) noexcept;

// Returns the answer about two parts, searched to the end unless `work` reaches `most`. Adds what it costs to `work`.
// `narrow` is scratch, and `guess` is that of test_simple().
Verdict answer_exactly(PairQuery& narrow, const PartPair& pair, std::uint64_t& work,
                       std::uint64_t most = std::numeric_limits<std::uint64_t>::max(),
                       std::uint32_t guess = kNoTriangle) noexcept;

// Corrects the verdict about two surfaces if one of them is that of a solid box: "no" becomes "yes" if a piece of the
// other shape lies inside the box.
void make_solid(Verdict& verdict, const PartPair& pair) noexcept;

// Returns whether `verdict`, about two parts, decides the answer of their bodies rather than `than`, about two other
// parts: yes comes before maybe, maybe before no, and then the smaller separation bound.
bool decides(const Verdict& verdict, const Verdict& than) noexcept;

}  // namespace orchard::runtime::detail
