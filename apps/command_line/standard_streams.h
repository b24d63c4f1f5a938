#pragma once

namespace orchard::apps {

// Where a standard stream is closed, a file that is opened later would take its number and what is printed: takes the
// number first, for something that cannot be written (nor read).
void occupy_standard_streams();

// Whether everything that was printed to stdout, by C or C++, has reached it; if not, `errno` may say why.
bool flush_standard_output();

}  // namespace orchard::apps
