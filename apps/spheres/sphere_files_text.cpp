#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <sstream>

#include "input/input_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/text_lines.h"
#include "spheres/sphere_files.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

bool begins_number(std::string_view word) {
  return !word.empty() &&
         (std::isdigit(static_cast<unsigned char>(word[0])) != 0 || word[0] == '-' || word[0] == '+' || word[0] == '.');
}

// A header has no number where the first coordinate is to be; its line stays, so that lines count as they do in the
// file. Returns what it said.
std::string take_header(std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xef\xbb\xbf\"");
  if (first == std::string::npos || text[first] == '#' || begins_number(std::string_view(text).substr(first, 4)) ||
      text.compare(first, 3, "nan") == 0 || text.compare(first, 3, "inf") == 0)
    return {};
  const std::size_t end = std::min(text.find('\n', first), text.size());
  std::string header = text.substr(first, end - first);
  std::fill(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  return header;
}

// The fifth value of a line, to its end, without the quotes of CSV.
std::string link_in(std::string_view line) {
  for (int comma = 0; comma < 4; ++comma) {
    const std::size_t at = line.find(',');
    if (at == std::string_view::npos) return {};
    line.remove_prefix(at + 1);
  }
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
  if (line.size() < 2 || line.front() != '"' || line.back() != '"') return std::string(line);
  std::string name;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    if (line[i] == '"') ++i;  // doubled
    name += line[i];
  }
  return name;
}

// x,y,z,r,link: a group for each link.
SphereFile read_links(const fs::path& file, const std::string& text) {
  SphereFile result{"CSV", {}};
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::size_t first = line.find_first_not_of(" \r\t");
    if (first == std::string::npos || line[first] == '#') continue;
    const std::string where = fmt::format("{}, line {}", file.string(), number);
    std::array<double, 4> values{};
    const char* at = line.data();
    for (double& value : values) {
      const auto [next, error] = std::from_chars(at, line.data() + line.size(), value);
      if (error != std::errc() || next == line.data() + line.size() || *next != ',')
        throw InputError(where + ": the line must be x,y,z,r and the name of a link");
      at = next + 1;
    }
    const std::string link = link_in(line);
    auto group = std::find_if(result.groups.begin(), result.groups.end(),
                              [&](const SphereGroup& one) { return one.name == link; });
    if (group == result.groups.end()) {
      group = result.groups.emplace(group);
      group->name = link;
    }
    add_sphere(*group, Point(values[0], values[1], values[2]), values[3], where);
  }
  return result;
}

// A section of a molecule: its name, blank lines, then a number and values a line.
struct Section {
  std::string name;
  std::vector<std::vector<double>> rows;
};

std::vector<Section> sections_of(const fs::path& file) {
  std::vector<Section> sections;
  std::istringstream lines(content_of(file));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    line.resize(std::min(line.find('#'), line.size()));
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || number == 1) continue;  // the first line is a comment
    if (!begins_number(line.substr(first))) {
      line.resize(line.find_last_not_of(" \t\r") + 1);
      sections.push_back({line.substr(first), {}});
      continue;
    }
    if (sections.empty()) continue;  // the header's counts
    std::vector<double>& row = sections.back().rows.emplace_back();
    std::istringstream words(line);
    for (std::string word; words >> word;) {
      double value = 0;
      const auto [next, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      if (error != std::errc() || next != word.data() + word.size())
        throw InputError(fmt::format("{}, line {}: \"{}\" is no number", file.string(), number, word));
      row.push_back(value);
    }
  }
  return sections;
}

}  // namespace

SphereFile read_text_spheres(const fs::path& file) {
  std::string text = content_of(file);
  const std::string header = take_header(text);
  if (header.ends_with(",link") || header.ends_with(",link\r")) return read_links(file, text);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  TextLines lines(file.string(), std::move(text));
  SphereGroup group;
  while (lines.next()) {
    Point center;
    for (int axis = 0; axis < 3; ++axis) center[axis] = lines.real("a coordinate");
    add_sphere(group, center, lines.real("a radius, the fourth number"), file.string());
  }
  return {"text, x y z r", {std::move(group)}};
}

SphereFile read_lammps_spheres(const fs::path& file) {
  const std::vector<Section> sections = sections_of(file);
  const auto rows_of = [&](const char* name, std::size_t width) -> const std::vector<std::vector<double>>& {
    for (const Section& section : sections)
      if (section.name == name) {
        for (const auto& row : section.rows)
          if (row.size() != width)
            throw InputError(fmt::format("{}: section {}: a line must have {} numbers", file.string(), name, width));
        return section.rows;
      }
    throw InputError(
        fmt::format("{}: the file is no molecule of spheres, since it has no section {}", file.string(), name));
  };
  const auto &centers = rows_of("Coords", 4), &diameters = rows_of("Diameters", 2);
  if (centers.size() != diameters.size()) throw InputError(file.string() + ": there must be a diameter for each atom");
  SphereGroup group;
  for (std::size_t i = 0; i < centers.size(); ++i)
    add_sphere(group, Point(centers[i][1], centers[i][2], centers[i][3]), diameters[i][1] / 2, file.string());
  return {"LAMMPS molecule", {std::move(group)}};
}

// What its reader would call: sphere((x, y, z), r), wherever it stands.
SphereFile read_yade_spheres(const fs::path& file) {
  const std::string text = content_of(file);
  constexpr std::string_view kCall = "sphere((";
  SphereGroup group;
  for (std::size_t at = text.find(kCall); at != std::string::npos; at = text.find(kCall, at)) {
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
    const std::string where = fmt::format("{}, line {}", file.string(), line);
    at += kCall.size();
    std::array<double, 4> values{};
    for (double& value : values) {
      at = std::min(text.find_first_not_of(" \t\n,)", at), text.size());
      const auto [next, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
      if (error != std::errc()) throw InputError(where + ": the call must be sphere((x, y, z), r) with numbers only");
      at = static_cast<std::size_t>(next - text.data());
    }
    add_sphere(group, Point(values[0], values[1], values[2]), values[3], where);
  }
  return {"YADE script", {std::move(group)}};
}

}  // namespace orchard::apps
