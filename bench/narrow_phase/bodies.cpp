#include "bodies.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/tree_file.h"
#include "support.h"

namespace orchard::bench {

using namespace orchard::runtime;

namespace {

test::Mesh read_obj(const std::string& path) {
  test::Mesh mesh;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind, word;
    words >> kind;
    if (kind == "v") {
      auto& v = mesh.vertices.emplace_back();
      words >> v[0] >> v[1] >> v[2];
    } else if (kind == "f") {
      std::vector<std::uint32_t> corners;
      while (words >> word) corners.push_back(static_cast<std::uint32_t>(std::stoul(word)) - 1);
      for (std::size_t i = 2; i < corners.size(); ++i) {
        mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
      }
    }
  }
  return mesh;
}

bool touches(NarrowPhase& pair, const Pose& a, const Pose& b) {
  pair.start(a, b);
  return pair.refine_exactly() == Answer::yes;
}

std::array<double, 3> unit_or_zero(std::array<double, 3> v) {
  const double size = std::hypot(v[0], v[1], v[2]);
  for (double& x : v) x = size > 0 ? x / size : 0;
  return v;
}

}  // namespace

void ResponseSum::add(const std::array<double, 3>& normal, double depth) {
  for (std::size_t i = 0; i < 3; ++i) sum_.normal[i] += normal[i];
  if (sum_.count++ == 0 || depth > sum_.depth) sum_.depth = depth, sum_.deepest_normal = normal;
}

ContactResponse ResponseSum::result() const {
  ContactResponse result = sum_;
  result.normal = unit_or_zero(sum_.normal);
  result.deepest_normal = unit_or_zero(sum_.deepest_normal);
  return result;
}

PackedSphereTree read_body(const std::string& path) {
  PackedSphereTree tree;
  if (path.ends_with(".orchard")) {
    if (const auto status = load_file(path.c_str(), tree); status != LoadStatus::ok) {
      std::fprintf(stderr, "%s: %s\n", path.c_str(), message(status));
      std::exit(2);
    }
    return tree;
  }
  const test::Mesh mesh = read_obj(path);
  if (mesh.triangles.empty()) {
    std::fprintf(stderr, "%s: there are no triangles\n", path.c_str());
    std::exit(2);
  }
  return test::build_tree(mesh, {.leaf_triangles = 4, .bounds = false});
}

std::vector<Query> approaches(const TreeView& tree, std::size_t count, std::uint64_t first_seed) {
  const SiblingBlock& root = tree.blocks[0];
  const double r = double{root.radius[0]};
  const test::Vec center = {tree.origin[0] + root.x[0], tree.origin[1] + root.y[0], tree.origin[2] + root.z[0]};
  const PreparedTree body(tree);
  NarrowPhase pair(body, body, 1);
  std::vector<Query> result;
  for (std::uint64_t seed = first_seed; result.size() < kClasses * count; ++seed) {
    test::Draw draw(seed);
    const auto centered = [&](Pose pose, double distance, const test::Vec& way) {
      const auto moved = rotate(pose, center);
      for (std::size_t i = 0; i < 3; ++i) pose.translation[i] = distance * way[i] - moved[i];
      return pose;
    };
    const test::Vec way = draw.direction();
    const Pose a = centered(draw.pose(0), 0, way), turned = draw.pose(0);
    double near = 0, far = 2 * r;
    if (!touches(pair, a, centered(turned, near, way))) continue;
    for (double d = far; d > 0; d -= 0.01 * r) {
      if (touches(pair, a, centered(turned, d, way))) {
        near = d;
        break;
      }
      far = d;
    }
    while (far - near > 1e-9 * r) {
      const double middle = (near + far) / 2;
      (touches(pair, a, centered(turned, middle, way)) ? near : far) = middle;
    }
    const double at[] = {2 * r, (2 * r + far) / 2, far + 0.01 * r, far + 0.001 * r, near - 0.001 * r, near - 0.01 * r};
    for (int c = 0; c < kClasses; ++c) result.push_back({a, centered(turned, at[c], way), c});
  }
  return result;
}

}  // namespace orchard::bench
