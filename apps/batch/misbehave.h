#pragma once
#include <string>

namespace orchard::apps {

// Simulates the faults that a batch has to survive, for its tests: crash (SIGSEGV), killed (SIGKILL), hang, memory
// (allocates without end), chatter (prints without end). Does not return.
[[noreturn]] void misbehave(const std::string& kind);

}  // namespace orchard::apps
