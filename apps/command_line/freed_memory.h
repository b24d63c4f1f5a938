#pragma once

namespace orchard::apps {

// Lets the allocator keep freed memory for later allocations instead of returning it to the system. Mapping pages again
// took a tenth of the time of a medial axis. Call it first. It does nothing with C libraries other than GNU's.
void keep_freed_memory();

}  // namespace orchard::apps
