#pragma once
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/mesh_io.h"
#include "polygons.h"

namespace orchard {

// Vertices with a coordinate that is not a finite number. They are an error of the file only if a face uses them.
class VertexFaults {
 public:
  // `at` is the byte of the coordinate in the file.
  void add(Index vertex, std::size_t at) { faults_.push_back({vertex, at}); }
  // Calls `fail` with the byte of the first such vertex that a face uses. The others keep their numbers and get the
  // coordinates of a vertex that is used, so that they change neither the bounding box nor any length; if there are no
  // faces, they are erased. `place` names a byte for the report. Call it before the faces are divided.
  void settle(std::vector<Point>& vertices, const FaceCollector& faces, const std::function<void(std::size_t)>& fail,
              const std::function<std::string(std::size_t)>& place, MeshReadReport& report) const;

 private:
  struct Fault {
    Index vertex;
    std::size_t at;
  };
  std::vector<Fault> faults_;  // ascending
};

// Calls FaceCollector::finish() and adds its counts to the report. `place` names a byte.
std::vector<std::array<Index, 3>> split_faces(FaceCollector&& faces, std::span<const Point> vertices,
                                              const std::function<std::string(std::size_t)>& place,
                                              MeshReadReport& report);

}  // namespace orchard
