#pragma once
#include "detector/static_spheres.h"
#include "orchard/runtime/collide.h"

namespace orchard::runtime::detail {

// Finds the pairs of bodies that have several parts with static bodies. The sphere around all parts of a robot arm is
// mostly empty and may contain all static bodies of a factory cell. So the broad phase does not look for these pairs;
// they are found at each step by the spheres of the parts. (This is like the several horns for one body of 4.1.2, but
// for one step only, because there are no bounds on the motion of joints.)
class PartSearch {
 public:
  bool any() const noexcept { return !bodies_.empty(); }
  std::span<const BodyIndex> bodies() const noexcept { return bodies_; }  // in ascending order
  // Begins and ends the search for a body of several parts that is not static.
  void begin(BodyIndex body, const BodyTable& table);
  void end(BodyIndex body) noexcept;
  // Call these when a static body was added or moved, and when it was removed.
  void static_changed(BodyIndex body, const BodyTable& table);
  void static_gone(BodyIndex body) noexcept;

  // The static bodies whose spheres touch those of the body's parts, in ascending order. Until the next call.
  std::span<const BodyIndex> touching(BodyIndex body, const BodyTable& table);
  // How many spheres of static bodies touch this one.
  std::size_t count_touching(const FloatSphere& sphere);
  std::size_t memory_bytes() const noexcept;

 private:
  std::vector<BodyIndex> bodies_, found_;
  StaticSpheres spheres_;  // of all static bodies while there are bodies_
};

}  // namespace orchard::runtime::detail
