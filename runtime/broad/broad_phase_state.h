#pragma once
#include "method.h"

namespace orchard::runtime {

struct BroadPhase::State {
  detail::BodyPool pool;
  std::unique_ptr<detail::Method> method;
  detail::Step next = detail::kNeverStep;  // the next step with anything to do
  detail::Step validated = -1;             // up to which step all bodies have been asked for, for their promises
  bool woken = false;                      // for a change, since the last step
};

}  // namespace orchard::runtime
