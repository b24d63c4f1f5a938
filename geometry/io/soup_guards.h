#pragma once
#include <string>
#include <string_view>

namespace orchard {

// CGAL's readers of STL and OFF take a file at its word: they make room for as many vertices as it promises, convert
// any number to an index, and say only that something went wrong, not where. These look a file over first, and return
// bytes that are safe to read, or throw InputError naming line or byte. Linear.
std::string checked_stl(std::string_view bytes, const std::string& name);
std::string checked_off(std::string_view bytes, const std::string& name);

}  // namespace orchard
