// JSON and CSV.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "orchard/geometry/error.h"
#include "robot/format_text.h"

namespace orchard::robot {
namespace {

using nlohmann::ordered_json;

ordered_json numbers_of(const Point& point) { return {point.x(), point.y(), point.z()}; }

// What {centers, radii} holds of spheres.
ordered_json columns(const std::vector<Sphere>& spheres) {
  ordered_json centers = ordered_json::array(), radii = ordered_json::array();
  for (const Sphere& sphere : spheres) {
    centers.push_back(numbers_of(sphere.center));
    radii.push_back(sphere.radius);
  }
  return {{"centers", std::move(centers)}, {"radii", std::move(radii)}};
}

// The link's mass, shared in proportion to the spheres' volumes.
std::vector<double> masses_of(const apps::SphereGroup& group, const Inertial& body) {
  if (group.masses.size() == group.spheres.size()) return group.masses;
  std::vector<double> masses;
  for (const Sphere& sphere : group.spheres) masses.push_back(std::pow(sphere.radius, 3));
  const double sum = std::accumulate(masses.begin(), masses.end(), 0.0);
  for (double& mass : masses) mass *= body.mass / sum;
  return masses;
}

// The frame of a collision element's mesh, which has a scale and an origin; of another element, its origin alone.
struct MeshFrame {
  Motion to_mesh = Motion::Identity();
  Vector scale = Vector::Ones();
  double size = 1;  // of lengths

  Sphere in(const Sphere& sphere) const {
    const Point center = (to_mesh * sphere.center).cwiseQuotient(scale);
    const bool same = to_mesh.isApprox(Motion::Identity(), 0) && scale == Vector::Ones();
    return {center, same ? sphere.radius : sphere.radius / size * (1 + 0x1p-44) + 0x1p-46 * center.norm()};
  }
};

MeshFrame frame_of(const SphereModel& model, const Link& link, const Element& element) {
  const Vector size = element.scale.cwiseAbs();
  if (size.maxCoeff() - size.minCoeff() > 1e-12 * size.maxCoeff())
    throw InputError(
        fmt::format("{}, line {}: link {}: in the frame of an unevenly scaled mesh spheres would not be round; "
                    "leave morphit out of --export",
                    model.robot->file.string(), element.line, link.name));
  return {element.origin.inverse(), element.scale, size.x()};
}

// The element around whose origin a sphere lies nearest: a link's spheres belong to all of its elements together, and
// any share of them will do for readers that put them together again.
std::size_t nearest_element(const Link& link, const Sphere& sphere) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < link.collision.size(); ++e) {
    const double distance = (link.collision[e].origin.translation() - sphere.center).norm();
    if (distance < least) {
      least = distance;
      nearest = e;
    }
  }
  return nearest;
}

void add_morphit_files(const SphereModel& model, std::size_t g, const std::string& stem, Files& files) {
  const apps::SphereGroup& group = model.groups[g];
  const Link& link = model.robot->links[*model.robot->find_link(group.name)];
  const std::vector<double> masses = masses_of(group, model.bodies[g]);
  const std::size_t elements = std::max<std::size_t>(1, link.collision.size());
  for (std::size_t e = 0; e < elements; ++e) {
    const MeshFrame frame = link.collision.empty() ? MeshFrame{} : frame_of(model, link, link.collision[e]);
    std::vector<Sphere> own;
    std::vector<double> own_masses;
    for (std::size_t s = 0; s < group.spheres.size(); ++s) {
      if (!link.collision.empty() && nearest_element(link, group.spheres[s]) != e) continue;
      own.push_back(frame.in(group.spheres[s]));
      own_masses.push_back(masses[s]);
    }
    if (own.empty()) continue;
    ordered_json json = columns(own);
    json["masses"] = own_masses;
    json["mesh_path"] = link.collision.empty() ? "" : link.collision[e].written;
    json["num_spheres"] = own.size();
    files.push_back({fmt::format("{}_{}.json", stem, e), json.dump(1) + "\n",
                     g == 0 && e == 0 ? "and one for each other mesh, for MorphIt's readers" : ""});
  }
}

std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"\n") == std::string::npos) return name;
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

}  // namespace

ordered_json to_json(const SelfCollision& self, const Robot& robot) {
  ordered_json pairs = ordered_json::array();
  for (const LinkPair& pair : self.pairs)
    pairs.push_back({{"links", {robot.links[pair.a].name, robot.links[pair.b].name}},
                     {"ignored", pair.ignored()},
                     {"reason", name(pair.verdict)},
                     {"states_touching", pair.touching},
                     {"states_spheres_touching", pair.spheres_touching}});
  return {{"states", self.states}, {"seed", self.seed}, {"pairs", std::move(pairs)}};
}

Files write_ballpark(const SphereModel& model, const FormatOptions& options) {
  ordered_json links = ordered_json::object();
  for (const apps::SphereGroup& group : model.groups) links[group.name] = columns(group.spheres);
  return {{options.prefix + "-ballpark.json", links.dump(1) + "\n", "for ballpark's readers"}};
}

Files write_morphit(const SphereModel& model, const FormatOptions&) {
  Files files;
  const std::vector<std::string> stems = file_stems(model);
  for (std::size_t g = 0; g < model.groups.size(); ++g) add_morphit_files(model, g, stems[g], files);
  return files;
}

Files write_foam(const SphereModel& model, const FormatOptions& options) {
  Files files;
  const std::vector<std::string> stems = file_stems(model);
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    ordered_json spheres = ordered_json::array();
    for (const Sphere& sphere : model.groups[g].spheres)
      spheres.push_back({{"origin", numbers_of(sphere.center)}, {"radius", sphere.radius}});
    const ordered_json levels = ordered_json::array({{{"spheres", std::move(spheres)}}});
    files.push_back({fmt::format("{}-foam-{}.json", options.prefix, stems[g]), levels.dump(1) + "\n",
                     g == 0 ? "and one for each other link, for foam's readers" : ""});
  }
  return files;
}

Files write_csv(const SphereModel& model, const FormatOptions& options) {
  std::string text = "x,y,z,r,link\n";
  for (const apps::SphereGroup& group : model.groups)
    for (const Sphere& sphere : group.spheres)
      text += fmt::format("{},{},{}\n", point_text(sphere.center, ","), float_text(sphere.radius), quoted(group.name));
  return {{options.prefix + "-spheres.csv", text, "the spheres as a table"}};
}

Files write_json(const SphereModel& model, const FormatOptions& options) {
  ordered_json links = ordered_json::object();
  for (std::size_t g = 0; g < model.groups.size(); ++g) {
    ordered_json& link = links[model.groups[g].name] = columns(model.groups[g].spheres);
    link["masses"] = masses_of(model.groups[g], model.bodies[g]);
  }
  ordered_json json{
      {"robot", model.robot->name}, {"urdf", model.robot->file.filename().string()}, {"about", model.head}};
  if (model.buffer != 0) json["buffer"] = model.buffer;
  json["collision_spheres"] = std::move(links);
  if (model.self) json["self_collision"] = to_json(*model.self, *model.robot);
  return {{options.prefix + "-spheres.json", json.dump(1) + "\n", "the spheres, and which pairs need no test"}};
}

}  // namespace orchard::robot
