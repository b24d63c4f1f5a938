#include "medial/axis_arrays.h"

#include <limits>
#include <span>

#include "orchard/medial/structure.h"

namespace orchard::apps {
namespace {

template <std::size_t n>
std::vector<std::uint32_t> flat(const std::vector<std::array<Index, n>>& cells) {
  std::vector<std::uint32_t> result;
  result.reserve(n * cells.size());
  for (const auto& cell : cells) result.insert(result.end(), cell.begin(), cell.end());
  return result;
}

std::vector<double> flat(const std::vector<Point>& points) {
  std::vector<double> result;
  result.reserve(3 * points.size());
  for (const Point& point : points) result.insert(result.end(), {point.x(), point.y(), point.z()});
  return result;
}

enum Array : std::size_t {
  kBalls,
  kStructure,
  kKind,
  kEdges,
  kTriangles,
  kContacts,
  kContactBall,
  kContactSample,
  kSamples,
  kSampleBall,
  kAfterSamples
};

}  // namespace

std::vector<NamedArray> axis_arrays(const MedialMesh& mesh, const AxisContacts& contacts,
                                    const std::vector<ImportanceArray>& importance) {
  const MedialStructure structure = medial_structure(mesh);
  std::vector<double> balls;
  std::vector<std::uint32_t> kinds;
  for (Index v = 0; v < mesh.size(); ++v) {
    const Point& center = mesh.centers[v];
    balls.insert(balls.end(), {center.x(), center.y(), center.z(), mesh.radii[v]});
    kinds.push_back(static_cast<std::uint32_t>(structure.parts[structure.of_vertex[v]].kind));
  }
  std::vector<NamedArray> arrays{{"balls", {"x", "y", "z", "radius"}, std::move(balls)},
                                 {"structure", {"structure"}, structure.of_vertex},
                                 {"structure_kind", {"structure_kind"}, std::move(kinds)},
                                 {"edges", {"a", "b"}, flat(mesh.edges)},
                                 {"triangles", {"a", "b", "c"}, flat(mesh.triangles)},
                                 {"contacts", {"x", "y", "z"}, flat(contacts.places)},
                                 {"contact_ball", {"ball"}, contacts.balls},
                                 {"contact_sample", {"sample"}, contacts.samples},
                                 {"samples", {"x", "y", "z"}, flat(contacts.sample_places)},
                                 {"sample_ball", {"ball"}, contacts.sample_balls}};
  for (const auto& [name, values] : importance) {
    std::vector<double> of_balls = values;
    of_balls.resize(mesh.centers.size(), std::numeric_limits<double>::quiet_NaN());  // middles of faces have none
    arrays.push_back({name, {name}, std::move(of_balls)});
  }
  return arrays;
}

std::vector<std::string> axis_table_endings() {
  return {"-balls.csv", "-edges.csv", "-triangles.csv", "-contacts.csv", "-samples.csv"};
}

std::vector<std::pair<std::string, std::string>> axis_tables(const MedialMesh& mesh, const AxisContacts& contacts,
                                                             const std::vector<ImportanceArray>& importance) {
  const std::vector<NamedArray> all = axis_arrays(mesh, contacts, importance);
  std::vector<NamedArray> balls{all[kBalls], all[kStructure], all[kKind]};
  balls.insert(balls.end(), all.begin() + kAfterSamples, all.end());
  const std::vector<NamedArray> touching{all[kContactBall], all[kContacts], all[kContactSample]};
  const std::span<const NamedArray> arrays = all;
  return {{"-balls.csv", to_csv(balls)},
          {"-edges.csv", to_csv(arrays.subspan(kEdges, 1))},
          {"-triangles.csv", to_csv(arrays.subspan(kTriangles, 1))},
          {"-contacts.csv", to_csv(touching)},
          {"-samples.csv", to_csv(arrays.subspan(kSamples, 2))}};
}

}  // namespace orchard::apps
