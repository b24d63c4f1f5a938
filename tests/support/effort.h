#pragma once
#include <cstdint>
#include <cstdlib>

namespace orchard::test {

// ORCHARD_MORE=n in the environment: n times as many random cases as in CI, from other seeds.
inline std::uint64_t more() {
  const char* text = std::getenv("ORCHARD_MORE");
  const long factor = text != nullptr ? std::atol(text) : 1;
  return factor > 1 ? static_cast<std::uint64_t>(factor) : 1;
}
inline std::uint64_t first_seed() { return more() == 1 ? 0 : 1'000'000'000 + more(); }

}  // namespace orchard::test
