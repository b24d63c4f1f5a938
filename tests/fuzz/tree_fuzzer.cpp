// Any bytes at all: load() says what is wrong with them or gives a tree on which queries stay in bounds. The bytes are
// tried as they are and with their size and checksum put right, so that the fuzzer gets past these two.
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "orchard/runtime/distance.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/shape_query.h"
#include "orchard/runtime/tree_file.h"
#include "support/query_of_trees.h"

namespace {

using namespace orchard::runtime;

void require(bool condition) {
  if (!condition) std::abort();
}

void query(const TreeView& tree) {
  test::OwnNarrowPhase pair(tree, tree);
  test::OwnDistanceQuery distance(tree, tree);
  const double size = tree.bounding_radius;
  const std::array<Pose, 3> poses = {Pose{}, Pose{.translation = {size, 0, 0}},
                                     *pose_from_quaternion({1, 2, 3, 4}, {0, 0.5 * size, 0})};
  for (const Pose& pose : poses) {
    pair.start(Pose{}, pose);
    for (int step = 0; step < 8 && !pair.finished(); ++step) pair.refine({.work = 2000});
    pair.refine_exactly({.work = 2000});
    distance.start(Pose{}, pose);
    for (int step = 0; step < 4 && !distance.finished(); ++step) distance.refine({.work = 500});
    require(distance.lower() <= distance.upper());
    require(pair.separation_bound() >= 0 && pair.lower_bound() >= 0);
    pair.contact();
  }
  const std::array<double, 3> near = tree.origin, far = {tree.origin[0] + size, tree.origin[1], tree.origin[2] - size};
  nearest_point_to_segment(tree, Pose{}, near, far);
  cast_ray(tree, Pose{}, far, {-1, 0.1, 1});
  cast_ray(RayIndex(tree), Pose{}, far, {-1, 0.1, 1});
  contains(tree, Pose{}, near);
}

// The bytes where they are, with nothing behind them that could be read unnoticed.
void use_in_place(std::span<const std::byte> bytes, bool loads) {
  void* const copy = std::aligned_alloc(64, bytes.size());
  require(copy != nullptr);
  std::memcpy(copy, bytes.data(), bytes.size());
  TreeView tree;
  const LoadStatus status = view({static_cast<const std::byte*>(copy), bytes.size()}, tree);
  require((status == LoadStatus::ok) == loads);
  if (loads) query(tree);
  std::free(copy);
}

void try_to_load(std::span<const std::byte> bytes) {
  PackedSphereTree tree;
  if (load(bytes, tree) != LoadStatus::ok) {
    require(tree.blocks.empty());
    return;
  }
  require(structure_fault(tree) == nullptr);
  PackedSphereTree again;
  require(load(serialize(tree), again) == LoadStatus::ok && serialize(again) == serialize(tree));
  query(tree);
  use_in_place(bytes, true);
}

void put_right(std::vector<std::byte>& file) {
  const std::uint64_t size = file.size();
  std::memcpy(file.data() + 24, &size, sizeof size);
  std::uint64_t h = 0x6f72636861726421;
  for (std::size_t at = 0; at < file.size(); at += 8) {
    if (at == 16) continue;
    std::uint64_t word;
    std::memcpy(&word, file.data() + at, sizeof word);
    h = (h ^ word) * 0x9e3779b97f4a7c15;
    h ^= h >> 32;
  }
  std::memcpy(file.data() + 16, &h, sizeof h);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  try_to_load({bytes, size});
  std::vector<std::byte> file(bytes, bytes + size);
  file.resize((size + 63) / 64 * 64);
  if (file.size() >= 64) put_right(file), try_to_load(file);
  return 0;
}
