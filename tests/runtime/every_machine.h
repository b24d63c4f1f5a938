#pragma once
#include <gtest/gtest.h>

#include "machine.h"

namespace orchard::runtime::test {

// Runs `check` with the inner loops of every machine that this one can be.
template <typename Check>
void on_every_machine(const Check& check) {
  for (detail::Machine m = detail::Machine::base; m <= detail::best_machine();
       m = static_cast<detail::Machine>(static_cast<int>(m) + 1)) {
    SCOPED_TRACE(static_cast<int>(m));
    detail::use_machine(m);
    check();
  }
  detail::use_machine(detail::best_machine());
}

}  // namespace orchard::runtime::test
