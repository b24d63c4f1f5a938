#include <CGAL/IO/OFF.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>

#include <locale>
#include <sstream>
#include <utility>
#include <vector>

#include "mesh_formats.h"
#include "orchard/geometry/error.h"
#include "polygons.h"
#include "soup_guards.h"

namespace orchard {
namespace {

struct Soup {
  std::vector<CGAL::Simple_cartesian<double>::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
};

TriangleMesh to_mesh(const Soup& soup, const std::string& name) {
  if (soup.points.size() >= kNone) throw InputError(name + ": too many vertices for 32-bit indices");
  TriangleMesh mesh;
  mesh.vertices.reserve(soup.points.size());
  for (const auto& point : soup.points) mesh.vertices.emplace_back(point.x(), point.y(), point.z());
  FaceCollector faces;
  std::vector<Index> corners;
  for (const auto& polygon : soup.polygons) {
    corners.clear();
    for (const std::size_t corner : polygon) corners.push_back(static_cast<Index>(corner));
    faces.add(corners);
  }
  if (faces.empty()) throw InputError(name + ": no faces in this file");
  mesh.triangles = std::move(faces).finish(mesh.vertices);
  return mesh;
}

std::istringstream stream_of(std::string bytes) {
  std::istringstream stream(std::move(bytes), std::ios::binary);
  stream.imbue(std::locale::classic());
  return stream;
}

}  // namespace

TriangleMesh read_stl(std::string_view bytes, const std::string& name) {
  Soup soup;
  std::istringstream stream = stream_of(checked_stl(bytes, name));
  if (!CGAL::IO::read_STL(stream, soup.points, soup.polygons)) throw InputError(name + ": not a readable STL file");
  return to_mesh(soup, name);
}

TriangleMesh read_off(std::string_view bytes, const std::string& name) {
  Soup soup;
  std::istringstream stream = stream_of(checked_off(bytes, name));
  if (!CGAL::IO::read_OFF(stream, soup.points, soup.polygons)) throw InputError(name + ": not a readable OFF file");
  return to_mesh(soup, name);
}

}  // namespace orchard
