#include "orchard/spheretree/tree_io.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>

#include "orchard/geometry/error.h"

namespace orchard {
namespace {

// A complete tree grows as branching^depth: beyond this many nodes the text format is the wrong one.
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

struct SphLine {
  double values[4];
};

// The numbers of one line, or nothing if there are fewer than `count`.
std::optional<SphLine> parse_numbers(const std::string& line, int count) {
  SphLine parsed{};
  const char* at = line.data();
  const char* const end = at + line.size();
  for (int i = 0; i < count; ++i) {
    while (at != end && (*at == ' ' || *at == '\t' || *at == '+')) ++at;
    const auto [next, error] = std::from_chars(at, end, parsed.values[i]);
    if (error != std::errc() || !std::isfinite(parsed.values[i])) return std::nullopt;
    at = next;
  }
  return parsed;
}

[[noreturn]] void fail(const std::filesystem::path& file, std::size_t line, const std::string& what) {
  throw InputError(file.string() + ":" + std::to_string(line) + ": " + what);
}

bool next_line(std::istream& in, std::string& line, std::size_t& number) {
  while (std::getline(in, line)) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find_first_not_of(" \t") != std::string::npos) return true;
  }
  return false;
}

// Places of used nodes in the complete tree, breadth-first, become the nodes of a compact one.
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
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file)) throw InputError(file.string() + ": cannot be read");
  std::string line;
  std::size_t number = 0;
  if (!next_line(in, line, number)) fail(file, 1, "is empty; a .sph file starts with \"levels branching\"");
  const auto header = parse_numbers(line, 2);
  const auto whole = [](double value, double max) { return value >= 1 && value <= max && value == std::floor(value); };
  if (!header || !whole(header->values[0], 64) || !whole(header->values[1], 4096))
    fail(file, number, "expected \"levels branching\", two whole numbers");
  const auto levels = static_cast<std::uint64_t>(header->values[0]);
  const auto branching = static_cast<Index>(header->values[1]);
  const std::uint64_t size = complete_size(levels, branching);
  if (size > kMaxNodes) fail(file, number, "promises more than " + std::to_string(kMaxNodes) + " nodes");
  // Missing nodes at the end count as unused, so memory follows the file, not the header.
  std::vector<Sphere> places;
  while (places.size() < size && next_line(in, line, number)) {
    const auto numbers = parse_numbers(line, 4);
    if (!numbers) fail(file, number, "expected \"x y z radius\", four finite numbers");
    const double* v = numbers->values;
    places.push_back({Point(v[0], v[1], v[2]), v[3]});
  }
  if (places.empty() || places[0].radius <= 0) fail(file, number, "the first node, the root, must be in use");
  return compact(places, branching);
}

}  // namespace orchard
