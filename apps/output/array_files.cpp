#include "output/array_files.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>
#include <iterator>

#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

template <typename Number>
void append(std::string& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof(Number); ++i)
    bytes.push_back(static_cast<char>(static_cast<unsigned char>(number >> (8 * i))));
}

// Of ZIP: polynomial 0xEDB88320.
std::uint32_t crc_of(const std::string& bytes) {
  static const std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> result{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      std::uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = (value & 1) != 0 ? 0xEDB88320u ^ value >> 1 : value >> 1;
      result.at(i) = value;
    }
    return result;
  }();
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const char byte : bytes) crc = table.at((crc ^ static_cast<unsigned char>(byte)) & 0xFF) ^ crc >> 8;
  return ~crc;
}

std::size_t rows_of(const NamedArray& array) {
  return std::visit([&](const auto& values) { return values.size(); }, array.values) / array.columns.size();
}

// Returns the .npy file of an array. Its header is padded so that the numbers begin at a multiple of 64 bytes.
std::string to_npy(const NamedArray& array) {
  constexpr std::array kTypes{"<f8", "<u4", "<i4"};  // in the order of the variant
  const std::string shape = array.columns.size() == 1 ? fmt::format("({},)", rows_of(array))
                                                      : fmt::format("({}, {})", rows_of(array), array.columns.size());
  std::string head =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': {}, }}", kTypes.at(array.values.index()), shape);
  constexpr std::size_t kMagic = 10;
  head.append((64 - (kMagic + head.size() + 1) % 64) % 64, ' ');
  head.push_back('\n');
  std::string bytes = "\x93NUMPY\x01";
  bytes.push_back('\0');
  append(bytes, static_cast<std::uint16_t>(head.size()));
  bytes += head;
  std::visit(
      [&](const auto& values) {
        for (const auto value : values) {
          if constexpr (std::is_same_v<decltype(value), const double>) {
            append(bytes, std::bit_cast<std::uint64_t>(value));
          } else {
            append(bytes, static_cast<std::uint32_t>(value));
          }
        }
      },
      array.values);
  return bytes;
}

// Returns what the local header of a file and its entry in the directory have in common, beginning with the version.
// The date is the first one that ZIP can express, so that the same arrays give the same bytes.
std::string zip_entry(const std::string& name, const std::string& file) {
  std::string entry;
  append(entry, std::uint16_t{20});
  append(entry, std::uint16_t{0});
  append(entry, std::uint16_t{0});
  append(entry, std::uint16_t{0});
  append(entry, std::uint16_t{0x21});
  append(entry, crc_of(file));
  append(entry, static_cast<std::uint32_t>(file.size()));
  append(entry, static_cast<std::uint32_t>(file.size()));
  append(entry, static_cast<std::uint16_t>(name.size()));
  append(entry, std::uint16_t{0});
  return entry;
}

void require_room(std::size_t bytes) {
  if (bytes > 0xFFFFFFFFu) throw Error("the arrays take more than the 4 GiB that an .npz file may have; write .csv");
}

}  // namespace

std::string to_npz(std::span<const NamedArray> arrays) {
  std::string bytes, directory;
  for (const NamedArray& array : arrays) {
    const std::string name = array.name + ".npy", file = to_npy(array), entry = zip_entry(name, file);
    require_room(bytes.size() + file.size());
    append(directory, std::uint32_t{0x02014b50});
    append(directory, std::uint16_t{20});
    directory += entry;
    directory.append(10, '\0');  // no comment, first disk, no attributes
    append(directory, static_cast<std::uint32_t>(bytes.size()));
    directory += name;
    append(bytes, std::uint32_t{0x04034b50});
    bytes.append(entry).append(name).append(file);
  }
  require_room(bytes.size());
  const auto begin = static_cast<std::uint32_t>(bytes.size());
  bytes += directory;
  append(bytes, std::uint32_t{0x06054b50});
  append(bytes, std::uint32_t{0});
  append(bytes, static_cast<std::uint16_t>(arrays.size()));
  append(bytes, static_cast<std::uint16_t>(arrays.size()));
  append(bytes, static_cast<std::uint32_t>(directory.size()));
  append(bytes, begin);
  append(bytes, std::uint16_t{0});
  return bytes;
}

std::string to_csv(std::span<const NamedArray> arrays) {
  std::string text;
  for (const NamedArray& array : arrays) {
    for (const std::string& column : array.columns) text += (text.empty() ? "" : ",") + column;
  }
  text.push_back('\n');
  const std::size_t rows = arrays.empty() ? 0 : rows_of(arrays.front());
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t begin = text.size();
    for (const NamedArray& array : arrays) {
      const std::size_t columns = array.columns.size();
      std::visit(
          [&](const auto& values) {
            for (std::size_t k = 0; k < columns; ++k)
              fmt::format_to(std::back_inserter(text), "{}{}", text.size() == begin ? "" : ",",
                             values[row * columns + k]);
          },
          array.values);
    }
    text.push_back('\n');
  }
  return text;
}

}  // namespace orchard::apps
