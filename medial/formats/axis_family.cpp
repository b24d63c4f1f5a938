// Reads the files that Point2Skeleton writes for one shape. N_center.off has the centres; N_skel_face.obj and
// N_skel_edge.obj have the same vertices with faces and with lines; N_sphere.obj has a mesh of each ball, one after
// another.
#include <algorithm>
#include <cmath>
#include <optional>

#include "axis_text.h"
#include "orchard/geometry/error.h"

namespace orchard::detail {
namespace {

namespace fs = std::filesystem;

constexpr double kSameCenter =
    // Of the largest coordinate: vertices that differ by less are the same, since the files have six digits or more.
    1e-5;
constexpr double kRound = 1e-2;  // of the radius: how far the vertices of a ball's mesh may be from the sphere

struct Family {
  fs::path centers, faces, edges, spheres;
};

// Returns the names of the other files of the family, whether or not they exist.
Family family_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  for (const std::string ending : {"_center", "_skel_face", "_skel_edge"}) {
    if (!stem.ends_with(ending)) continue;
    const std::string base = (file.parent_path() / stem.substr(0, stem.size() - ending.size())).string();
    return {base + "_center.off", base + "_skel_face.obj", base + "_skel_edge.obj", base + "_sphere.obj"};
  }
  fs::path faces = file, centers = file;
  return {centers.replace_extension(".off"), faces.replace_extension(".obj"), {}, {}};
}

bool is_there(const fs::path& file) { return !file.empty() && fs::is_regular_file(file); }

// Adds the cells of another file of the family, which has the same vertices.
void add_cells(ForeignAxis& axis, const ForeignAxis& other, const fs::path& file) {
  const auto differs = [&](const std::string& how) {
    return InputError(file.string() + ": " + how + " than " + axis.files.front().string() +
                      ", and both are parts of one axis by their names");
  };
  if (other.mesh.centers.size() != axis.mesh.centers.size())
    throw differs("has " + std::to_string(other.mesh.centers.size()) + " vertices, other");
  double extent = 0;
  for (const Point& center : axis.mesh.centers) extent = std::max(extent, center.cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < axis.mesh.centers.size(); ++i) {
    if ((axis.mesh.centers[i] - other.mesh.centers[i]).cwiseAbs().maxCoeff() > kSameCenter * extent)
      throw differs("has vertex " + std::to_string(i + 1) + " at another place");
  }
  axis.mesh.edges.insert(axis.mesh.edges.end(), other.mesh.edges.begin(), other.mesh.edges.end());
  axis.mesh.triangles.insert(axis.mesh.triangles.end(), other.mesh.triangles.begin(), other.mesh.triangles.end());
  axis.files.push_back(file);
}

// Sets the radii from the meshes of the balls, all of which have the same number of vertices.
void add_radii(ForeignAxis& axis, const fs::path& file) {
  const std::vector<Point> points = parse_obj_axis(TextLines(file)).mesh.centers;
  const std::size_t balls = axis.mesh.centers.size(), each = points.size() / balls;
  if (each < 4 || each * balls != points.size())
    throw InputError(file.string() + ": " + std::to_string(points.size()) + " vertices are no meshes of " +
                     std::to_string(balls) + " balls, which " + axis.files.front().string() + " has");
  for (std::size_t i = 0; i < balls; ++i) {
    double min = HUGE_VAL, max = 0;
    for (std::size_t k = 0; k < each; ++k) {
      const double distance = (points[i * each + k] - axis.mesh.centers[i]).norm();
      min = std::min(min, distance), max = std::max(max, distance);
    }
    if (max - min > kRound * max)
      throw InputError(file.string() + ": the vertices of ball " + std::to_string(i + 1) +
                       " are not around its centre");
    axis.mesh.radii[i] = max;
  }
  axis.has_radii = true;
  axis.files.push_back(file);
  axis.notes.push_back("radii are those of the balls in " + file.filename().string());
}

}  // namespace

ForeignAxis read_axis_family(const fs::path& file) {
  const auto read = [](const fs::path& one) {
    return one.extension() == ".off" || one.extension() == ".OFF" ? parse_off_axis(TextLines(one))
                                                                  : parse_obj_axis(TextLines(one));
  };
  ForeignAxis axis = read(file);
  axis.files = {file};
  const Family family = family_of(file);
  // Files that merely share a name are not a family: an .off file without faces belongs to the .obj file of the same
  // name.
  const bool named = !family.edges.empty();
  const bool bare = axis.mesh.edges.empty() && file.extension() == ".off" && is_there(family.faces);
  if (!named && !bare) return axis;
  for (const fs::path& other : {family.centers, family.faces, family.edges}) {
    if (is_there(other) && fs::weakly_canonical(other) != fs::weakly_canonical(file))
      add_cells(axis, read(other), other);
  }
  if (!axis.has_radii && is_there(family.spheres)) add_radii(axis, family.spheres);
  complete(axis.mesh);
  return axis;
}

}  // namespace orchard::detail
