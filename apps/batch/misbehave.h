#pragma once
#include <string>

namespace orchard::apps {

// What a batch must survive, for its tests: crash (SIGSEGV), killed (SIGKILL), hang, memory (takes more and more of
// it), chatter (prints for ever). Does not return.
[[noreturn]] void misbehave(const std::string& kind);

}  // namespace orchard::apps
