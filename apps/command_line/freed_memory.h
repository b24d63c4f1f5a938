#pragma once

namespace orchard::apps {

// Lets the allocator keep what is freed, for the next allocation, where it would give it back to the system: mapping
// pages again took a tenth of the time of a medial axis. To be called first; does nothing where the C library is not
// GNU's.
void keep_freed_memory();

}  // namespace orchard::apps
