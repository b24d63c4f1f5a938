#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// What the arrays of views mean, as docs/reference/data.md has it.
namespace orchard::apps {

struct ArrayDescription {
  std::string unit;     // such as "mesh units"; "-" if the array has none
  std::string meaning;  // one sentence
};

// Returns nothing for a name that data.md does not list.
std::optional<ArrayDescription> description_of(const std::string& array);

// Returns "NAME [UNIT]: MEANING" for each array of points, cells or field data in the text of a .vtp or .vtu file, in
// the order of the file and each name once. Arrays that data.md does not list are left out. The time is linear in the
// size of the file.
std::vector<std::string> descriptions_in(std::string_view vtk_xml);

}  // namespace orchard::apps
