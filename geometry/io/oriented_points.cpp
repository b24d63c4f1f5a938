#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "mesh_formats.h"
#include "orchard/geometry/ply_tables.h"
#include "orchard/geometry/reconstruct.h"
#include "text_scan.h"

namespace orchard {
namespace {

constexpr const char* kNoNormals =
    "points without normals are no surface; estimate their normals in the program that made them (MeshLab: Compute "
    "normals for point sets), and save x y z nx ny nz";

bool is_normal(const Vector& normal) { return normal.allFinite() && normal.norm() > 0; }

OrientedPoints of_ply(const PlyTables& tables, const PlyTables::Table& vertices, const std::string& name) {
  std::array<const PlyTables::Column*, 6> columns{};
  constexpr std::array<std::string_view, 6> kNames{"x", "y", "z", "nx", "ny", "nz"};
  for (std::size_t i = 0; i < columns.size(); ++i) {
    columns[i] = vertices.find(kNames[i]);
    if (columns[i] == nullptr || columns[i]->list) throw InputError(name + ": " + kNoNormals);
  }
  OrientedPoints result;
  for (std::size_t row = 0; row < vertices.rows(); ++row) {
    const auto vector = [&](std::size_t from) {
      return Vector(columns[from]->numbers[row], columns[from + 1]->numbers[row], columns[from + 2]->numbers[row]);
    };
    if (!vector(0).allFinite()) continue;
    if (!is_normal(vector(3)))
      tables.fail(vertices, row, "the normal is zero or not finite; remove the point or compute the normals again");
    result.points.push_back(vector(0));
    result.normals.push_back(vector(3).normalized());
  }
  return result;
}

// Reads the numbers at the beginning of a line, at most six. Returns how many there are.
std::size_t numbers_of(std::string_view line, std::array<double, 6>& numbers) {
  const char *at = line.data(), *end = line.data() + line.size();
  std::size_t count = 0;
  while (count < numbers.size()) {
    while (at != end && (is_blank(*at) || *at == ',' || *at == ';')) ++at;
    if (at == end || *at == '#' || !scan_any_double(at, end, numbers[count])) break;
    ++count;
  }
  return count;
}

OrientedPoints of_xyz(std::string_view bytes, const std::string& name) {
  OrientedPoints result;
  std::array<double, 6> numbers{};
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t stop = std::min(bytes.find_first_of("\r\n", at), bytes.size());
    const std::size_t count = numbers_of(bytes.substr(at, stop - at), numbers);
    const Point point(numbers[0], numbers[1], numbers[2]);
    const Vector normal(numbers[3], numbers[4], numbers[5]);
    if (count >= 3 && count < 6) fail_at_line(name, bytes, at, kNoNormals);
    if (count == 6 && point.allFinite()) {
      if (!is_normal(normal))
        fail_at_line(name, bytes, at,
                     "the normal is zero or not finite; remove the point or compute the normals again");
      result.points.push_back(point);
      result.normals.push_back(normal.normalized());
    }
    at = stop + 1;
  }
  return result;
}

}  // namespace

std::optional<OrientedPoints> read_oriented_points(const std::filesystem::path& file, const std::string& format) {
  std::string kind = format.empty() ? file.extension().string() : "." + format;
  std::ranges::transform(kind, kind.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  if (kind != ".xyz" && kind != ".ply") return std::nullopt;
  std::string bytes = read_bytes(file);
  MeshReadReport unused;
  if (kind == ".xyz") {
    read_xyz(bytes, file.string(), unused);  // refuses everything that is not a text of points
    return of_xyz(bytes, file.string());
  }
  const PlyTables tables(file.string(), std::move(bytes));
  const PlyTables::Table *vertices = tables.find("vertex"), *faces = tables.find("face"),
                         *strips = tables.find("tristrips");
  if (vertices == nullptr || (faces != nullptr && faces->rows() > 0) || (strips != nullptr && strips->rows() > 0))
    return std::nullopt;
  return of_ply(tables, *vertices, file.string());
}

}  // namespace orchard
