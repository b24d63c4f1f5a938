#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "io/ply_header.h"
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/random.h"

namespace orchard::test {

inline constexpr PlyType kPlyTypes[] = {PlyType::int8,  PlyType::uint8,  PlyType::int16,   PlyType::uint16,
                                        PlyType::int32, PlyType::uint32, PlyType::float32, PlyType::float64};
inline constexpr const char* kPlyTypeNames[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                                   {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                                   {"float", "float32"}, {"double", "float64"}};

// Writes numbers as one encoding has them.
class PlyBody {
 public:
  explicit PlyBody(PlyEncoding encoding) : encoding_(encoding) {}
  void put(PlyType type, double value) {
    switch (type) {
      case PlyType::int8:
        return put_as<std::int8_t>(value);
      case PlyType::uint8:
        return put_as<std::uint8_t>(value);
      case PlyType::int16:
        return put_as<std::int16_t>(value);
      case PlyType::uint16:
        return put_as<std::uint16_t>(value);
      case PlyType::int32:
        return put_as<std::int32_t>(value);
      case PlyType::uint32:
        return put_as<std::uint32_t>(value);
      case PlyType::float32:
        return put_as<float>(value);
      case PlyType::float64:
        return put_as<double>(value);
    }
  }
  void end_row() {
    if (encoding_ == PlyEncoding::ascii) bytes_.back() = '\n';
  }
  const std::string& bytes() const { return bytes_; }

 private:
  template <typename T>
  void put_as(double value) {
    if (encoding_ == PlyEncoding::ascii) {
      char text[32];
      std::snprintf(text, sizeof text, "%.17g ", static_cast<double>(static_cast<T>(value)));
      bytes_ += text;
      return;
    }
    const T exact = static_cast<T>(value);
    std::string raw(sizeof(T), '\0');
    std::memcpy(raw.data(), &exact, sizeof(T));
    const bool little = encoding_ == PlyEncoding::little_endian;
    if (little != (std::endian::native == std::endian::little)) std::ranges::reverse(raw);
    bytes_ += raw;
  }
  PlyEncoding encoding_;
  std::string bytes_;
};

inline constexpr const char* kPlyEncodings[] = {"ascii", "binary_little_endian", "binary_big_endian"};

// A random file: property order, types, further properties and elements differ with the seed.
class RandomPly {
 public:
  // `strips`: the faces are in strips of triangles.
  RandomPly(std::uint64_t seed, PlyEncoding encoding, bool strips = false)
      : random_(seed, 1), header_("ply\nformat "), body_(encoding) {
    header_ += std::string(kPlyEncodings[static_cast<std::size_t>(encoding)]) + " 1.0\ncomment seed\n";
    const bool faces_first = random_.below(4) == 0;
    for (int part = 0; part < 2; ++part) {
      if (random_.below(2)) add_extra_element("extra" + std::to_string(part));
      (part == 0) != faces_first ? add_vertices() : strips ? add_strips() : add_faces();
    }
    header_ += "obj_info hand-made\nend_header\n";
  }
  std::string bytes() const { return header_ + body_.bytes(); }
  const TriangleMesh& mesh() const { return mesh_; }

 private:
  static constexpr Index kVertices = 100;  // so that char can name them all

  PlyType any_type() { return kPlyTypes[random_.below(8)]; }
  std::string name_of(PlyType type) { return kPlyTypeNames[static_cast<std::size_t>(type)][random_.below(2)]; }
  double any_number() { return static_cast<double>(random_.below(100)); }

  struct Column {
    PlyType type;
    bool list;
    PlyType length_type;
    std::string name;
  };
  // The named column among some that are not needed, in random order.
  std::vector<Column> columns(std::vector<Column> named) {
    for (std::uint64_t i = random_.below(3); i > 0; --i) {
      named.push_back({any_type(), random_.below(3) == 0, any_type(), "extra" + std::to_string(i)});
    }
    for (std::size_t i = named.size() - 1; i > 0; --i) std::swap(named[i], named[random_.below(i + 1)]);
    for (const Column& column : named) {
      header_ += "property " + (column.list ? "list " + name_of(column.length_type) + " " : "") + name_of(column.type) +
                 " " + column.name + "\n";
    }
    return named;
  }
  void put_unneeded(const Column& column) {
    const std::uint64_t count = column.list ? random_.below(4) : 1;
    if (column.list) body_.put(column.length_type, static_cast<double>(count));
    for (std::uint64_t i = 0; i < count; ++i) body_.put(column.type, any_number());
  }
  void add_extra_element(const std::string& name) {
    header_ += "element " + name + " 3\n";
    const auto layout = columns({{any_type(), false, any_type(), "x"}});
    for (int row = 0; row < 3; ++row) {
      for (const Column& column : layout) put_unneeded(column);
      body_.end_row();
    }
  }
  void add_vertices() {
    header_ += "element vertex " + std::to_string(kVertices) + "\n";
    const auto layout = columns({{any_type(), false, any_type(), "x"},
                                 {any_type(), false, any_type(), "y"},
                                 {any_type(), false, any_type(), "z"}});
    for (Index row = 0; row < kVertices; ++row) {
      Point& point = mesh_.vertices.emplace_back();
      for (const Column& column : layout) {
        const std::size_t axis = std::string("xyz").find(column.name);
        if (axis == std::string::npos) {
          put_unneeded(column);
          continue;
        }
        double value = any_number();
        if (column.type == PlyType::float64) value = random_.uniform(-1e9, 1e9);
        if (column.type == PlyType::float32) value = static_cast<float>(random_.uniform(-1, 1));
        point[static_cast<Eigen::Index>(axis)] = value;
        body_.put(column.type, value);
      }
      body_.end_row();
    }
  }
  void add_faces() {
    header_ += "element face 50\n";
    const auto layout = columns({{any_type(), true, any_type(), random_.below(2) ? "vertex_indices" : "vertex_index"}});
    for (int row = 0; row < 50; ++row) {
      for (const Column& column : layout) {
        if (!column.name.starts_with("vertex")) {
          put_unneeded(column);
          continue;
        }
        body_.put(column.length_type, 3);
        for (Index& corner : mesh_.triangles.emplace_back()) {
          corner = static_cast<Index>(random_.below(kVertices));
          body_.put(column.type, corner);
        }
      }
      body_.end_row();
    }
  }

  // As a picture of a strip has it: corners alternate between its two rims, and each triangle lies between three that
  // follow one another.
  void add_strips() {
    const std::uint64_t rows = random_.below(4);
    header_ += "element tristrips " + std::to_string(rows) + "\n";
    static constexpr std::array kLengths{PlyType::uint8, PlyType::int16, PlyType::int32};
    static constexpr std::array kSigned{PlyType::int8, PlyType::int16, PlyType::int32, PlyType::float64};
    const auto layout = columns({{kSigned.at(random_.below(4)), true, kLengths.at(random_.below(3)),
                                  random_.below(2) ? "vertex_indices" : "vertex_index"}});
    for (std::uint64_t row = 0; row < rows; ++row) {
      for (const Column& column : layout) {
        if (!column.name.starts_with("vertex")) {
          put_unneeded(column);
          continue;
        }
        const std::vector<int> list = random_strips();
        body_.put(column.length_type, static_cast<double>(list.size()));
        for (const int item : list) body_.put(column.type, item);
      }
      body_.end_row();
    }
  }
  std::vector<int> random_strips() {
    std::vector<int> list;
    for (std::uint64_t strips = random_.below(6); strips > 0; --strips) {
      std::vector<int> strip;
      for (std::uint64_t corners = random_.below(12); corners > 0; --corners) {
        strip.push_back(random_.below(5) == 0 && !strip.empty() ? strip.back()
                                                                : static_cast<int>(random_.below(kVertices)));
      }
      for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
        std::array<int, 3> corners{strip[i], strip[i + 1], strip[i + 2]};
        if (i % 2 == 1) std::swap(corners[0], corners[1]);
        if (std::set<int>(corners.begin(), corners.end()).size() < 3) continue;
        mesh_.triangles.push_back(
            {static_cast<Index>(corners[0]), static_cast<Index>(corners[1]), static_cast<Index>(corners[2])});
      }
      list.insert(list.end(), strip.begin(), strip.end());
      if (strips > 1 || random_.below(2) == 0) list.push_back(-1);
    }
    return list;
  }

  Random random_;
  std::string header_;
  PlyBody body_;
  TriangleMesh mesh_;
};

}  // namespace orchard::test
