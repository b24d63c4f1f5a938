#include <array>
#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "mesh_formats.h"
#include "ply_header.h"
#include "polygons.h"
#include "text_scan.h"

namespace orchard {
namespace {

// Numbers as text, parted by white space.
class AsciiBody {
 public:
  AsciiBody(std::string_view bytes, std::size_t body, const std::string& name)
      : bytes_(bytes), name_(name), at_(bytes.data() + body), end_(bytes.data() + bytes.size()) {}

  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }
  // Of the next number.
  std::size_t position() {
    skip_space();
    return bytes_.size() - remaining();
  }
  [[noreturn]] void fail(std::size_t position, const std::string& fault) const {
    fail_at_line(name_, bytes_, position, fault);
  }
  double number(PlyType) {
    const char* token = next_token();
    double value = 0;
    if (!scan_double(at_, end_, value) || !at_token_end()) fail_not_a_number(token);
    return value;
  }
  std::int64_t integer(PlyType) {
    const char* token = next_token();
    std::int64_t value = 0;
    if (scan_integer(at_, end_, value) && at_token_end()) return value;
    at_ = token;  // perhaps it is written as 3.0
    const double real = number(PlyType::float64);
    if (!(std::abs(real) < 0x1p53) || real != std::floor(real)) {
      fail(static_cast<std::size_t>(token - bytes_.data()), "a list's length or index that is not an integer");
    }
    return static_cast<std::int64_t>(real);
  }
  void skip(PlyType, std::uint64_t count) {
    for (; count > 0; --count) {
      next_token();
      while (!at_token_end()) ++at_;
    }
  }
  static std::size_t least_bytes(PlyType) { return 1; }

 private:
  bool at_token_end() const { return at_ == end_ || is_blank(*at_) || is_line_end(*at_); }
  void skip_space() {
    while (at_ != end_ && (is_blank(*at_) || is_line_end(*at_))) ++at_;
  }
  const char* next_token() {
    skip_space();
    if (at_ == end_) fail(bytes_.size(), "the file ends early");
    return at_;
  }
  [[noreturn]] void fail_not_a_number(const char* token) {
    at_ = token;
    while (!at_token_end()) ++at_;
    fail(static_cast<std::size_t>(token - bytes_.data()), quoted({token, at_}) + " is not a number");
  }

  std::string_view bytes_;
  const std::string& name_;
  const char* at_;
  const char* end_;
};

template <typename T>
T byte_swapped(T value) {
  std::array<unsigned char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, sizeof(T));
  for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(raw[i], raw[sizeof(T) - 1 - i]);
  std::memcpy(&value, raw.data(), sizeof(T));
  return value;
}

class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, std::size_t body, std::endian order, const std::string& name)
      : bytes_(bytes), name_(name), at_(body), swap_(order != std::endian::native) {}

  std::size_t remaining() const { return bytes_.size() - at_; }
  std::size_t position() const { return at_; }
  [[noreturn]] void fail(std::size_t position, const std::string& fault) const { fail_at_byte(name_, position, fault); }
  double number(PlyType type) {
    return visit<double>(type, [](auto value) { return static_cast<double>(value); });
  }
  std::int64_t integer(PlyType type) {
    const std::size_t start = at_;
    return visit<std::int64_t>(type, [&](auto value) {
      if constexpr (std::is_floating_point_v<decltype(value)>) {
        if (!(std::abs(value) < 0x1p53) || value != std::floor(value)) {
          fail(start, "a list's length or index that is not an integer");
        }
      }
      return static_cast<std::int64_t>(value);
    });
  }
  void skip(PlyType type, std::uint64_t count) {
    if (count > remaining() / size_of(type)) fail(bytes_.size(), "the file ends early");
    at_ += count * size_of(type);
  }
  static std::size_t least_bytes(PlyType type) { return size_of(type); }

 private:
  template <typename T>
  T take() {
    if (remaining() < sizeof(T)) fail(bytes_.size(), "the file ends early");
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return swap_ ? byte_swapped(value) : value;
  }
  template <typename Result, typename Function>
  Result visit(PlyType type, const Function& function) {
    switch (type) {
      case PlyType::int8:
        return function(take<std::int8_t>());
      case PlyType::uint8:
        return function(take<std::uint8_t>());
      case PlyType::int16:
        return function(take<std::int16_t>());
      case PlyType::uint16:
        return function(take<std::uint16_t>());
      case PlyType::int32:
        return function(take<std::int32_t>());
      case PlyType::uint32:
        return function(take<std::uint32_t>());
      case PlyType::float32:
        return function(take<float>());
      case PlyType::float64:
        break;
    }
    return function(take<double>());
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_;
  bool swap_;
};

template <typename Body>
class PlyReader {
 public:
  PlyReader(const PlyHeader& header, std::string_view bytes, const std::string& name, Body body)
      : header_(header), bytes_(bytes), name_(name), body_(body) {}

  TriangleMesh read(bool needs_faces) {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") vertex_count_ = element.rows;
    }
    for (const PlyElement& element : header_.elements) read_element(element);
    if (needs_faces && faces_.empty()) throw InputError(name_ + ": no faces in this PLY file");
    if (mesh_.vertices.empty()) throw InputError(name_ + ": no vertices in this PLY file");
    mesh_.triangles = std::move(faces_).finish(mesh_.vertices);
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail_in_header(const PlyElement& element, const std::string& fault) const {
    fail_at_line(name_, bytes_, element.at, "element " + quoted(element.name) + " " + fault);
  }

  void read_element(const PlyElement& element) {
    // What a header promises is believed only as far as the bytes that follow can keep it.
    const std::size_t row_bytes = element.least_row_bytes(header_.encoding);
    if (row_bytes > 0 && element.rows > body_.remaining() / row_bytes + (header_.encoding == PlyEncoding::ascii)) {
      fail_in_header(element, "promises " + std::to_string(element.rows) + " rows, but only " +
                                  std::to_string(body_.remaining()) + " bytes are left for them");
    }
    if (element.name == "vertex") return read_vertices(element);
    if (element.name == "face") return read_faces(element);
    if (row_bytes == 0) return;
    for (std::uint64_t row = 0; row < element.rows; ++row) {
      for (const PlyProperty& property : element.properties) skip(property);
    }
  }

  void skip(const PlyProperty& property) {
    body_.skip(property.type, property.length_type ? list_length(property) : 1);
  }

  std::uint64_t list_length(const PlyProperty& property) {
    const std::size_t start = body_.position();
    const std::int64_t length = body_.integer(*property.length_type);
    if (length < 0 || static_cast<std::uint64_t>(length) > body_.remaining() / body_.least_bytes(property.type)) {
      body_.fail(start, "a list of " + std::to_string(length) + " items, which the rest of the file cannot hold");
    }
    return static_cast<std::uint64_t>(length);
  }

  void read_vertices(const PlyElement& element) {
    std::vector<int> axes(element.properties.size(), -1);  // which coordinate a property is
    for (const int axis : {0, 1, 2}) {
      const std::string coordinate(1, "xyz"[axis]);
      const std::optional<std::size_t> property = element.find(coordinate);
      if (!property || element.properties[*property].length_type) {
        fail_in_header(element, "has no number \"" + coordinate + "\"");
      }
      axes[*property] = axis;
    }
    if (element.rows >= kNone) fail_in_header(element, "has too many rows for 32-bit indices");
    mesh_.vertices.resize(element.rows);
    for (Point& vertex : mesh_.vertices) {
      for (std::size_t i = 0; i < axes.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (axes[i] < 0) {
          skip(property);
          continue;
        }
        const std::size_t start = body_.position();
        vertex[axes[i]] = body_.number(property.type);
        if (!std::isfinite(vertex[axes[i]])) body_.fail(start, "a vertex coordinate that is not a finite number");
      }
    }
  }

  void read_faces(const PlyElement& element) {
    std::optional<std::size_t> indices = element.find("vertex_indices");
    if (!indices) indices = element.find("vertex_index");
    if (!indices || !element.properties[*indices].length_type) {
      fail_in_header(element, "has no list \"vertex_indices\"");
    }
    for (std::uint64_t row = 0; row < element.rows; ++row) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        i == *indices ? read_face(element.properties[i]) : skip(element.properties[i]);
      }
    }
  }

  void read_face(const PlyProperty& property) {
    const std::size_t start = body_.position();
    const std::uint64_t length = list_length(property);
    if (length < 3) body_.fail(start, "a face of " + std::to_string(length) + " corners; it needs at least 3");
    corners_.clear();
    for (std::uint64_t i = 0; i < length; ++i) {
      const std::size_t corner = body_.position();
      const std::int64_t vertex = body_.integer(property.type);
      if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= vertex_count_) {
        body_.fail(corner, "a face names vertex " + std::to_string(vertex) + ", but the file has " +
                               std::to_string(vertex_count_) + " vertices, counted from 0");
      }
      corners_.push_back(static_cast<Index>(vertex));
    }
    faces_.add(corners_);
  }

  const PlyHeader& header_;
  std::string_view bytes_;
  const std::string& name_;
  Body body_;
  std::uint64_t vertex_count_ = 0;
  TriangleMesh mesh_;
  FaceCollector faces_;
  std::vector<Index> corners_;
};

}  // namespace

namespace {

TriangleMesh read(std::string_view bytes, const std::string& name, bool needs_faces) {
  const PlyHeader header = read_ply_header(bytes, name);
  if (header.encoding == PlyEncoding::ascii) {
    return PlyReader(header, bytes, name, AsciiBody(bytes, header.body, name)).read(needs_faces);
  }
  const std::endian order = header.encoding == PlyEncoding::little_endian ? std::endian::little : std::endian::big;
  return PlyReader(header, bytes, name, BinaryBody(bytes, header.body, order, name)).read(needs_faces);
}

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const std::string& name) { return read(bytes, name, true); }

TriangleMesh read_ply_or_points(std::string_view bytes, const std::string& name) { return read(bytes, name, false); }

}  // namespace orchard
