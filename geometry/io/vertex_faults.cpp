#include "vertex_faults.h"

#include <algorithm>
#include <utility>

namespace orchard {

void VertexFaults::settle(std::vector<Point>& vertices, const FaceCollector& faces,
                          const std::function<void(std::size_t)>& fail,
                          const std::function<std::string(std::size_t)>& place, MeshReadReport& report) const {
  if (faults_.empty()) return;
  std::vector<bool> used(vertices.size(), false);
  Index a_used_vertex = kNone;
  for (const auto& corners : faces.corners())
    for (const Index vertex : corners) {
      if (vertex >= used.size()) continue;  // the reader reports this error
      used[vertex] = true;
      a_used_vertex = vertex;
    }
  for (const Fault& fault : faults_)
    if (used[fault.vertex]) fail(fault.at);
  report.vertices_skipped = {static_cast<Index>(faults_.size()), place(faults_.front().at)};
  if (a_used_vertex != kNone) {
    for (const Fault& fault : faults_) vertices[fault.vertex] = vertices[a_used_vertex];
  } else {
    std::erase_if(vertices, [](const Point& vertex) { return !vertex.allFinite(); });
  }
}

std::vector<std::array<Index, 3>> split_faces(FaceCollector&& faces, std::span<const Point> vertices,
                                              const std::function<std::string(std::size_t)>& place,
                                              MeshReadReport& report) {
  FaceCollector::Split split = std::move(faces).finish(vertices);
  report.polygons_triangulated = split.triangulated;
  report.polygons_overlapping.count = split.overlapping;
  if (split.overlapping > 0) report.polygons_overlapping.first = place(split.first_overlapping);
  return std::move(split.triangles);
}

}  // namespace orchard
