#pragma once
#include "orchard/runtime/distance.h"
#include "pair_tests.h"

namespace orchard::runtime::detail {

// From one pose to another in one unit of time: the part's centre straight, the rotation about one axis by the smallest
// angle.
class PoseWay {
 public:
  // Both rigid, of one scale. `center` is in the world, of the sphere around what moves.
  PoseWay(const PlacedPart& from, const PlacedPart& to) noexcept;
  Pose at(double time) const noexcept;
  double speed() const noexcept { return speed_; }  // no point of the part moves faster

 private:
  Pose from_, to_;
  Vec3 center_{};         // in the part's frame
  Vec3 begin_{}, way_{};  // of it in the world
  Vec3 axis_{0, 0, 1};
  double angle_ = 0, speed_ = 0;
};

struct Swept {
  Answer answer = Answer::no;  // of whether they touch between the two poses; maybe: not known from `from` on
  double from = 0, to = 1;     // they do not touch before `from`; yes: they do at `to`
  Verdict verdict;             // at `to`
};

// By conservative advancement (Mirtich 1996): nothing can touch before the distance has been used up at the largest
// speed with which two points can come nearer. Ends once `work`, which it increases, has reached `most`, less than
// kMaxOvershoot beyond; what is not known by then is maybe.
Swept sweep(NarrowPhase& narrow, DistanceQuery& distance, const PlacedPair& from, const PlacedPair& to,
            std::uint64_t most, std::uint64_t& work) noexcept;

}  // namespace orchard::runtime::detail
