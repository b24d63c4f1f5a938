// Reading and writing share the table of fields and sections. For every check when reading there is a line that writes.
#include "orchard/runtime/tree_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
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

// The header of a file. docs/reference/formats.md describes it.
struct Header {
  struct Preamble {  // enough to find out how long the file must be
    std::array<unsigned char, 8> magic;
    std::uint32_t version, header_size;
    std::uint64_t checksum, file_size;
  } preamble;
  std::uint32_t branching, depth, node_count, section_count;
  std::array<double, 3> origin;
  double bounding_radius, vertex_error;
  std::uint32_t triangle_tree_depth, reserved;
  struct Section {
    std::uint32_t number, element_size;
    std::uint64_t offset, count;
    std::uint64_t end() const noexcept { return offset + count * element_size; }
  };
  std::array<Section, kSections> sections;
  std::array<std::byte, 56> unused;
};
static_assert(sizeof(Header) == 320 && offsetof(Header, origin) == 48 && offsetof(Header, sections) == 96);

constexpr std::uint64_t aligned(std::uint64_t size) noexcept { return (size + kAlignment - 1) & ~(kAlignment - 1); }

// Files contain the bytes that are in memory. Big-endian machines would need converted copies, which are not tested.
static_assert(std::endian::native == std::endian::little, "orchard runs on little-endian machines");

// Returns the checksum of a file, without the field that stores it. A step is a bijection of the state for a given
// word, and of the word for a given state. So a change within one eight-byte word is always noticed, any other with a
// probability of 1 - 2^-64. `size` is a multiple of 8.
std::uint64_t checksum(const std::byte* file, std::size_t size) noexcept {
  std::uint64_t state = 0x6f72636861726421u;
  for (std::size_t i = 0; i < size; i += 8) {
    if (i == offsetof(Header::Preamble, checksum)) continue;
    std::uint64_t word;
    std::memcpy(&word, file + i, sizeof word);
    state = (state ^ word) * 0x9e3779b97f4a7c15u;
    state ^= state >> 32;
  }
  return state;
}

// Calls visit(section number from 0, array) for every section of a tree or view.
template <typename Tree, typename Visit>
void each_section(Tree& tree, Visit&& visit) {
  visit(0, tree.blocks), visit(1, tree.vertices), visit(2, tree.triangles);
  visit(3, tree.leaf_triangles), visit(4, tree.obb_nodes), visit(5, tree.triangle_blocks), visit(6, tree.supports);
}

// Calls visit(number in the header, number in the tree) for all numbers that both have.
template <typename HeaderOrConst, typename Numbers, typename Visit>
void each_number(HeaderOrConst& header, Numbers& tree, const Visit& visit) {
  visit(header.branching, tree.branching), visit(header.depth, tree.depth);
  visit(header.node_count, tree.node_count), visit(header.triangle_tree_depth, tree.triangle_tree_depth);
  visit(header.origin, tree.origin);
  visit(header.bounding_radius, tree.bounding_radius), visit(header.vertex_error, tree.vertex_error);
}

LoadStatus check_preamble(std::span<const std::byte> file, Header& header) noexcept {
  if (file.empty()) return LoadStatus::truncated;
  header = {};
  std::memcpy(&header, file.data(), std::min(file.size(), sizeof header));
  if (std::memcmp(&header, kMagic.data(), std::min(file.size(), kMagic.size())) != 0) return LoadStatus::bad_magic;
  if (file.size() < sizeof(Header::Preamble)) return LoadStatus::truncated;
  if (header.preamble.version == kVersion) return LoadStatus::ok;
  return header.preamble.version > kVersion ? LoadStatus::version_newer : LoadStatus::version_older;
}

bool all_zero(std::span<const std::byte> bytes) noexcept {
  return std::all_of(bytes.begin(), bytes.end(), [](std::byte b) { return b == std::byte{0}; });
}

// Returns whether the sections follow one another in order without gaps and end with the file, and all bytes that
// belong to no section are zero. So a tree has only one form as a file, and no crafted table leads beyond the end of
// the file.
bool is_table_valid(std::span<const std::byte> file, const Header& header) noexcept {
  std::uint64_t end = sizeof header;
  bool valid = header.section_count == kSections && header.reserved == 0 && all_zero(header.unused);
  const TreeView none;
  each_section(none, [&](std::size_t i, const auto& elements) {
    const Header::Section& section = header.sections[i];
    constexpr std::uint32_t size = sizeof elements[0];
    valid = valid && section.number == i + 1 && section.element_size == size && section.offset == end &&
            section.count <= (file.size() - end) / size && aligned(section.end()) <= file.size();
    if (!valid) return;
    end = aligned(section.end());
    valid = all_zero(file.subspan(section.end(), end - section.end()));
  });
  return valid && end == file.size();
}

LoadStatus check_file(std::span<const std::byte> file, Header& header) noexcept {
  if (const LoadStatus status = check_preamble(file, header); status != LoadStatus::ok) return status;
  if (header.preamble.file_size > file.size() || file.size() < sizeof header) return LoadStatus::truncated;
  if (header.preamble.file_size < file.size() || header.preamble.file_size % kAlignment != 0)
    return LoadStatus::invalid_structure;
  if (checksum(file.data(), file.size()) != header.preamble.checksum) return LoadStatus::checksum_mismatch;
  const bool valid = header.preamble.header_size == sizeof header && is_table_valid(file, header);
  return valid ? LoadStatus::ok : LoadStatus::invalid_structure;
}

// Fills a tree from a header and by place(array, section). Fails if queries could not walk the result.
template <typename Tree, typename Place>
LoadStatus fill(const Header& header, Tree& out, const Place& place) {
  Tree tree;
  each_section(tree, [&](std::size_t i, auto& elements) { place(elements, header.sections[i]); });
  each_number(header, tree, [](const auto& from, auto& to) { to = from; });
  if (structure_fault(tree) != nullptr) return LoadStatus::invalid_structure;
  out = std::move(tree);
  return LoadStatus::ok;
}

struct Close {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};

// Appends the bytes of a stream, until there are `size` bytes in all or the stream ends. It reads in pieces, so a
// header that states a size beyond the end costs at most one piece of memory.
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
  Header header{};
  header.preamble.magic = kMagic;
  header.preamble.version = kVersion, header.preamble.header_size = sizeof header, header.section_count = kSections;
  each_number(header, tree, [](auto& to, const auto& from) { to = from; });
  header.preamble.file_size = sizeof header;
  each_section(tree, [&](std::size_t i, const auto& elements) {
    header.sections[i] = {static_cast<std::uint32_t>(i + 1), sizeof elements[0], header.preamble.file_size,
                          elements.size()};
    header.preamble.file_size = aligned(header.sections[i].end());
  });
  std::vector<std::byte> file(header.preamble.file_size);
  each_section(tree, [&](std::size_t i, const auto& elements) {
    if (!elements.empty()) std::memcpy(&file[header.sections[i].offset], elements.data(), elements.size_bytes());
  });
  std::memcpy(file.data(), &header, sizeof header);
  header.preamble.checksum = checksum(file.data(), file.size());
  std::memcpy(file.data(), &header, sizeof header);
  return file;
}

LoadStatus load(std::span<const std::byte> file, PackedSphereTree& out) noexcept {
  Header header;
  if (const LoadStatus status = check_file(file, header); status != LoadStatus::ok) return status;
  return detail::made_or(LoadStatus::out_of_memory, [&] {
    return fill(header, out, [file](auto& elements, const Header::Section& section) {
      elements.resize(static_cast<std::size_t>(section.count));
      if (!elements.empty()) std::memcpy(elements.data(), &file[section.offset], section.end() - section.offset);
    });
  });
}

LoadStatus view(std::span<const std::byte> file, TreeView& out) noexcept {
  Header header;
  if (const LoadStatus status = check_file(file, header); status != LoadStatus::ok) return status;
  if (reinterpret_cast<std::uintptr_t>(file.data()) % kViewAlignment != 0) return LoadStatus::cannot_map;
  return fill(header, out, [file](auto& elements, const Header::Section& section) {
    using Element = typename std::remove_reference_t<decltype(elements)>::element_type;
    // The bytes hold exactly such objects: implicit-lifetime types of 32-bit words, written by serialize().
    elements = {reinterpret_cast<Element*>(file.data() + section.offset), static_cast<std::size_t>(section.count)};
  });
}

LoadStatus load_file(const char* path, PackedSphereTree& out) noexcept {
  const std::unique_ptr<std::FILE, Close> stream(std::fopen(path, "rb"));
  if (!stream) return LoadStatus::cannot_open;
  return detail::made_or(LoadStatus::out_of_memory, [&] {
    std::vector<std::byte> bytes;
    Header header;
    LoadStatus status = read_up_to(stream.get(), sizeof(Header::Preamble), bytes);
    if (status == LoadStatus::ok) status = check_preamble(bytes, header);
    // One byte more than the header states is read, so that a longer file is noticed.
    if (status == LoadStatus::ok) {
      status = read_up_to(stream.get(), std::max(header.preamble.file_size, header.preamble.file_size + 1), bytes);
    }
    return status == LoadStatus::ok ? load(bytes, out) : status;
  });
}

}  // namespace orchard::runtime
