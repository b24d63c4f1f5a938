#pragma once
#include <optional>

#include "half_spaces.h"
#include "simple_pair.h"

namespace orchard::runtime::detail {

// What is asked at one step about two parts, or a part and a half-space.
struct PlacedPart {
  const Shape* shape = nullptr;  // null: a half-space
  Vec3 center{};                 // of the part's sphere, in the world
  double reach = 0;
  double size = 0;  // no point of it is farther from the origin
  bool rigid = true;

  void be_in(const Vec3& middle, double radius) noexcept {
    center = middle, reach = radius;
    size = std::fabs(middle[0]) + std::fabs(middle[1]) + std::fabs(middle[2]) + radius;
  }
  const Pose& pose() const noexcept { return there != nullptr ? *there : *own; }
  void move_to(const Pose& pose) noexcept { there = nullptr, own = pose; }
  const Pose* there = nullptr;  // most are where their body is: that is not copied
  std::optional<Pose> own = {};
};

struct PartPair {
  PlacedPart a, b;
  HalfSpace half;  // b, where it is one
  bool simple() const noexcept { return b.shape == nullptr || !a.shape->has_tree() || !b.shape->has_tree(); }
};

// Where bodies, parts and half-spaces are at the step under way.
class Places {
 public:
  Places(const ShapeTable& shapes, const BodyTable& bodies, const HalfSpaces& halves) noexcept
      : shapes_(&shapes), bodies_(&bodies), halves_(&halves) {}

  const Body& body(BodyIndex index) const noexcept {
    return is_half_space(index) ? halves_->body(index) : (*bodies_)[index];
  }
  std::uint32_t parts(BodyIndex index) const noexcept {
    if (is_half_space(index)) return 1;
    const Body& of = (*bodies_)[index];
    return of.one ? 1 : static_cast<std::uint32_t>(of.parts.size());
  }
  void place(BodyIndex body, std::uint32_t part, PlacedPart& placed) const noexcept;
  // All but the pose: enough for spheres, and a third of the time.
  void place_sphere(BodyIndex body, std::uint32_t part, PlacedPart& placed) const noexcept;
  // How far two parts are apart at least by the box or the capsule that each one's shape is in, and the other one's
  // sphere: long shapes fill little of theirs. Else at most 0.
  double bounds_gap(const BodyPair& pair, std::uint32_t part_a, std::uint32_t part_b,
                    const PartPair& placed) const noexcept;
  // At the step before `now`; only of bodies that have been asked for then, or rest since before.
  void place_before(BodyIndex body, std::uint32_t part, Step now, PlacedPart& placed) const noexcept;
  ORCHARD_INLINE void prefetch_bodies(const BodyPair& pair) const noexcept {
    bodies_->prefetch_body(pair.a);
    if (!is_half_space(pair.b)) bodies_->prefetch_body(pair.b);
  }
  const HalfSpace& half_space(BodyIndex index) const noexcept { return halves_->half_space(index); }
  const BodyTable& bodies() const noexcept { return *bodies_; }

 private:
  double bounds_gap(BodyIndex body, std::uint32_t part, const PlacedPart& sphere) const noexcept;
  void place_at(const Pose& pose, bool rigid, ShapeId shape, const PartPlace& part, PlacedPart& placed) const noexcept;
  const ShapeTable* shapes_;
  const BodyTable* bodies_;
  const HalfSpaces* halves_;
};

struct SphereGap {
  double least;  // how far apart the spheres around the two are, at least; at most 0 where they may overlap
  double most;   // and what is in them, at most
};
SphereGap sphere_gap(const PartPair& pair) noexcept;
bool spheres_part(const PartPair& pair) noexcept;  // whether the least gap is more than 0
// What is known of two parts that nothing was asked about.
Verdict unasked(const PartPair& pair) noexcept;
Verdict unasked(const PartPair& pair, const SphereGap& gap) noexcept;

// A triangle of the tree that a simple shape was nearest to, as its last answer says: where looking for it begins.
std::uint32_t nearest_triangle(const Verdict& verdict, const PartPair& pair) noexcept;

// The whole answer, unless `work`, which it increases by what it costs, reaches `most`. `narrow` is only scratch.
Verdict answer_exactly(NarrowPhase& narrow, const PartPair& pair, std::uint64_t& work,
                       std::uint64_t most = std::numeric_limits<std::uint64_t>::max(),
                       std::uint32_t guess = kNoTriangle) noexcept;

// What is known of two trees whose surfaces have been asked about: of solid boxes these do not tell everything.
void make_solid(Verdict& verdict, const PartPair& pair) noexcept;
inline Verdict solid_verdict(Verdict verdict, const PartPair& pair) noexcept {
  make_solid(verdict, pair);
  return verdict;
}
inline Verdict verdict_of(const NarrowPhase& narrow, const PartPair& pair) noexcept {
  return solid_verdict(narrow.verdict(), pair);
}

// The better of what is known of two pairs of parts, for their bodies: yes before maybe before no, then the least
// bound.
bool decides(const Verdict& verdict, const Verdict& than) noexcept;

}  // namespace orchard::runtime::detail
