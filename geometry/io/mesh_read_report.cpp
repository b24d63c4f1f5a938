#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "orchard/geometry/mesh_io.h"

namespace orchard {
namespace {

std::string counted(std::uint64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string rounded(double value) {
  std::array<char, 32> text{};
  return {text.data(), static_cast<std::size_t>(std::snprintf(text.data(), text.size(), "%.6g", value))};
}

std::string where(const MeshReadReport::Occurrences& what) {
  return (what.count == 1 ? ", at " : ", the first at ") + what.first;
}

}  // namespace

std::vector<std::string> MeshReadReport::faults() const {
  std::vector<std::string> lines;
  if (faces_skipped.count > 0)
    lines.push_back("skipped " + counted(faces_skipped.count, "face", "faces") + " of fewer than three corners" +
                    where(faces_skipped));
  if (vertices_skipped.count > 0)
    lines.push_back("skipped " + counted(vertices_skipped.count, "vertex", "vertices") +
                    " with a coordinate that is not a finite number" + where(vertices_skipped));
  if (polygons_overlapping.count > 0)
    lines.push_back("read " + counted(polygons_overlapping.count, "polygon", "polygons") +
                    " as triangles that overlap, since the outline crosses itself" + where(polygons_overlapping));
  if (facets_promised != facets_found)
    lines.push_back("read the " + counted(facets_found, "facet", "facets") +
                    " that the file has room for, though its header counts " + std::to_string(facets_promised));
  if (bytes_left_out > 0)
    lines.push_back("skipped " + counted(bytes_left_out, "byte", "bytes") + " after the last facet");
  return lines;
}

std::vector<std::string> MeshReadReport::lines() const {
  std::vector<std::string> lines = faults();
  if (attribute_bytes > 0)
    lines.push_back("skipped " + counted(attribute_bytes, "byte", "bytes") + " of attributes between the facets");
  if (header_lines > 0)
    lines.push_back("skipped " + counted(header_lines, "line", "lines") + " of header before the first point");
  if (volume_cells > 0)
    lines.push_back("took the outer surface of " + counted(volume_cells, "volume cell", "volume cells") +
                    (cells_beside > 0 ? "; skipped " + counted(cells_beside, "surface cell", "surface cells") : ""));
  if (lines_skipped > 0) lines.push_back("skipped " + counted(lines_skipped, "point or line", "points and lines"));
  if (curved_cells > 0)
    lines.push_back("read " + counted(curved_cells, "curved cell", "curved cells") + " by the corners alone");
  if (scale != 1) lines.push_back("multiplied by " + rounded(scale));
  if (from_points) {
    const std::string length = unit.empty() ? "" : " " + unit;
    lines.push_back("made a surface of " + counted(from_points->points, "point", "points") +
                    " with normals: points are at most " + rounded(from_points->max_from_points) + length +
                    " from it, " + rounded(from_points->mean_from_points) + length +
                    " on average; no place of it is farther than " + rounded(from_points->max_to_points) + length +
                    " from a point; points are " + rounded(from_points->spacing) + length + " apart");
  }
  return lines;
}

}  // namespace orchard
