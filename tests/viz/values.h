#pragma once
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "orchard/geometry/random.h"
#include "orchard/medial/axis.h"
#include "orchard/spheretree/tree.h"
#include "support/shapes.h"

// Small values of the pipeline, made by hand, for the tests of viz.
namespace orchard::test {

// A folder of its own, removed at the end.
class TestFolder {
 public:
  TestFolder() {
    static std::atomic<int> count{0};
    path_ = std::filesystem::temp_directory_path() /
            ("orchard-viz-test-" + std::to_string(getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Corners and midpoints, of all three origins.
inline SurfaceSampling corner_sampling(const Surface& surface) {
  SurfaceSampling sampling;
  for (Index triangle = 0; triangle < surface.mesh().triangles.size(); ++triangle) {
    const auto [a, b, c] = surface.corners(triangle);
    sampling.points.push_back((a + b + c) / 3);
    sampling.triangles.push_back(triangle);
    sampling.features.push_back(Feature::face);
    sampling.origins.push_back(static_cast<PointOrigin>(triangle % 3));
  }
  return sampling;
}

// Two components: a path of three vertices with one triangular face, and a lone vertex.
inline MedialAxis small_axis() {
  MedialAxis axis;
  axis.points = {{0, 0, 1}, {0, 0, -1}};
  axis.normals = {{0, 0, 1}, {0, 0, -1}};
  axis.origins = {PointOrigin::face, PointOrigin::repair};
  axis.centers = {{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}, {0.25, 0.25, 0.125}};
  axis.radii = {1, 0.5, 0.25, 0.125};
  for (const auto& row : std::initializer_list<std::vector<Index>>{{1, 2}, {0}, {0}, {}}) {
    axis.neighbors.items.insert(axis.neighbors.items.end(), row.begin(), row.end());
    axis.neighbors.close_row();
    axis.forming_points.items.insert(axis.forming_points.items.end(), {0, 1});
    axis.forming_points.close_row();
  }
  axis.face_points = {{0, 1}};
  axis.faces.items = {0, 1, 2};
  axis.faces.close_row();
  return axis;
}

// Breadth-first, with leaves on every level but the root's; radii and bounds differ from node to node.
inline SphereTree random_tree(std::uint64_t seed, Index depth) {
  SphereTree tree;
  Random random(seed, 0);
  const auto add = [&](Index parent, Index level) {
    SphereNode node;
    node.sphere.center = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    node.sphere.radius = random.uniform(0.1, 0.5);
    node.parent = parent;
    node.level = level;
    node.distance_bound = random.uniform();
    node.inaccuracy = random.uniform();
    tree.nodes.push_back(node);
  };
  add(kNone, 0);
  for (Index i = 0; i < tree.nodes.size(); ++i) {
    const Index level = tree.nodes[i].level;
    if (level == depth || (i > 1 && random.below(3) == 0)) continue;
    tree.nodes[i].first_child = static_cast<Index>(tree.nodes.size());
    tree.nodes[i].child_count = static_cast<Index>(1 + random.below(4));
    for (Index child = 0; child < tree.nodes[i].child_count; ++child) add(i, level + 1);
  }
  return tree;
}

}  // namespace orchard::test
