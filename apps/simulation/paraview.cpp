#include "paraview.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <sstream>
#include <vector>

#include "orchard/geometry/base64.h"

namespace orchard::simulation {
namespace {

// Corners by the bits of their numbers: x, y, z.
constexpr unsigned kCubeFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                       {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

constexpr double kHorizon = 1;  // of promises without an end, for the hypertrapezoid's slope

class Array {
 public:
  Array(const char* name, const char* type, int components = 1) {
    values_.precision(9);
    values_ << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << components
            << "\" format=\"ascii\">\n";
  }
  template <class Value>
  void add(const Value& value) {
    values_ << value << ' ';
  }
  void add(const Vec3& v) {
    for (const double x : v) values_ << x << ' ';
  }
  std::string text() const { return values_.str() + "\n</DataArray>\n"; }

 private:
  std::ostringstream values_;
};

// Numbers with gaps: NaN, which ParaView does not read as text, so that they are written as base64.
class NumbersWithGaps {
 public:
  explicit NumbersWithGaps(const char* name) : name_(name) {}
  void add(double value) { values_.push_back(std::isfinite(value) ? value : std::nan("")); }
  std::string text() const {
    std::string bytes(sizeof(std::uint32_t) + values_.size() * sizeof(double), '\0');
    const auto size = static_cast<std::uint32_t>(values_.size() * sizeof(double));
    std::memcpy(bytes.data(), &size, sizeof size);
    if (size > 0) std::memcpy(bytes.data() + sizeof size, values_.data(), size);
    return std::string("<DataArray type=\"Float64\" Name=\"") + name_ + "\" format=\"binary\">\n" + base64(bytes) +
           "\n</DataArray>\n";
  }

 private:
  const char* name_;
  std::vector<double> values_;
};

std::string dataset(std::size_t points, const std::string& coordinates, const std::string& point_data,
                    std::size_t verts, std::size_t lines, std::size_t polygons, const std::string& cells,
                    const std::string& cell_data) {
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<PolyData>\n"
      << "<Piece NumberOfPoints=\"" << points << "\" NumberOfVerts=\"" << verts << "\" NumberOfLines=\"" << lines
      << "\" NumberOfStrips=\"0\" NumberOfPolys=\"" << polygons << "\">\n<Points>\n"
      << coordinates << "</Points>\n<PointData>\n"
      << point_data << "</PointData>\n"
      << cells << "<CellData>\n"
      << cell_data << "</CellData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  return out.str();
}

std::string cells(const char* kind, const Array& connectivity, const Array& offsets) {
  std::ostringstream out;
  out << '<' << kind << ">\n" << connectivity.text() << offsets.text() << "</" << kind << ">\n";
  return out.str();
}

}  // namespace

CrossSection cross_section(const Detection::Promise& promise, double time) {
  const Motion& motion = promise.motion;
  const auto radius_after = [&](double s) {
    return motion.radius + motion.drift * s + motion.acceleration * s * s / 2;
  };
  const double s = time - promise.since, ends = std::min(motion.expiry - promise.since, std::max(s, kHorizon));
  // The hypertrapezoid goes from the radius at the start straight to what the horn has at the end.
  const double half = motion.radius + (ends > 0 ? s / ends : 0) * (radius_after(ends) - motion.radius);
  return {motion.position + s * motion.velocity, radius_after(s), half};
}

std::string bodies_vtp(const Simulation& simulation) {
  const World& world = simulation.world();
  std::vector<int> answers(world.bodies.size(), 0);
  for (const PairOutcome& pair : simulation.pairs())
    for (const std::uint32_t body : {pair.a, pair.b})
      answers[body] = std::max(answers[body], static_cast<int>(pair.verdict.answer) + 1);
  Array points("Points", "Float64", 3), lines("connectivity", "Int64"), line_ends("offsets", "Int64"),
      polygons("connectivity", "Int64"), polygon_ends("offsets", "Int64");
  // Of lines first, then of triangles; what is not said of one is -1 there, and NaN as a bound.
  Array body("body", "Int32"), answer("answer", "Int32"), level("level", "Int32"), work("work", "Int64");
  NumbersWithGaps bound("separation_bound");
  std::size_t count = 0, line_count = 0, polygon_count = 0;
  for (const PairOutcome& pair : simulation.pairs()) {
    points.add(world.bodies[pair.a].position);
    points.add(world.bodies[pair.b].position);
    lines.add(count);
    lines.add(count + 1);
    count += 2;
    line_ends.add(2 * ++line_count);
    body.add(-1);
    answer.add(static_cast<int>(pair.verdict.answer) + 1);
    level.add(pair.verdict.level);
    bound.add(pair.verdict.separation_bound);
    work.add(pair.verdict.work);
  }
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
    if (!world.bodies[i].there) continue;
    const Shape& shape = world.shapes[world.bodies[i].shape];
    const Pose pose = pose_of(world.bodies[i], shape);
    for (const auto& v : shape.tree.vertices)
      points.add(Vec3(runtime::transform(
          pose, {v[0] + shape.tree.origin[0], v[1] + shape.tree.origin[1], v[2] + shape.tree.origin[2]})));
    for (const auto& triangle : shape.tree.triangles) {
      for (const std::uint32_t corner : triangle) polygons.add(count + corner);
      polygon_ends.add(3 * ++polygon_count);
      body.add(i);
      answer.add(answers[i]);
      level.add(-1);
      bound.add(std::nan(""));
      work.add(-1);
    }
    count += shape.tree.vertices.size();
  }
  return dataset(count, points.text(), "", 0, line_count, polygon_count,
                 cells("Lines", lines, line_ends) + cells("Polys", polygons, polygon_ends),
                 body.text() + answer.text() + level.text() + bound.text() + work.text());
}

std::string bounds_vtp(const Simulation& simulation) {
  const World& world = simulation.world();
  Array points("Points", "Float64", 3), verts("connectivity", "Int64"), vert_ends("offsets", "Int64"),
      polygons("connectivity", "Int64"), polygon_ends("offsets", "Int64");
  // A cube's corners have the horn's radius 0, so that no sphere is drawn around them.
  Array horn("horn_radius", "Float64"), half("hypertrapezoid_half", "Float64"), body("body", "Int32");
  std::size_t count = 0, bodies = 0, faces = 0;
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
    if (!world.bodies[i].there || world.bodies[i].fixed) continue;
    const CrossSection section = cross_section(world.detection.promises()[i], world.time);
    points.add(section.middle);
    horn.add(section.horn);
    verts.add(count);
    vert_ends.add(++bodies);
    for (unsigned corner = 0; corner < 8; ++corner) {
      Vec3 place = section.middle;
      for (unsigned axis = 0; axis < 3; ++axis)
        place[axis] += (corner >> axis & 1u) != 0 ? section.half : -section.half;
      points.add(place);
      horn.add(0);
    }
    for (const auto& face : kCubeFaces) {
      for (const unsigned corner : face) polygons.add(count + 1 + corner);
      polygon_ends.add(4 * ++faces);
    }
    for (int point = 0; point < 9; ++point) {
      half.add(section.half);
      body.add(i);
    }
    count += 9;
  }
  return dataset(count, points.text(), horn.text() + half.text() + body.text(), bodies, 0, faces,
                 cells("Verts", verts, vert_ends) + cells("Polys", polygons, polygon_ends), "");
}

std::string frame_file(std::size_t frame, const char* part) {
  char name[48];
  std::snprintf(name, sizeof name, "frame-%05zu-%s.vtp", frame, part);
  return name;
}

std::string run_pvd(const std::vector<double>& times, const std::string& prefix) {
  std::ostringstream out;
  out.precision(12);
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (std::size_t i = 0; i < times.size(); ++i) {
    int part = 0;
    for (const char* name : {"bodies", "bounds"})
      out << "<DataSet timestep=\"" << times[i] << "\" part=\"" << part++ << "\" file=\"" << prefix
          << frame_file(i, name) << "\"/>\n";
  }
  out << "</Collection>\n</VTKFile>\n";
  return out.str();
}

}  // namespace orchard::simulation
