#include "output/array_descriptions.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "arrays.h"

namespace orchard::apps {
namespace {

const std::map<std::string, ArrayDescription>& all_descriptions() {
  static const std::map<std::string, ArrayDescription> kAll = [] {
    std::map<std::string, ArrayDescription> all;
    for (const nlohmann::json& row : nlohmann::json::parse(kArrays))
      all.emplace(row["name"], ArrayDescription{row["unit"], row["meaning"]});
    return all;
  }();
  return kAll;
}

// The names of the arrays in elements <KIND>..</KIND>.
void add_array_names(std::string_view xml, const std::string& kind, std::vector<std::string>& names) {
  const std::string begin = "<" + kind, end = "</" + kind + ">";
  for (std::size_t at = xml.find(begin); at != std::string_view::npos; at = xml.find(begin, at)) {
    const std::size_t last = std::min(xml.find(end, at), xml.size());
    const std::string_view element = xml.substr(at, last - at);
    for (std::size_t tag = element.find("Array "); tag != std::string_view::npos; tag = element.find("Array ", tag)) {
      constexpr std::string_view kName = "Name=\"";
      const std::size_t name = element.find(kName, tag);
      tag = std::min(element.find('>', tag), element.size());
      if (name >= tag) continue;
      const std::size_t from = name + kName.size();
      std::string found(element.substr(from, element.find('"', from) - from));
      if (std::find(names.begin(), names.end(), found) == names.end()) names.push_back(std::move(found));
    }
    at = last;
  }
}

}  // namespace

std::optional<ArrayDescription> description_of(const std::string& array) {
  const auto found = all_descriptions().find(array);
  if (found == all_descriptions().end()) return std::nullopt;
  return found->second;
}

std::vector<std::string> descriptions_in(std::string_view vtk_xml) {
  std::vector<std::string> names, lines;
  for (const char* kind : {"PointData", "CellData", "FieldData"}) add_array_names(vtk_xml, kind, names);
  for (const std::string& name : names) {
    const std::optional<ArrayDescription> found = description_of(name);
    if (!found) continue;
    const std::string unit = found->unit == "-" ? "" : " [" + found->unit + "]";
    lines.push_back(name + unit + ": " + found->meaning);
  }
  return lines;
}

}  // namespace orchard::apps
