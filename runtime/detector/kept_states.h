#pragma once
#include <span>
#include <vector>

#include "orchard/runtime/detector.h"

namespace orchard::runtime::detail {

// The states of bodies that the detector keeps for the application: each body moves straight from the time at which its
// state was set.
class KeptStates {
 public:
  // put_cancels: the bounds of a body hold until put().
  explicit KeptStates(bool put_cancels) noexcept : put_cancels_(put_cancels) {}
  void put(BodyIndex body, double time, const BodyState& state);
  BodyState at(double time, BodyIndex body) const noexcept;
  void fill(double time, std::span<const BodyIndex> bodies, std::span<BodyState> states) const noexcept;
  std::size_t memory_bytes() const noexcept { return told_.capacity() * sizeof(Told); }

 private:
  struct Told {
    BodyState state;
    double time = 0;
  };
  std::vector<Told> told_;  // by BodyIndex
  bool put_cancels_;
};

}  // namespace orchard::runtime::detail
