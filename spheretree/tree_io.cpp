#include "orchard/spheretree/tree_io.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "orchard/geometry/error.h"
#include "orchard/geometry/text_lines.h"

namespace orchard {
namespace {

// A complete tree has about branching^depth nodes. Beyond this limit, the text format is not suitable.
constexpr std::uint64_t kMaxNodes = 20'000'000;

std::uint64_t complete_size(std::uint64_t levels, std::uint64_t branching) {
  std::uint64_t total = 0, width = 1;
  for (std::uint64_t level = 0; level < levels; ++level) {
    total += width;
    if (total > kMaxNodes) return kMaxNodes + 1;
    width *= branching;
  }
  return total;
}

void append_node(std::string& text, const SphereNode* node) {
  char line[160];
  if (node == nullptr) {
    text += "0 0 0 -1 0\n";
    return;
  }
  const Sphere& s = node->sphere;
  const int length = std::snprintf(line, sizeof line, "%.17g %.17g %.17g %.17g 1\n", s.center.x(), s.center.y(),
                                   s.center.z(), s.radius);
  text.append(line, static_cast<std::size_t>(length));
}

// Reads the number of levels, which includes the root, and the branching.
std::array<Index, 2> read_header(TextLines& lines) {
  constexpr const char* kExpected = "\"levels branching\", two whole numbers,";
  if (!lines.next()) lines.fail("the file is empty; a .sph file starts with \"levels branching\"");
  const double levels = lines.real(kExpected), branching = lines.real(kExpected);
  const auto whole = [](double value, double max) { return value >= 1 && value <= max && value == std::floor(value); };
  if (!whole(levels, 64) || !whole(branching, 4096))
    lines.fail("\"levels branching\" must be two whole numbers, 1 to 64 and 1 to 4096");
  return {static_cast<Index>(levels), static_cast<Index>(branching)};
}

Sphere read_place(TextLines& lines) {
  constexpr const char* kExpected = "\"x y z radius\", four finite numbers,";
  const double x = lines.real(kExpected), y = lines.real(kExpected), z = lines.real(kExpected);
  return {Point(x, y, z), lines.real(kExpected)};
}

// Turns the used places of the complete tree, in breadth-first order, into the nodes of a compact one.
SphereTree compact(const std::vector<Sphere>& places, Index branching) {
  SphereTree tree;
  tree.branching = branching;
  std::vector<std::uint64_t> place_of{0};
  tree.nodes.push_back({.sphere = places[0]});
  for (Index i = 0; i < tree.nodes.size(); ++i) {
    const Index first = static_cast<Index>(tree.nodes.size());
    for (std::uint64_t k = 1; k <= branching; ++k) {
      const std::uint64_t child = place_of[i] * branching + k;
      if (child >= places.size() || places[child].radius <= 0) continue;
      tree.nodes.push_back({.sphere = places[child], .parent = i, .level = tree.nodes[i].level + 1});
      place_of.push_back(child);
    }
    tree.nodes[i].child_count = static_cast<Index>(tree.nodes.size()) - first;
    tree.nodes[i].first_child = tree.nodes[i].child_count > 0 ? first : kNone;
  }
  return tree;
}

}  // namespace

std::string to_sph(const SphereTree& tree) {
  const std::uint64_t levels = tree.depth() + 1, size = complete_size(levels, tree.branching);
  if (size > kMaxNodes)
    throw InputError("the .sph format stores unused nodes too, and this tree would need more than " +
                     std::to_string(kMaxNodes) + ": use fewer levels or children");
  std::vector<const SphereNode*> places(size, nullptr);
  std::vector<std::uint64_t> place_of(tree.nodes.size(), 0);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const SphereNode& node = tree.nodes[i];
    places[place_of[i]] = &node;
    for (Index k = 0; k < node.child_count; ++k) place_of[node.first_child + k] = place_of[i] * tree.branching + 1 + k;
  }
  std::string text = std::to_string(levels) + " " + std::to_string(tree.branching) + "\n";
  for (const SphereNode* node : places) append_node(text, node);
  return text;
}

SphereTree read_sph(const std::filesystem::path& file) {
  TextLines lines(file);
  const auto [levels, branching] = read_header(lines);
  const std::uint64_t size = complete_size(levels, branching);
  if (size > kMaxNodes) lines.fail("the file promises more than " + std::to_string(kMaxNodes) + " nodes");
  // Nodes missing at the end count as unused, so the memory depends on the length of the file and not on its header.
  std::vector<Sphere> places;
  while (places.size() < size && lines.next()) places.push_back(read_place(lines));
  if (places.empty() || places[0].radius <= 0) lines.fail("the first node, the root, must be in use");
  return compact(places, branching);
}

}  // namespace orchard
