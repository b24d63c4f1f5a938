#include "input/xml_file.h"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

#include "input/input_file.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {

using tinyxml2::XMLElement;

std::string at_line(const std::filesystem::path& file, const XMLElement& element) {
  return fmt::format("{}, line {}", file.string(), element.GetLineNum());
}

const XMLElement& parse_xml(const std::filesystem::path& file, tinyxml2::XMLDocument& document, const char* root,
                            const char* what) {
  const std::string text = content_of(file);
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw InputError(fmt::format("{}, line {}: the file is no well-formed XML ({})", file.string(),
                                 document.ErrorLineNum(), document.ErrorName()));
  const XMLElement* element = document.RootElement();
  if (element == nullptr)
    throw InputError(fmt::format("{}: the file is no {}, since it has no element", file.string(), what));
  if (std::string_view(element->Name()) != root)
    throw InputError(fmt::format("{}: the file is no {}, since its root is <{}> rather than <{}>",
                                 at_line(file, *element), what, element->Name(), root));
  return *element;
}

std::vector<double> numbers_in(const std::string& text, std::size_t count, const std::string& where, const char* what) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  const auto skip_blanks = [&] {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '\n' || *at == '\r')) ++at;
  };
  for (skip_blanks(); at != end; skip_blanks()) {
    const auto [next, error] = std::from_chars(*at == '+' ? at + 1 : at, end, numbers.emplace_back());
    if (error != std::errc()) break;
    at = next;
  }
  if (at != end || numbers.size() != count)
    throw InputError(
        fmt::format("{}: {} has to be {} number{}, but it is \"{}\"", where, what, count, count == 1 ? "" : "s", text));
  return numbers;
}

std::vector<const XMLElement*> children_of(const XMLElement& parent, const char* name) {
  std::vector<const XMLElement*> children;
  for (const XMLElement* child = parent.FirstChildElement(name); child != nullptr;
       child = child->NextSiblingElement(name))
    children.push_back(child);
  return children;
}

}  // namespace orchard::apps
