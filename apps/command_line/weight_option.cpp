#include "command_line/weight_option.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

#include "orchard/geometry/error.h"
#include "orchard/geometry/text_lines.h"

namespace orchard::apps {

WeightRegion parse_weight(const std::string& text) {
  const auto fail = [&] {
    throw CLI::ValidationError(
        "--weight " + text +
        ": expected a ball and the factor of looseness in it as x,y,z,r=F, or a box as x,y,z,x,y,z=F, "
        "with r and F above 0");
  };
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  for (bool last = false; !last;) {
    double& value = numbers.emplace_back();
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) fail();
    const bool before_last = numbers.size() == 4 || numbers.size() == 6;
    last = next == end;
    if (!last && *next != ',' && !(*next == '=' && before_last)) fail();
    if (!last && *next == '=' && text.find('=') != text.rfind('=')) fail();
    at = last ? end : next + 1;
  }
  const std::size_t equals = text.find('=');
  const auto commas = static_cast<std::size_t>(std::count(text.begin(), text.end(), ','));
  if (equals == std::string::npos || commas + 2 != numbers.size() || !(numbers.back() > 0)) fail();
  const Point first(numbers[0], numbers[1], numbers[2]);
  if (numbers.size() == 5 && numbers[3] > 0) return {Sphere{first, numbers[3]}, numbers[4]};
  if (numbers.size() != 7) fail();
  Box box(first);
  box.extend(Point(numbers[3], numbers[4], numbers[5]));
  return {box, numbers[6]};
}

std::vector<double> read_vertex_weights(const std::filesystem::path& file) {
  TextLines lines(file);
  std::vector<double> weights;
  while (lines.next()) {
    weights.push_back(lines.real("a vertex's weight"));
    if (!(weights.back() > 0)) lines.fail("a weight must be above 0");
  }
  if (weights.empty())
    throw InputError(file.string() + ": the file has no weight; give a weight for each vertex, one on each line");
  return weights;
}

}  // namespace orchard::apps
