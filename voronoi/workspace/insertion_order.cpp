#include "workspace/insertion_order.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "orchard/geometry/random.h"
#include "predicates/vectors.h"
#include "workspace/large_pages.h"

namespace orchard::detail {
namespace {

constexpr unsigned kBits = 12;  // of each coordinate: 4096 steps across the box
constexpr unsigned kCurveBits = 3 * kBits;
constexpr unsigned kRoundShift = 3;  // each round contains about 7/8 of the points that are not in earlier ones
constexpr unsigned kMaxRound = 15;
constexpr std::size_t kMinRound = 64;
constexpr std::size_t kCrowded = 16;  // points of one round in one cell above which they are ordered by a finer grid
constexpr std::size_t kBatch = 1u << 13;  // points of one task of a thread
constexpr int kFinest = 4;                // the depth of nested grids; the last one distinguishes all doubles

// Returns the position of a cell of the 2^kBits grid on a Hilbert curve, by Skilling's transform (2004). It has no
// branches, because the bits cannot be predicted.
std::uint64_t hilbert(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t bit = 1u << (kBits - 1); bit > 1; bit >>= 1) {
    const std::uint32_t low = bit - 1;
    for (std::uint32_t& coordinate : x) {
      // If the bit is set, the low bits of the first coordinate are inverted; otherwise they are swapped with those of
      // this coordinate.
      const std::uint32_t set = 0u - std::uint32_t{(coordinate & bit) != 0};
      const std::uint32_t swap = (x[0] ^ coordinate) & low & ~set;
      x[0] ^= swap | (low & set);
      coordinate ^= swap;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t flip = 0;
  for (std::uint32_t bit = 1u << (kBits - 1); bit > 1; bit >>= 1)
    flip ^= (bit - 1) & (0u - std::uint32_t{(x[2] & bit) != 0});
  std::uint64_t position = 0;
  for (unsigned bit = kBits; bit-- > 0;)
    for (const std::uint32_t coordinate : x) position = (position << 1) | (((coordinate ^ flip) >> bit) & 1u);
  return position;
}

// The same for eight cells at once, stored by coordinate, then by cell.
constexpr std::size_t kEight = 8;
using EightCells = std::array<std::array<std::uint32_t, kEight>, 3>;

#ifdef ORCHARD_FOUR_LANES
[[gnu::target("avx2")]] std::array<std::uint64_t, kEight> eight_hilberts(const EightCells& cells) {
  using Lanes [[gnu::vector_size(4 * kEight)]] = std::uint32_t;
  Lanes x[3];
  static_assert(sizeof x == sizeof cells);
  std::memcpy(x, cells.data(), sizeof x);
  for (std::uint32_t bit = 1u << (kBits - 1); bit > 1; bit >>= 1) {
    const std::uint32_t low = bit - 1;
    for (Lanes& coordinate : x) {
      const auto set = reinterpret_cast<Lanes>((coordinate & bit) != 0);
      const Lanes swap = (x[0] ^ coordinate) & low & ~set;
      x[0] ^= swap | (low & set);
      coordinate ^= swap;
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  Lanes flip = x[0] ^ x[0];
  for (std::uint32_t bit = 1u << (kBits - 1); bit > 1; bit >>= 1)
    flip ^= (bit - 1) & reinterpret_cast<Lanes>((x[2] & bit) != 0);
  // the upper and the lower halves of the bits
  Lanes halves[2] = {flip ^ flip, flip ^ flip};
  for (unsigned bit = kBits; bit-- > 0;)
    for (const Lanes& coordinate : x) {
      Lanes& half = halves[bit < kBits / 2];
      half = (half << 1) | (((coordinate ^ flip) >> bit) & 1u);
    }
  std::array<std::uint64_t, kEight> positions;
  for (std::size_t i = 0; i < kEight; ++i)
    positions[i] = std::uint64_t{halves[0][i]} << (kCurveBits / 2) | halves[1][i];
  return positions;
}
const bool kEightLanes = __builtin_cpu_supports("avx2");
#else
std::array<std::uint64_t, kEight> eight_hilberts(const EightCells&) { return {}; }
constexpr bool kEightLanes = false;
#endif

std::array<std::uint64_t, kEight> hilberts(const EightCells& cells) {
  if (kEightLanes) return eight_hilberts(cells);
  std::array<std::uint64_t, kEight> positions;
  for (std::size_t i = 0; i < kEight; ++i) positions[i] = hilbert({cells[0][i], cells[1][i], cells[2][i]});
  return positions;
}

std::array<std::uint32_t, 3> cell_of(const Point& p, const Box& box, double side) {
  const double steps = side > 0 ? ((1u << kBits) - 1) / side : 0;
  const Vector cell = (p - box.min()) * steps;
  return {static_cast<std::uint32_t>(cell.x()), static_cast<std::uint32_t>(cell.y()),
          static_cast<std::uint32_t>(cell.z())};
}

struct Item {
  std::uint64_t key;
  Index point;
};

// A stable sort by the low bits of the key.
void radix_sort(std::vector<Item>& items, unsigned bits) {
  constexpr unsigned kDigit = 10;
  std::vector<Item> other;
  reserve_large(other, items.size());
  other.resize(items.size());
  std::vector<std::size_t> start(1u << kDigit);
  for (unsigned shift = 0; shift < bits; shift += kDigit) {
    std::fill(start.begin(), start.end(), 0);
    const auto digit = [shift](const Item& item) { return (item.key >> shift) & ((1u << kDigit) - 1); };
    for (const Item& item : items) ++start[digit(item)];
    std::size_t sum = 0;
    for (std::size_t& s : start) sum += std::exchange(s, sum);
    for (const Item& item : items) other[start[digit(item)]++] = item;
    items.swap(other);
  }
}

// Orders points that crowd together: those of one round in one cell follow a curve of their own, in their own box.
void order_crowds(std::span<Item> items, std::span<const Point> points, int finer) {
  for (std::size_t begin = 0, end = 0; begin < items.size(); begin = end) {
    for (end = begin + 1; end < items.size() && items[end].key == items[begin].key; ++end) continue;
    if (end - begin <= kCrowded) continue;
    const std::span<Item> crowd = items.subspan(begin, end - begin);
    Box box;
    for (const Item& item : crowd) box.extend(points[item.point]);
    const double side = box.sizes().maxCoeff();
    if (side == 0) continue;
    for (Item& item : crowd) item.key = hilbert(cell_of(points[item.point], box, side));
    std::stable_sort(crowd.begin(), crowd.end(), [](const Item& a, const Item& b) { return a.key < b.key; });
    if (finer > 1) order_crowds(crowd, points, finer - 1);
  }
}

}  // namespace

std::vector<Index> insertion_order(std::span<const Point> points, const Box& box) {
  const double side = box.isEmpty() ? 0 : box.sizes().maxCoeff();
  unsigned rounds = 0;
  for (std::size_t left = points.size(); left > kMinRound && rounds < kMaxRound; left >>= kRoundShift) ++rounds;

  std::vector<Item> items;
  reserve_large(items, points.size());
  items.resize(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, items.size(), kBatch), [&](const auto& range) {
    EightCells cells{};
    std::array<std::uint64_t, kEight> positions{};
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      const std::size_t lane = (i - range.begin()) % kEight;
      if (lane == 0) {
        for (std::size_t k = 0; k < std::min(kEight, range.end() - i); ++k) {
          const std::array<std::uint32_t, 3> cell = cell_of(points[i + k], box, side);
          for (unsigned axis = 0; axis < 3; ++axis) cells[axis][k] = cell[axis];
        }
        positions = hilberts(cells);
      }
      // A point is in the last round except for one time in eight, in which it is in an earlier one, by the same rule.
      std::uint64_t bits = Random(0, 0x40b3u, i).bits();
      unsigned round = rounds;
      for (; round > 0 && (bits & ((1u << kRoundShift) - 1)) == 0; bits >>= kRoundShift) --round;
      items[i].key = round * (std::uint64_t{1} << kCurveBits) | positions[lane];
      items[i].point = static_cast<Index>(i);
    }
  });
  radix_sort(items, kCurveBits + 4);
  order_crowds(items, points, kFinest);
  std::vector<Index> order(points.size());
  std::transform(items.begin(), items.end(), order.begin(), [](const Item& item) { return item.point; });
  return order;
}

}  // namespace orchard::detail
