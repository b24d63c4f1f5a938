#include <charconv>
#include <cmath>
#include <fstream>

#include "medial_run.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

// Reads up to three numbers; how many there are.
int read_numbers(const std::string& line, Point& point) {
  const char* at = line.data();
  const char* const end = at + line.size();
  for (int axis = 0; axis < 3; ++axis) {
    while (at != end && (*at == ' ' || *at == '\t' || *at == ',')) ++at;
    const auto [after, error] = std::from_chars(at, end, point[axis]);
    if (error != std::errc() || !std::isfinite(point[axis])) return axis;
    at = after;
  }
  return 3;
}

}  // namespace

OwnPoints read_own_points(const std::filesystem::path& file, const Surface& surface) {
  std::ifstream in(file);
  if (!in) throw InputError(file.string() + ": cannot be opened");
  OwnPoints own;
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
    Point point;
    if (read_numbers(line, point) < 3) {
      throw InputError(file.string() + ", line " + std::to_string(number) + ": expected three numbers, x y z");
    }
    const ClosestPoint place = surface.closest(point);
    own.farthest_moved = std::max(own.farthest_moved, place.distance);
    own.sampling.points.push_back(place.position);
    own.sampling.triangles.push_back(place.triangle);
    own.sampling.features.push_back(place.feature);
    own.sampling.origins.push_back(PointOrigin::face);
  }
  if (own.sampling.size() < 4) throw InputError(file.string() + ": four points at least are needed");
  return own;
}

}  // namespace orchard::apps
