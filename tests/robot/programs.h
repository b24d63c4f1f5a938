#pragma once
#include <cstdlib>
#include <string>

namespace orchard::test {

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Whether a program is installed.
inline bool is_installed(const char* program) {
  return std::system(("command -v " + std::string(program) + " > /dev/null").c_str()) == 0;
}

}  // namespace orchard::test
