// One file: reading and writing share the table of fields and sections, and every check that reading makes is the other
// side of a line that writes.
#include "orchard/runtime/tree_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

#include "execution/guarded.h"

namespace orchard::runtime {
namespace {

constexpr std::array<unsigned char, 8> kMagic = {0x89, 'O', 'R', 'C', 'H', '\r', '\n', 0x1a};
constexpr std::uint32_t kVersion = 4;
constexpr std::size_t kAlignment = 64;
constexpr std::size_t kSections = 7;
constexpr std::size_t kHeaderSize = 320;
constexpr std::size_t kPreambleSize = 32;  // magic to file size: enough to tell how long the file must be

// Where the fields are: docs/reference/formats.md.
enum Field : std::size_t {
  kVersionAt = 8,
  kHeaderSizeAt = 12,
  kChecksumAt = 16,
  kFileSizeAt = 24,
  kBranchingAt = 32,
  kDepthAt = 36,
  kNodeCountAt = 40,
  kSectionCountAt = 44,
  kOriginAt = 48,
  kBoundingRadiusAt = 72,
  kVertexErrorAt = 80,
  kTriangleTreeDepthAt = 88,
  kReservedAt = 92,
  kTableAt = 96,
  kTableStride = 24,
};
constexpr std::size_t kTableEnd = kTableAt + kSections * kTableStride;

constexpr std::uint64_t aligned(std::uint64_t size) noexcept { return (size + kAlignment - 1) & ~(kAlignment - 1); }

template <typename T>
T from_little_endian(T value) noexcept {
  if constexpr (std::endian::native == std::endian::big) {
    auto bytes = std::bit_cast<std::array<std::byte, sizeof(T)>>(value);
    std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }
  return value;
}

template <typename T>
T get(const std::byte* file, std::size_t offset) noexcept {
  T value;
  std::memcpy(&value, file + offset, sizeof value);
  return from_little_endian(value);
}

template <typename T>
void put(std::byte* file, std::size_t offset, T value) noexcept {
  value = from_little_endian(value);  // its own inverse
  std::memcpy(file + offset, &value, sizeof value);
}

// Every element of every section is made of 32-bit words, so one copy serves them all.
void copy_words(std::byte* to, const std::byte* from, std::size_t bytes) noexcept {
  if (bytes == 0) return;
  std::memcpy(to, from, bytes);
  if constexpr (std::endian::native == std::endian::big) {
    for (std::size_t i = 0; i < bytes; i += 4) put(to, i, get<std::uint32_t>(from, i));
  }
}

// A step is a bijection of the state for a given word and of the word for a given state: a change within one
// eight-byte word is always noticed, any other with probability 1 - 2^-64. `size` is a multiple of 8.
std::uint64_t checksum(const std::byte* file, std::size_t size) noexcept {
  std::uint64_t state = 0x6f72636861726421u;
  for (std::size_t i = 0; i < size; i += 8) {
    if (i == kChecksumAt) continue;
    state = (state ^ get<std::uint64_t>(file, i)) * 0x9e3779b97f4a7c15u;
    state ^= state >> 32;
  }
  return state;
}

// In the order of the table; every element is made of 32-bit words.
constexpr std::array<std::uint32_t, kSections> kElementSizes = {sizeof(SiblingBlock),  12, 12, 4, sizeof(ObbNodeBlock),
                                                                sizeof(TriangleBlock), 4};

// Calls visit(section number from 0, array) for every section of a tree or view.
template <typename Tree, typename Visit>
void each_section(Tree& tree, Visit&& visit) {
  visit(0, tree.blocks), visit(1, tree.vertices), visit(2, tree.triangles);
  visit(3, tree.leaf_triangles), visit(4, tree.obb_nodes), visit(5, tree.triangle_blocks), visit(6, tree.supports);
}

template <typename Tree>
void get_header(const std::byte* file, Tree& tree) noexcept {
  tree.branching = get<std::uint32_t>(file, kBranchingAt);
  tree.depth = get<std::uint32_t>(file, kDepthAt);
  tree.node_count = get<std::uint32_t>(file, kNodeCountAt);
  tree.triangle_tree_depth = get<std::uint32_t>(file, kTriangleTreeDepthAt);
  for (std::size_t i = 0; i < 3; ++i) tree.origin[i] = get<double>(file, kOriginAt + 8 * i);
  tree.bounding_radius = get<double>(file, kBoundingRadiusAt);
  tree.vertex_error = get<double>(file, kVertexErrorAt);
}

LoadStatus check_preamble(const std::byte* file, std::size_t size) noexcept {
  if (size == 0) return LoadStatus::truncated;  // and `file` may be null
  if (std::memcmp(file, kMagic.data(), std::min(size, kMagic.size())) != 0) return LoadStatus::bad_magic;
  if (size < kPreambleSize) return LoadStatus::truncated;
  const auto version = get<std::uint32_t>(file, kVersionAt);
  if (version != kVersion) return version > kVersion ? LoadStatus::version_newer : LoadStatus::version_older;
  return LoadStatus::ok;
}

LoadStatus check_file(std::span<const std::byte> file) noexcept {
  if (const LoadStatus status = check_preamble(file.data(), file.size()); status != LoadStatus::ok) return status;
  const std::byte* const bytes = file.data();
  const auto file_size = get<std::uint64_t>(bytes, kFileSizeAt);
  if (file_size > file.size() || file.size() < kHeaderSize) return LoadStatus::truncated;
  if (file_size < file.size() || file_size % kAlignment != 0) return LoadStatus::invalid_structure;
  if (checksum(bytes, file.size()) != get<std::uint64_t>(bytes, kChecksumAt)) return LoadStatus::checksum_mismatch;
  if (get<std::uint32_t>(bytes, kHeaderSizeAt) != kHeaderSize) return LoadStatus::invalid_structure;
  if (get<std::uint32_t>(bytes, kSectionCountAt) != kSections) return LoadStatus::invalid_structure;
  return LoadStatus::ok;
}

bool all_zero(std::span<const std::byte> file, std::uint64_t begin, std::uint64_t end) noexcept {
  const auto bytes = file.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
  return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

// The sections must follow one another in order without gaps and end with the file, and what belongs to none is zero:
// one form for one tree, and a sum of sizes that no crafted table can push beyond the file.
LoadStatus check_table(std::span<const std::byte> file, std::array<std::uint64_t, kSections>& counts) noexcept {
  std::uint64_t end = kHeaderSize;
  for (std::size_t i = 0; i < kSections; ++i) {
    const std::size_t at = kTableAt + i * kTableStride;
    const std::uint32_t size = kElementSizes[i];
    if (get<std::uint32_t>(file.data(), at) != i + 1 || get<std::uint32_t>(file.data(), at + 4) != size ||
        get<std::uint64_t>(file.data(), at + 8) != end) {
      return LoadStatus::invalid_structure;
    }
    counts[i] = get<std::uint64_t>(file.data(), at + 16);
    if (counts[i] > (file.size() - end) / size) return LoadStatus::invalid_structure;
    const std::uint64_t used = end + counts[i] * size;
    end = aligned(used);
    if (end > file.size() || !all_zero(file, used, end)) return LoadStatus::invalid_structure;
  }
  if (!all_zero(file, kReservedAt, kTableAt) || !all_zero(file, kTableEnd, kHeaderSize)) {
    return LoadStatus::invalid_structure;
  }
  return end == file.size() ? LoadStatus::ok : LoadStatus::invalid_structure;
}

struct Close {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};

// Appends what the stream has, up to `size` bytes in all, in pieces: a header that promises more than there is costs
// at most one piece of memory.
LoadStatus read_up_to(std::FILE* stream, std::uint64_t size, std::vector<std::byte>& bytes) {
  constexpr std::uint64_t piece = std::uint64_t{1} << 20;
  while (bytes.size() < size) {
    const std::size_t have = bytes.size();
    const auto wanted = static_cast<std::size_t>(std::min(piece, size - have));
    bytes.resize(have + wanted);
    const std::size_t got = std::fread(bytes.data() + have, 1, wanted, stream);
    bytes.resize(have + got);
    if (got < wanted) return std::ferror(stream) ? LoadStatus::read_failed : LoadStatus::ok;
  }
  return LoadStatus::ok;
}

template <typename Work>
LoadStatus unless_out_of_memory(const Work& work) noexcept {
  return detail::guarded(work, [] { return LoadStatus::out_of_memory; });
}

}  // namespace

const char* message(LoadStatus status) noexcept {
  constexpr std::array kMessages = {
      "the tree was loaded",
      "the file cannot be opened",
      "the file could not be read to its end",
      "the file is shorter than its header says: copy or build it again",
      "this is not an .orchard file",
      "the file was written by a newer version of orchard",
      "the file was written by an older version of orchard: build it again",
      "the file was altered after it was written: its checksum does not match",
      "the file's contents are not a valid sphere-tree",
      "there is not enough memory for the tree",
      "the file cannot be used in place here: load it instead",
  };
  static_assert(kMessages.size() == static_cast<std::size_t>(LoadStatus::cannot_map) + 1);
  const auto index = static_cast<std::size_t>(status);
  return index < kMessages.size() ? kMessages[index] : "unknown status";
}

std::vector<std::byte> serialize(const TreeView& tree) {
  std::array<std::uint64_t, kSections> bytes{}, counts{};
  std::array<const std::byte*, kSections> contents{};
  std::uint64_t size = kHeaderSize;
  each_section(tree, [&](std::size_t i, const auto& elements) {
    static_assert(sizeof(elements[0]) % 4 == 0);
    counts[i] = elements.size();
    bytes[i] = elements.size() * sizeof(elements[0]);
    contents[i] = reinterpret_cast<const std::byte*>(elements.data());
    size = aligned(size + bytes[i]);
  });
  std::vector<std::byte> file(size);

  std::memcpy(file.data(), kMagic.data(), kMagic.size());
  put(file.data(), kVersionAt, kVersion);
  put(file.data(), kHeaderSizeAt, static_cast<std::uint32_t>(kHeaderSize));
  put(file.data(), kFileSizeAt, size);
  put(file.data(), kBranchingAt, tree.branching);
  put(file.data(), kDepthAt, tree.depth);
  put(file.data(), kNodeCountAt, tree.node_count);
  put(file.data(), kSectionCountAt, static_cast<std::uint32_t>(kSections));
  for (std::size_t i = 0; i < 3; ++i) put(file.data(), kOriginAt + 8 * i, tree.origin[i]);
  put(file.data(), kBoundingRadiusAt, tree.bounding_radius);
  put(file.data(), kVertexErrorAt, tree.vertex_error);
  put(file.data(), kTriangleTreeDepthAt, tree.triangle_tree_depth);

  std::uint64_t offset = kHeaderSize;
  for (std::size_t i = 0; i < kSections; ++i) {
    const std::size_t at = kTableAt + i * kTableStride;
    put(file.data(), at, static_cast<std::uint32_t>(i + 1));
    put(file.data(), at + 4, kElementSizes[i]);
    put(file.data(), at + 8, offset);
    put(file.data(), at + 16, counts[i]);
    copy_words(file.data() + offset, contents[i], bytes[i]);
    offset = aligned(offset + bytes[i]);
  }
  put(file.data(), kChecksumAt, checksum(file.data(), file.size()));
  return file;
}

LoadStatus load(std::span<const std::byte> file, PackedSphereTree& out) noexcept {
  if (const LoadStatus status = check_file(file); status != LoadStatus::ok) return status;
  std::array<std::uint64_t, kSections> counts{};
  if (const LoadStatus status = check_table(file, counts); status != LoadStatus::ok) return status;
  return unless_out_of_memory([&] {
    PackedSphereTree tree;
    std::uint64_t offset = kHeaderSize;
    each_section(tree, [&](std::size_t i, auto& elements) {
      elements.resize(counts[i]);
      const std::uint64_t bytes = counts[i] * kElementSizes[i];
      copy_words(reinterpret_cast<std::byte*>(elements.data()), file.data() + offset, bytes);
      offset = aligned(offset + bytes);
    });
    get_header(file.data(), tree);
    if (structure_fault(tree) != nullptr) return LoadStatus::invalid_structure;
    out = std::move(tree);
    return LoadStatus::ok;
  });
}

LoadStatus view(std::span<const std::byte> file, TreeView& out) noexcept {
  if (const LoadStatus status = check_file(file); status != LoadStatus::ok) return status;
  std::array<std::uint64_t, kSections> counts{};
  if (const LoadStatus status = check_table(file, counts); status != LoadStatus::ok) return status;
  if (std::endian::native != std::endian::little ||
      reinterpret_cast<std::uintptr_t>(file.data()) % kViewAlignment != 0) {
    return LoadStatus::cannot_map;
  }
  TreeView tree;
  std::uint64_t offset = kHeaderSize;
  each_section(tree, [&](std::size_t i, auto& elements) {
    using Element = typename std::remove_reference_t<decltype(elements)>::element_type;
    // The bytes hold exactly such objects: implicit-lifetime types of 32-bit words, written by serialize().
    elements = {reinterpret_cast<Element*>(file.data() + offset), static_cast<std::size_t>(counts[i])};
    offset = aligned(offset + counts[i] * kElementSizes[i]);
  });
  get_header(file.data(), tree);
  if (structure_fault(tree) != nullptr) return LoadStatus::invalid_structure;
  out = tree;
  return LoadStatus::ok;
}

LoadStatus load_file(const char* path, PackedSphereTree& out) noexcept {
  const std::unique_ptr<std::FILE, Close> stream(std::fopen(path, "rb"));
  if (!stream) return LoadStatus::cannot_open;
  return unless_out_of_memory([&] {
    std::vector<std::byte> bytes;
    if (const LoadStatus status = read_up_to(stream.get(), kPreambleSize, bytes); status != LoadStatus::ok)
      return status;
    if (const LoadStatus status = check_preamble(bytes.data(), bytes.size()); status != LoadStatus::ok) return status;
    // One byte more than promised, so that a longer file is noticed.
    const auto promised = get<std::uint64_t>(bytes.data(), kFileSizeAt);
    const std::uint64_t wanted = promised < UINT64_MAX ? promised + 1 : promised;
    if (const LoadStatus status = read_up_to(stream.get(), wanted, bytes); status != LoadStatus::ok) return status;
    return load(bytes, out);
  });
}

}  // namespace orchard::runtime
