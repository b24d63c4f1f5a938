#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace orchard {

enum class PlyEncoding : std::uint8_t { ascii, little_endian, big_endian };
enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;     // for a list, the type of its items
  std::optional<PlyType> length_type;  // set for lists
};

struct PlyElement {
  std::string name;
  std::uint64_t rows = 0;
  std::vector<PlyProperty> properties;
  std::size_t at = 0;  // byte of its line in the header

  // Returns the index of the first property with this name, or nullopt.
  std::optional<std::size_t> find(std::string_view property) const;
  // Returns the smallest number of bytes that a row can have.
  std::size_t min_row_bytes(PlyEncoding encoding) const;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::size_t body = 0;  // the byte at which it begins
};

// Reads the header. Throws InputError, which names the line. The number of rows is not compared with the length of the
// file.
PlyHeader read_ply_header(std::string_view bytes, const std::string& name);

}  // namespace orchard
