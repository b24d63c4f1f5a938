#include "show/view_files.h"

#ifdef ORCHARD_HAS_VIZ
#include <fmt/core.h>
#include <tinyxml2.h>

#include <algorithm>
#include <map>

#include "input/input_file.h"
#include "input/mesh_input.h"
#include "input/reading_report.h"
#include "orchard/geometry/error.h"
#include "orchard/spheretree/ball_tree.h"
#include "orchard/voronoi/diagram_io.h"
#include "output/sphere_lists.h"
#include "spheres/sphere_files.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

bool is_view(const fs::path& file) {
  const std::string extension = lower_extension(file);
  return extension == ".vtp" || extension == ".vtu";
}

// All spheres of a set, as the second level of a tree.
SphereTree set_of(const fs::path& file) {
  std::vector<Sphere> spheres;
  for (const SphereGroup& group : read_sphere_file(file).groups)
    spheres.insert(spheres.end(), group.spheres.begin(), group.spheres.end());
  return ball_tree(spheres, static_cast<Index>(std::max<std::size_t>(2, spheres.size())));
}

}  // namespace

std::vector<TimeStep> read_series(const fs::path& pvd) {
  tinyxml2::XMLDocument document;
  document.Parse(content_of(pvd).c_str());
  const tinyxml2::XMLElement* collection = nullptr;
  if (const auto* root = document.FirstChildElement("VTKFile")) collection = root->FirstChildElement("Collection");
  if (collection == nullptr)
    throw InputError(pvd.string() + ": this is no collection of ParaView; expected <VTKFile> with a <Collection>");
  std::map<double, TimeStep> steps;
  for (const auto* part = collection->FirstChildElement("DataSet"); part != nullptr;
       part = part->NextSiblingElement("DataSet")) {
    const char* const name = part->Attribute("file");
    if (name == nullptr)
      throw InputError(fmt::format("{}: line {}: a <DataSet> names no file", pvd.string(), part->GetLineNum()));
    const fs::path file = pvd.parent_path() / name;
    if (!is_view(file))
      throw InputError(fmt::format("{}: line {}: {} cannot be drawn; expected .vtp or .vtu", pvd.string(),
                                   part->GetLineNum(), file.string()));
    check_input(file);
    const double time = part->DoubleAttribute("timestep", 0);
    steps[time].time = time;
    steps[time].files.push_back(file);
  }
  if (steps.empty()) throw InputError(pvd.string() + ": the series has no time step");
  std::vector<TimeStep> series;
  series.reserve(steps.size());
  for (auto& [time, step] : steps) series.push_back(std::move(step));
  return series;
}

std::size_t length_of(const SeriesList& all) {
  std::size_t length = 0;
  for (const auto& series : all) length = std::max(length, series.size());
  return length;
}

void show_step(std::size_t step, const SeriesList& all, std::size_t still, Scene& scene) {
  scene.data.erase(scene.data.begin() + static_cast<std::ptrdiff_t>(still), scene.data.end());
  for (const auto& series : all)
    for (const std::filesystem::path& file : series[std::min(step, series.size() - 1)].files)
      scene.data.push_back({file.filename().string(), file});
}

std::optional<Box> room_of(const SeriesList& all) {
  std::vector<std::filesystem::path> files;
  for (const auto& series : all)
    for (const TimeStep& step : series) files.insert(files.end(), step.files.begin(), step.files.end());
  const Box box = bounds_of_data(files);
  return box.isEmpty() ? std::nullopt : std::optional(box);
}

void add_file(const fs::path& file, const MeshInput& input, Scene& scene, bool talk) {
  const std::string extension = lower_extension(file), name = file.filename().string();
  if (extension == ".orchard" || extension == ".sph") {
    scene.trees.push_back({name, *read_spheres(file).tree});
  } else if (extension == ".txt" || extension == ".csv" || extension == ".json") {
    scene.trees.push_back({name, set_of(file)});
  } else if (extension == ".ma") {
    scene.axes.push_back({name, read_ma(file)});
  } else if (is_view(file)) {
    scene.data.push_back({name, file});
  } else if (extension == ".vor") {
    scene.diagrams.push_back({name, read_vor(file)});
  } else {
    auto [mesh, reading] = read_input_or_points(file, input);
    if (talk) print_reading(file, reading);
    if (mesh.triangles.empty()) {
      scene.points.push_back({name, std::move(mesh.vertices)});
    } else {
      scene.meshes.push_back({name, Surface(std::move(mesh))});
    }
  }
}

}  // namespace orchard::apps
#endif
