#pragma once
#include "detector/static_spheres.h"
#include "orchard/runtime/collide.h"

namespace orchard::runtime::detail {

// A sphere around all of an arm's parts is mostly empty, and what is in it may be a whole cell of a factory. So for
// bodies of several parts among many static ones the broad phase is spared these pairs: at each step they are found by
// the parts' own spheres. (Several horns for one body, as in 4.1.2, that are relied on for one step: joints promise
// nothing.)
class PartSearch {
 public:
  bool any() const noexcept { return !bodies_.empty(); }
  std::span<const BodyIndex> bodies() const noexcept { return bodies_; }  // in ascending order
  // From now on, and no longer, for this body of several parts that is not static.
  void begin(BodyIndex body, const BodyTable& table);
  void end(BodyIndex body) noexcept;
  // A static body is somewhere else, or new; it is gone.
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
