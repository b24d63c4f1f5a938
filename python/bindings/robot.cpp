// Spheres for the links of robots, and the formats of planners.
#include "construction.h"
#include "orchard/spheretree/sphere_audit.h"
#include "robot/bodies.h"
#include "robot/formats.h"
#include "robot/kinematics.h"
#include "robot/link_fit.h"

namespace orchard::python {
namespace {

// A robot with the spheres of its links.
struct RobotModel {
  robot::Robot robot;
  std::vector<robot::LinkShape> shapes;
  std::vector<robot::LinkFit> fits;  // of each shape
  std::optional<robot::SelfCollision> self;

  const std::string& link_of(std::size_t shape) const { return robot.links[shapes[shape].link].name; }
};
using RobotPointer = std::shared_ptr<RobotModel>;

Index link_named(const robot::Robot& robot, const std::string& name) {
  const std::optional<Index> link = robot.find_link(name);
  if (!link) throw InputError(robot.file.string() + ": there is no link " + name);
  return *link;
}

SphereFit fit_named(const std::string& name) {
  return named<SphereFit>(
      "fit", name, {{"cover", SphereFit::cover}, {"inside", SphereFit::inside}, {"balanced", SphereFit::balanced}});
}

robot::FitOptions fit_options(const robot::Robot& robot, const py::dict& given,
                              const std::map<std::string, Index>& spheres_of,
                              const std::map<std::string, std::string>& fit_of) {
  robot::FitOptions options{
      .spheres = given["spheres"].cast<Index>(),
      .fit = fit_named(given["fit"].cast<std::string>()),
      .effort = named<Effort>("effort", given["effort"].cast<std::string>(),
                              {{"low", Effort::low}, {"default", Effort::standard}, {"high", Effort::high}}),
      .padding = given["padding"].cast<double>(),
      .seed = given["seed"].cast<std::uint64_t>()};
  for (const auto& [link, number] : spheres_of) options.spheres_of[link_named(robot, link)] = number;
  for (const auto& [link, fit] : fit_of) options.fit_of[link_named(robot, link)] = fit_named(fit);
  return options;
}

RobotPointer fit(const std::filesystem::path& urdf, const std::vector<std::filesystem::path>& packages,
                 const py::dict& given, const std::map<std::string, Index>& spheres_of,
                 const std::map<std::string, std::string>& fit_of, Index states, py::object progress) {
  auto model = std::make_shared<RobotModel>();
  const auto geometry =
      named<robot::Geometry>("geometry", given["geometry"].cast<std::string>(),
                             {{"collision", robot::Geometry::collision}, {"visual", robot::Geometry::visual}});
  model->robot = robot::read_urdf(urdf, {.packages = packages, .geometry = geometry});
  const robot::FitOptions options = fit_options(model->robot, given, spheres_of, fit_of);
  watched(std::move(progress), [&](const Progress& watch) {
    model->shapes = robot::link_shapes(model->robot, {.geometry = geometry}, watch);
    model->fits = robot::fit_links(model->robot, model->shapes, options, watch);
    if (states == 0) return true;
    std::vector<std::vector<Sphere>> spheres;
    for (const robot::LinkFit& one : model->fits) spheres.push_back(one.spheres);
    model->self = robot::sample_self_collision(model->robot, model->shapes, spheres,
                                               {.states = states, .seed = options.seed}, watch);
    return true;
  });
  return model;
}

py::list links(const RobotModel& model) {
  py::list rows;
  for (std::size_t i = 0; i < model.fits.size(); ++i) {
    const robot::LinkFit& one = model.fits[i];
    py::dict row;
    row["name"] = model.link_of(i);
    row["spheres"] = own_rows<double>(sphere_rows(one.spheres));
    row["kept"] = one.kept;
    row["grown"] = one.grown;
    row["audit"] = audit_to_python(one.audit);
    row["notes"] = model.shapes[i].notes;
    rows.append(row);
  }
  return rows;
}

std::vector<std::tuple<std::string, std::string, std::string>> pairs(const RobotModel& model) {
  std::vector<std::tuple<std::string, std::string, std::string>> rows;
  if (!model.self) return rows;
  for (const robot::LinkPair& pair : model.self->pairs)
    rows.emplace_back(model.robot.links[pair.a].name, model.robot.links[pair.b].name, name(pair.verdict));
  return rows;
}

// For each link its name and the rows of a 4 by 4 matrix.
std::vector<std::pair<std::string, std::array<std::array<double, 4>, 4>>> poses(
    const RobotModel& model, const std::map<std::string, double>& joints) {
  const std::vector<robot::Motion> motions = robot::link_motions(model.robot, robot::joint_values(model.robot, joints));
  std::vector<std::pair<std::string, std::array<std::array<double, 4>, 4>>> result;
  for (std::size_t link = 0; link < motions.size(); ++link) {
    auto& [name, rows] = result.emplace_back(model.robot.links[link].name, std::array<std::array<double, 4>, 4>{});
    for (int i = 0; i < 4; ++i)
      for (int k = 0; k < 4; ++k) rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)] = motions[link](i, k);
  }
  return result;
}

std::vector<std::pair<std::string, std::string>> files(const RobotModel& model, const std::string& format,
                                                       const std::string& prefix) {
  std::vector<std::pair<const char*, std::string>> names;
  for (const robot::Format& one : robot::formats()) names.emplace_back(one.name, one.name);
  robot::SphereModel spheres{.robot = &model.robot, .groups = {}, .bodies = {}, .self = model.self, .head = {}};
  for (std::size_t i = 0; i < model.fits.size(); ++i) {
    apps::SphereGroup group;
    group.name = model.link_of(i);
    group.spheres = model.fits[i].spheres;
    spheres.bodies.push_back(robot::body_of(model.robot.links[model.shapes[i].link], &model.shapes[i], group.spheres));
    spheres.groups.push_back(std::move(group));
  }
  std::vector<std::pair<std::string, std::string>> result;
  for (robot::FormatFile& file :
       robot::write_format(named<std::string>("format", format, names), spheres, {.prefix = prefix}))
    result.emplace_back(std::move(file.name), std::move(file.text));
  return result;
}

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const robot::Format& format : robot::formats()) names.emplace_back(format.name);
  return names;
}

}  // namespace

void bind_robot(py::module_& module) {
  py::class_<RobotModel, RobotPointer>(module, "Robot")
      .def("name", [](const RobotModel& model) { return model.robot.name; })
      .def("notes", [](const RobotModel& model) { return model.robot.notes; })
      .def("links", &links)
      .def("pairs", &pairs)
      .def("poses", &poses)
      .def("files", &files);
  module.def("fit_robot", &fit);
  module.def("robot_formats", &format_names);
}

}  // namespace orchard::python
