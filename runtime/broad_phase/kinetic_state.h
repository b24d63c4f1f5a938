#pragma once
#include "broad_phase/box_index.h"
#include "broad_phase/changes.h"
#include "broad_phase/horn.h"
#include "broad_phase/overlap_list.h"
#include "broad_phase/windows.h"

namespace orchard::runtime::detail {

// The state that the classes of the kinetic broad phase share: what is known of the bodies, and which of them overlap.
struct KineticState {
  KineticState(BodyPool& all, const BroadPhaseOptions& given) : pool(all), options(given), windows(all, given.window) {}

  void make_room(std::size_t slots) {
    boxes.make_room(slots);
    changes.make_room(slots);
    overlaps.make_room(slots);
    windows.make_room(slots);  // last, because windows.size() shows that there is room in all of them
  }
  // Takes a body whose motion is not valid out of all pairs until its motion has been asked for again.
  void refuse(BodyIndex body);
  std::size_t memory_bytes() const noexcept {
    return changes.memory_bytes() + windows.memory_bytes() + boxes.memory_bytes() + wheel.memory_bytes() -
           sizeof(wheel) + overlaps.memory_bytes();
  }

  BodyPool& pool;
  const BroadPhaseOptions options;
  Changes changes;
  Windows windows;
  QuantizedGrid grid;  // the coordinates of the boxes; it moves with the bodies
  BoxIndex boxes;
  GridCounts counts;  // of the insertions into `boxes`, for the planner
  TimingWheel wheel;
  OverlapList overlaps;
};

}  // namespace orchard::runtime::detail
