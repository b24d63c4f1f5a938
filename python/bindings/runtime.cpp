// The module orchard_geometry._runtime: it links the run-time alone, and is under its licence.
#include "runtime_types.h"

#include <chrono>
#include <optional>

#include "errors.h"
#include "orchard/runtime/pose.h"
#include "orchard/runtime/tree_file.h"

namespace orchard::python {
namespace {

// Nodes in breadth-first order, as a file's readers number them.
struct Place {
  std::uint32_t block, lane;
};

[[noreturn]] void refuse_pose(std::size_t number, const std::string& why) {
  throw py::value_error("poses[" + std::to_string(number) + "]: " + why);
}

Pose pose_of_matrix(const double* m, std::size_t number) {
  if (!std::all_of(m, m + 16, [](double x) { return std::isfinite(x); })) refuse_pose(number, "not finite");
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    refuse_pose(number, "the last row of the matrix is not 0 0 0 1; translations are in the last column");
  // The determinant of the upper left part is the cube of the scale.
  const double determinant =
      m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
  if (!(determinant > 0)) refuse_pose(number, "the matrix is no rotation: it is singular or mirrors");
  double scale = std::cbrt(determinant);
  if (std::fabs(scale - 1) < 1e-6) scale = 1;  // rounding of a matrix without scale
  Pose pose{.rotation = {m[0] / scale, m[1] / scale, m[2] / scale, m[4] / scale, m[5] / scale, m[6] / scale,
                         m[8] / scale, m[9] / scale, m[10] / scale},
            .translation = {m[3], m[7], m[11]},
            .scale = scale};
  if (is_rigid(pose)) return pose;
  if (const std::optional<Pose> repaired = made_rigid(pose)) return *repaired;
  refuse_pose(number, "not rigid: the matrix shears, or scales differently along its axes");
}

Pose pose_of_quaternion(const double* p, bool wxyz, std::size_t number) {
  const std::array<double, 4> q = wxyz ? std::array{p[3], p[4], p[5], p[6]} : std::array{p[6], p[3], p[4], p[5]};
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!std::isfinite(norm) || !std::all_of(p, p + 3, [](double x) { return std::isfinite(x); }))
    refuse_pose(number, "not finite");
  if (std::fabs(norm - 1) > 1e-5)
    refuse_pose(number, "the quaternion has length " + std::to_string(norm) +
                            ", not 1; normalise it, and check the order: quaternion='wxyz' or 'xyzw'");
  const std::optional<Pose> pose = runtime::pose_from_quaternion(q, to_vec(p));
  if (!pose) refuse_pose(number, "the quaternion is no rotation");
  return *pose;
}

std::size_t columns_of(const py::buffer& rows) {
  const py::buffer_info info = rows.request();
  const py::ssize_t columns = info.ndim == 2 ? info.shape[1] : 0;
  if (columns != 7 && columns != 16) throw py::value_error("poses: expected (k, 7) or (k, 4, 4)");
  return static_cast<std::size_t>(columns);
}

runtime::PackedSphereTree checked(runtime::LoadStatus status, runtime::PackedSphereTree tree, const std::string& name) {
  if (status != runtime::LoadStatus::ok) throw py::value_error(name + ": " + runtime::message(status));
  return tree;
}

TreePointer load_tree(const std::filesystem::path& file) {
  const py::gil_scoped_release release;
  runtime::PackedSphereTree tree;
  const auto status = runtime::load_file(file.c_str(), tree);
  return std::make_shared<Tree>(checked(status, std::move(tree), file.string()));
}

TreePointer tree_of_bytes(const py::buffer& bytes) {
  const Input<std::uint8_t> input(bytes, 0);
  const py::gil_scoped_release release;
  runtime::PackedSphereTree tree;
  const auto status = runtime::load(std::as_bytes(std::span(input.row(0), input.size())), tree);
  return std::make_shared<Tree>(checked(status, std::move(tree), "bytes"));
}

py::bytes bytes_of(const Tree& tree) {
  const std::vector<std::byte> bytes = runtime::serialize(tree.packed);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

template <class T>
Array node_view(const TreePointer& tree, std::vector<T> Tree::*values) {
  return view_rows<T>(tree, (*tree).*values);
}

}  // namespace

Tree::Tree(runtime::PackedSphereTree tree) : packed(std::move(tree)), prepared(packed) {
  std::vector<Place> places{{0, 0}};
  parents.push_back(-1);
  levels.push_back(0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto [at, lane] = places[i];
    const runtime::SiblingBlock& block = packed.blocks[at];
    spheres.push_back({packed.origin[0] + double{block.x[lane]}, packed.origin[1] + double{block.y[lane]},
                       packed.origin[2] + double{block.z[lane]}, double{block.radius[lane]}});
    errors.push_back(double{block.error[lane]});
    depths.push_back(double{block.depth[lane]});
    const bool leaf = (block.link[lane] & runtime::kLeafBit) != 0;
    leaves.push_back(leaf ? 1 : 0);
    if (leaf) continue;
    const auto [first, count] = runtime::children_of(packed.branching, block.link[lane]);
    for (std::uint32_t child = 0; child < count; ++child) {
      places.push_back({first + child / runtime::kBlockWidth, child % runtime::kBlockWidth});
      parents.push_back(static_cast<std::int64_t>(i));
      levels.push_back(levels[i] + 1);
    }
  }
}

Pose to_pose(const double* numbers, std::size_t count, bool wxyz, std::size_t number) {
  return count == 16 ? pose_of_matrix(numbers, number) : pose_of_quaternion(numbers, wxyz, number);
}

PoseRows::PoseRows(const py::buffer& rows, bool wxyz)
    : columns_(columns_of(rows)), input_(rows, static_cast<py::ssize_t>(columns_)), wxyz_(wxyz) {}

Pose to_single_pose(const py::buffer& row, bool wxyz) {
  const PoseRows poses(row, wxyz);
  if (poses.size() != 1) throw py::value_error("pose: expected one");
  return poses[0];
}

runtime::Budget to_budget(std::uint64_t work, double seconds) {
  runtime::Budget budget;
  if (work > 0) budget.work = work;
  constexpr double kLongest = 1e9;  // beyond it, nanoseconds overflow
  if (seconds < kLongest)
    budget.time = std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(seconds));
  return budget;
}

void bind_trees(py::module_& module) {
  py::class_<Tree, TreePointer>(module, "Tree", "A certified sphere-tree as the run-time has it.")
      .def_static("load", &load_tree)
      .def_static("from_bytes", &tree_of_bytes)
      .def_static("of_box", [](const Vec& half) { return std::make_shared<Tree>(runtime::box_tree(half)); })
      .def_static("of_triangles",
                  [](const py::buffer& vertices, const py::buffer& triangles) {
                    return std::make_shared<Tree>(runtime::triangles_tree(
                        Input<double>(vertices, 3).rows<Vec>(),
                        Input<std::uint32_t>(triangles, 3).rows<std::array<std::uint32_t, 3>>()));
                  })
      .def_static("of_hull",
                  [](const py::buffer& points) {
                    auto tree = runtime::hull_tree(Input<double>(points, 3).rows<Vec>());
                    if (!tree) throw py::value_error("points: they lie in a plane, so that they have no convex hull");
                    return std::make_shared<Tree>(std::move(*tree));
                  })
      .def("to_bytes", &bytes_of)
      .def("spheres", [](const TreePointer& t) { return view_rows<double>(t, t->spheres); })
      .def("parents", [](const TreePointer& t) { return node_view<std::int64_t>(t, &Tree::parents); })
      .def("levels", [](const TreePointer& t) { return node_view<std::int32_t>(t, &Tree::levels); })
      .def("errors", [](const TreePointer& t) { return node_view<double>(t, &Tree::errors); })
      .def("depths", [](const TreePointer& t) { return node_view<double>(t, &Tree::depths); })
      .def("leaves", [](const TreePointer& t) { return node_view<std::uint8_t>(t, &Tree::leaves); })
      .def("vertices", [](const TreePointer& t) { return view_rows<float>(t, t->packed.vertices); })
      .def("triangles", [](const TreePointer& t) { return view_rows<std::uint32_t>(t, t->packed.triangles); })
      .def_property_readonly("origin", [](const Tree& t) { return t.packed.origin; })
      .def_property_readonly("depth", [](const Tree& t) { return t.packed.depth; })
      .def_property_readonly("branching", [](const Tree& t) { return t.packed.branching; })
      .def_property_readonly("bounding_radius", [](const Tree& t) { return t.packed.bounding_radius; })
      .def_property_readonly("vertex_error", [](const Tree& t) { return t.packed.vertex_error; });
}

}  // namespace orchard::python

PYBIND11_MODULE(_runtime, module) {
  using namespace orchard::python;
  module.doc() = "Sphere-trees and collision answers: orchard's run-time, under the MIT licence.";
  module.attr("version") = ORCHARD_VERSION;
  bind_array(module);
  bind_trees(module);
  bind_pair_queries(module);
  bind_shape_queries(module);
  bind_broad_phase(module);
  bind_detector(module);
}
