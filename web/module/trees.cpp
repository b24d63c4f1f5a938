#include <vector>

#include "c/orchard_c.h"
#include "module.h"

using namespace orchard::web;
namespace rt = orchard::runtime;

namespace {

// The numbers that src/ hands over and gets back lie here, if there are at most so many.
double exchange[1024];

rt::Children children_of(const rt::TreeView& tree, std::uint32_t link) { return rt::children_of(tree.branching, link); }

// Calls visit(block, lane) for the spheres of a level: its nodes, and the leaves that end above it.
template <typename Visit>
void visit_level(const rt::TreeView& tree, std::uint32_t level, const Visit& visit) {
  struct Node {
    std::uint32_t block, lane, level;
  };
  std::vector<Node> waiting{{0, 0, 0}};
  while (!waiting.empty()) {
    const Node node = waiting.back();
    waiting.pop_back();
    const rt::SiblingBlock& block = tree.blocks[node.block];
    const std::uint32_t link = block.link[node.lane];
    if (node.level == level || (link & rt::kLeafBit) != 0) {
      visit(block, node.lane);
      continue;
    }
    const rt::Children children = children_of(tree, link);
    for (std::uint32_t i = children.count; i-- > 0;)
      waiting.push_back({children.first + i / rt::kBlockWidth, i % rt::kBlockWidth, node.level + 1});
  }
}

}  // namespace

ORCHARD_EXPORT(exchange) double* web_exchange() { return exchange; }
ORCHARD_EXPORT(exchange_size) std::size_t web_exchange_size() { return std::size(exchange); }
ORCHARD_EXPORT(allocate) void* web_allocate(std::size_t bytes) {
  return std::aligned_alloc(32, (bytes + 31) / 32 * 32);
}
ORCHARD_EXPORT(release) void web_release(void* block) { std::free(block); }
ORCHARD_EXPORT(version) const char* web_version() { return orchard_version(); }

// Null if it fails; *error is a sentence then.
ORCHARD_EXPORT(tree_load) orchard_tree* web_tree_load(const void* bytes, std::size_t size, const char** error) {
  return orchard_tree_load(bytes, size, error);
}
ORCHARD_EXPORT(tree_close) void web_tree_close(orchard_tree* tree) { orchard_tree_close(tree); }

// Radius, vertex error, branching, depth, and the numbers of nodes, vertices and triangles.
ORCHARD_EXPORT(tree_facts) void web_tree_facts(const orchard_tree* tree, double* out) {
  const rt::TreeView& view = tree->view();
  *out++ = view.bounding_radius;
  *out++ = view.vertex_error;
  *out++ = view.branching;
  *out++ = view.depth;
  *out++ = view.node_count;
  *out++ = static_cast<double>(view.vertices.size());
  *out++ = static_cast<double>(view.triangles.size());
}

// How many spheres a level has; unless `out` is null, centre, radius and error of each.
ORCHARD_EXPORT(tree_spheres) std::size_t web_tree_spheres(const orchard_tree* tree, std::uint32_t level, double* out) {
  std::size_t count = 0;
  visit_level(tree->view(), level, [&](const rt::SiblingBlock& block, std::uint32_t lane) {
    ++count;
    if (out == nullptr) return;
    *out++ = tree->view().origin[0] + double{block.x[lane]};
    *out++ = tree->view().origin[1] + double{block.y[lane]};
    *out++ = tree->view().origin[2] + double{block.z[lane]};
    *out++ = block.radius[lane];
    *out++ = block.error[lane];
  });
  return count;
}

ORCHARD_EXPORT(tree_mesh) void web_tree_mesh(const orchard_tree* tree, double* vertices, std::uint32_t* triangles) {
  for (const auto& vertex : tree->view().vertices)
    for (std::size_t i = 0; i < 3; ++i) *vertices++ = tree->view().origin[i] + double{vertex[i]};
  for (const auto& triangle : tree->view().triangles) triangles = std::copy_n(triangle.begin(), 3, triangles);
}

ORCHARD_EXPORT(point_tree) orchard_tree* web_point_tree(const double* point) { return orchard_point_tree(point); }
ORCHARD_EXPORT(segment_tree) orchard_tree* web_segment_tree(const double* ends) {
  return orchard_segment_tree(ends, ends + 3);
}
ORCHARD_EXPORT(box_tree) orchard_tree* web_box_tree(const double* half) { return orchard_box_tree(half); }
ORCHARD_EXPORT(hull_tree) orchard_tree* web_hull_tree(const double* points, std::size_t count) {
  return orchard_hull_tree(points, count);
}

// Poses. 1 and the pose, or 0.
ORCHARD_EXPORT(pose_from_quaternion)
int web_pose_from_quaternion(const double* wxyz, const double* translation, double* pose) {
  return orchard_pose_from_quaternion(wxyz, translation, reinterpret_cast<orchard_pose*>(pose));
}
ORCHARD_EXPORT(make_rigid) int web_make_rigid(double* pose) {
  return orchard_make_rigid(reinterpret_cast<orchard_pose*>(pose));
}
ORCHARD_EXPORT(is_rigid) int web_is_rigid(const double* pose) { return orchard_is_rigid(&pose_at(pose)); }
