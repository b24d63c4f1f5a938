#include "input/xyz.h"

#include <fmt/core.h>

#include <iterator>

namespace orchard::apps {

std::string to_xyz(std::span<const Point> points) {
  std::string text;
  for (const Point& p : points) fmt::format_to(std::back_inserter(text), "{} {} {}\n", p.x(), p.y(), p.z());
  return text;
}

}  // namespace orchard::apps
