#include <CGAL/IO/OFF.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>

#include <locale>
#include <span>
#include <sstream>
#include <utility>
#include <vector>

#include "mesh_formats.h"
#include "orchard/geometry/error.h"
#include "polygons.h"
#include "soup_guards.h"
#include "text_scan.h"
#include "vertex_faults.h"

namespace orchard {
namespace {

struct Soup {
  std::vector<CGAL::Simple_cartesian<double>::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
};

std::vector<Point> vertices_of(const Soup& soup, const std::string& name) {
  if (soup.points.size() >= kNone) throw InputError(name + ": the file has too many vertices for 32-bit indices");
  std::vector<Point> vertices;
  vertices.reserve(soup.points.size());
  for (const auto& point : soup.points) vertices.emplace_back(point.x(), point.y(), point.z());
  return vertices;
}

// `face_at` has the byte of each polygon in the file; it is empty if all are triangles.
FaceCollector faces_of(const Soup& soup, std::span<const std::size_t> face_at) {
  FaceCollector faces;
  std::vector<Index> corners;
  for (std::size_t i = 0; i < soup.polygons.size(); ++i) {
    corners.clear();
    for (const std::size_t corner : soup.polygons[i]) corners.push_back(static_cast<Index>(corner));
    faces.add(corners, i < face_at.size() ? face_at[i] : 0);
  }
  return faces;
}

std::istringstream stream_of(std::string bytes) {
  std::istringstream stream(std::move(bytes), std::ios::binary);
  stream.imbue(std::locale::classic());
  return stream;
}

}  // namespace

TriangleMesh read_stl(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  Soup soup;
  std::istringstream stream = stream_of(checked_stl(bytes, name, report));
  if (!CGAL::IO::read_STL(stream, soup.points, soup.polygons))
    throw InputError(name + ": this is not an STL file that can be read; export the mesh again");
  FaceCollector faces = faces_of(soup, {});
  if (faces.empty()) throw InputError(name + ": the file has no faces");
  TriangleMesh mesh{vertices_of(soup, name), {}};
  mesh.triangles = std::move(faces).finish(mesh.vertices).triangles;
  return mesh;
}

TriangleMesh read_off(std::string_view bytes, const std::string& name, MeshReadReport& report) {
  Soup soup;
  CheckedOff checked = checked_off(bytes, name, report);
  std::istringstream stream = stream_of(std::move(checked.bytes));
  if (!CGAL::IO::read_OFF(stream, soup.points, soup.polygons))
    throw InputError(name + ": this is not an OFF file that can be read; export the mesh again");
  FaceCollector faces = faces_of(soup, checked.face_at);
  TriangleMesh mesh{vertices_of(soup, name), {}};
  const auto place = [&](std::size_t at) { return line_place(bytes, at); };
  checked.vertex_faults.settle(
      mesh.vertices, faces,
      [&](std::size_t at) { fail_at_line(name, bytes, at, "vertex needs three finite numbers, since a face uses it"); },
      place, report);
  mesh.triangles = split_faces(std::move(faces), mesh.vertices, place, report);
  return mesh;
}

}  // namespace orchard
