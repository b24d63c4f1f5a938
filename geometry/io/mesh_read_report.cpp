#include <string>
#include <vector>

#include "orchard/geometry/mesh_io.h"

namespace orchard {
namespace {

std::string counted(std::uint64_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
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
  return lines;
}

}  // namespace orchard
