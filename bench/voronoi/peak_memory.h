#pragma once
#include <functional>

namespace orchard::bench {

// Bytes that running adds to the peak of the resident memory, in a process of its own; 0 if the system does not tell.
// Unless `warm`, it runs once only, and what the program brings in of itself is counted: little where the rest is much.
double peak_bytes(const std::function<void()>& run, bool warm = true);

}  // namespace orchard::bench
