#pragma once
#include <gtest/gtest.h>

#include "simd/machine.h"

namespace orchard::runtime::test {

// While one lives, the inner loops are those of this machine.
class OnMachine {
 public:
  explicit OnMachine(detail::Machine machine) noexcept : before_(detail::machine()) { detail::use_machine(machine); }
  OnMachine(const OnMachine&) = delete;
  OnMachine& operator=(const OnMachine&) = delete;
  ~OnMachine() { detail::use_machine(before_); }

 private:
  detail::Machine before_;
};

// With the portable inner loops, or with the best ones.
inline OnMachine on_portable_machine(bool portable) {
  return OnMachine(portable ? detail::Machine::portable : detail::best_machine());
}

// What the loops of one number at a time make of a question.
template <typename Ask>
void ask_portably(const Ask& ask) {
  const OnMachine chosen(detail::Machine::portable);
  ask();
}

// Runs `check` with the inner loops of every machine that this one can be.
template <typename Check>
void on_every_machine(const Check& check) {
  for (detail::Machine m = detail::Machine::portable; m <= detail::best_machine();
       m = static_cast<detail::Machine>(static_cast<int>(m) + 1)) {
    SCOPED_TRACE(static_cast<int>(m));
    const OnMachine chosen(m);
    check();
  }
}

}  // namespace orchard::runtime::test
