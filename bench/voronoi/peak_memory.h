#pragma once
#include <functional>

namespace orchard::bench {

// Bytes that running adds to the peak of the resident memory, in a process of its own; 0 if the system does not tell.
double peak_bytes(const std::function<void()>& run);

}  // namespace orchard::bench
