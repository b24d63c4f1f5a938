#include "medial/feature_lines.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "orchard/geometry/error.h"
#include "orchard/geometry/text_lines.h"

namespace orchard::apps {
namespace {

constexpr double kSamePlace = 1e-5;  // in bounding radii: coordinates written with six digits are off by less

class FeatureLineReader {
 public:
  FeatureLineReader(const std::filesystem::path& file, const Surface& surface) : file_(file), surface_(surface) {
    for (std::size_t t = 0; t < surface.mesh().triangles.size(); ++t) {
      const auto& corners = surface.mesh().triangles[t];
      for (std::size_t i = 0; i < 3; ++i) edges_.push_back(ascending(corners[i], corners[(i + 1) % 3]));
    }
    std::sort(edges_.begin(), edges_.end());
  }

  std::vector<std::array<Index, 2>> run() {
    std::ifstream in(file_);
    if (!in) throw InputError(fmt::format("{}: the file cannot be read; check its permissions", file_.string()));
    std::string line, word;
    while (std::getline(in, line)) {
      ++number_;
      std::istringstream words(line);
      if (!(words >> word)) continue;
      if (word == "v") add_place(words);
      if (word == "l") add_line(words);
    }
    if (result_.empty())
      throw InputError(
          fmt::format("{}: the file has no lines (\"l 1 2\"); feature edges are lines of an OBJ file", file_.string()));
    std::sort(result_.begin(), result_.end());
    result_.erase(std::unique(result_.begin(), result_.end()), result_.end());
    return std::move(result_);
  }

 private:
  static std::array<Index, 2> ascending(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }
  [[noreturn]] void fail(const std::string& fault) const {
    throw InputError(fmt::format("{}, line {}: {}", file_.string(), number_, fault));
  }

  void add_place(std::istringstream& words) {
    Point place;
    for (int axis = 0; axis < 3; ++axis) {
      std::string word;
      words >> word;
      char* end = nullptr;
      place[axis] = std::strtod(word.c_str(), &end);
      if (word.empty() || *end != '\0' || !std::isfinite(place[axis])) fail("expected three coordinates after \"v\"");
    }
    places_.push_back(place);
  }

  // "l 1 2 3", counted from 1, or from the last place backwards; "1/1" has a texture's place, too.
  void add_line(std::istringstream& words) {
    Index last = kNone;
    std::size_t ends = 0;
    std::string word;
    while (words >> word) {
      char* end = nullptr;
      const long long given = std::strtoll(word.c_str(), &end, 10), count = static_cast<long long>(places_.size());
      if (end == word.c_str() || (*end != '\0' && *end != '/')) fail("expected numbers of places after \"l\"");
      const long long place = given < 0 ? count + given : given - 1;
      if (place < 0 || place >= count) fail(fmt::format("place {} is not among the {} before this line", given, count));
      const Index vertex = vertex_at(places_[static_cast<std::size_t>(place)]);
      if (last != kNone && last != vertex) add_edge(last, vertex);
      last = vertex;
      ++ends;
    }
    if (ends < 2) fail("expected two or more places after \"l\"");
  }

  Index vertex_at(const Point& place) const {
    const double near = kSamePlace * surface_.bounding_radius();
    const ClosestPoint closest = surface_.closest(place);
    const auto& corners = surface_.mesh().triangles[closest.triangle];
    for (const Index v : corners) {
      if ((surface_.mesh().vertices[v] - place).norm() <= near) return v;
    }
    fail("the place is no vertex of the mesh");
  }
  void add_edge(Index a, Index b) {
    const std::array<Index, 2> edge = ascending(a, b);
    if (!std::binary_search(edges_.begin(), edges_.end(), edge))
      fail("the mesh has no edge between two vertices of the line");
    result_.push_back(edge);
  }

  const std::filesystem::path& file_;
  const Surface& surface_;
  std::vector<std::array<Index, 2>> edges_;  // of the mesh, ascending
  std::vector<Point> places_;
  std::vector<std::array<Index, 2>> result_;
  std::size_t number_ = 0;  // of the line
};

}  // namespace

std::vector<std::array<Index, 2>> read_feature_lines(const std::filesystem::path& file, const Surface& surface) {
  return FeatureLineReader(file, surface).run();
}

std::string to_feature_lines(const Surface& surface, const std::vector<std::array<Index, 2>>& edges) {
  std::vector<Index> used;
  for (const auto& edge : edges) used.insert(used.end(), edge.begin(), edge.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::string text = "# edges of the mesh that sheets of its medial axis reach\n";
  for (const Index v : used) {
    text += 'v';
    for (int axis = 0; axis < 3; ++axis) append_number(text, surface.mesh().vertices[v][axis]);
    text += '\n';
  }
  const auto number = [&](Index v) {
    return static_cast<Index>(std::lower_bound(used.begin(), used.end(), v) - used.begin() + 1);
  };
  for (const auto& [a, b] : edges) {
    text += 'l';
    append_number(text, number(a));
    append_number(text, number(b));
    text += '\n';
  }
  return text;
}

}  // namespace orchard::apps
