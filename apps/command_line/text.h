#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace orchard::apps {

// Returns the words with `between` between each two of them.
inline std::string joined(const std::vector<std::string>& words, const std::string& between = " ") {
  return fmt::format("{}", fmt::join(words, between));
}

// Whether a name is one of several.
inline bool among(const std::string& name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Returns the text with `by` in place of every `what`.
inline std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

}  // namespace orchard::apps
