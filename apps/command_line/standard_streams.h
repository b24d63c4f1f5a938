#pragma once

namespace orchard::apps {

// If a standard stream is closed, a file that is opened later would get its number and receive what is printed. This
// function takes the number first, for a file that cannot be written to (or read).
void occupy_standard_streams();

// Whether everything that was printed to stdout, by C or C++, has been written. If not, `errno` may tell why.
bool flush_standard_output();

}  // namespace orchard::apps
