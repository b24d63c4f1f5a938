#pragma once
#include <string>
#include <vector>

namespace orchard::apps {

// Replaces options of the previous version by their present names in the words of a command line (the program's name
// first). Returns a warning for each; throws InputError, naming what to use instead, for an option that is gone.
std::vector<std::string> rename_options(std::vector<std::string>& words);

}  // namespace orchard::apps
