#include "orchard/viz/view.h"

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "drawing.h"
#include "orchard/viz/medial_writer.h"
#include "orchard/viz/voronoi_writer.h"
#include "palette.h"

namespace orchard {
namespace {

namespace fs = std::filesystem;

// Writes the files of a scene, with names that view_parts() can read.
class SceneFiles {
 public:
  explicit SceneFiles(const fs::path& prefix) : prefix_(prefix) {}

  fs::path add(const std::string& name, const char* ending) {
    fs::path file = with_ending(prefix_, "-" + std::to_string(files_.size()) + ending);
    // Two files of the same name become two blocks.
    std::string block = name;
    for (int i = 2; std::any_of(files_.begin(), files_.end(), [&](const NamedFile& f) { return f.name == block; }); ++i)
      block = name + " (" + std::to_string(i) + ")";
    files_.push_back({block, file.filename()});
    return file;
  }
  void write() const { write_multiblock(with_ending(prefix_, ".vtm"), files_); }

 private:
  fs::path prefix_;
  std::vector<NamedFile> files_;
};

Index depth_of(const Scene& scene) {
  Index depth = 0;
  for (const auto& tree : scene.trees) depth = std::max(depth, tree.value.depth());
  return depth;
}

void write_scene(const fs::path& prefix, const Scene& scene, const std::set<Index>& levels) {
  SceneFiles files(prefix);
  for (const auto& [name, surface] : scene.meshes) write_mesh(files.add("view/mesh/" + name, ".vtp"), surface);
  for (const auto& [name, axis] : scene.axes) write_medial_mesh(files.add("view/axis/" + name, ".vtp"), axis);
  for (const auto& [name, diagram] : scene.diagrams)
    write_voronoi_cells(files.add("view/cells/" + name, ".vtu"), diagram);
  for (const auto& [name, file] : scene.data)
    std::filesystem::copy_file(file, files.add("view/data/" + name, file.extension().c_str()));
  for (const auto& [name, points] : scene.points) {
    SurfaceSampling sampling;
    sampling.points = points;
    sampling.origins.resize(points.size());
    sampling.triangles.resize(points.size());
    write_points(files.add("view/points/" + name, ".vtp"), sampling);
  }
  for (const auto& [name, tree] : scene.trees)
    for (const Index level : levels)
      write_tree_level(files.add("view/level/" + std::to_string(level) + "/" + name, ".vtp"), tree, level);
  files.write();
}

template <class Reader>
vtkSmartPointer<vtkPointSet> points_of(const fs::path& file) {
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return vtkPointSet::SafeDownCast(reader->GetOutputAsDataSet());
}

std::string all_digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

template <class Numbers>
std::string listed(const Numbers& numbers) {
  std::string list;
  for (const double value : numbers) list += (list.empty() ? "" : ",") + all_digits(value);
  return list;
}

std::vector<std::string> arguments_of(const Figure& figure) {
  std::vector<std::string> arguments;
  const auto add = [&](const char* option, const std::string& value) {
    arguments.emplace_back(option);
    arguments.push_back(value);
  };
  if (!figure.color.empty()) add("--color", figure.color);
  if (!figure.bar_title.empty()) add("--bar-title", figure.bar_title);
  add("--map", figure.map);
  if (figure.room) {
    const Point &low = figure.room->min(), &high = figure.room->max();
    add("--room", listed(std::array{low.x(), low.y(), low.z(), high.x(), high.y(), high.z()}));
  }
  if (figure.range) add("--range", listed(*figure.range));
  if (figure.look_at)
    add("--look-at", listed(std::array{figure.look_at->x(), figure.look_at->y(), figure.look_at->z()}));
  if (figure.span > 0) add("--span", all_digits(figure.span));
  if (figure.clip) add("--clip", listed(*figure.clip));
  for (const auto& [flag, on] : {std::pair{"--edges", figure.edges},
                                 {"--balls", figure.balls},
                                 {"--beside", figure.beside},
                                 {"--no-captions", !figure.captions},
                                 {"--transparent", figure.transparent},
                                 {"--steady", figure.steady}})
    if (on) arguments.emplace_back(flag);
  return arguments;
}

}  // namespace

std::vector<std::string> color_arrays(const Scene& scene) {
  std::set<std::string> names;
  if (!scene.axes.empty()) names.insert({"radius", "structure", "structure_kind"});
  if (!scene.trees.empty())
    names.insert({"radius", "error", "inaccuracy", "level", "node", "parent", "branch", "carried"});
  if (!scene.meshes.empty()) names.insert("cluster");
  const std::regex array("<DataArray[^>]* Name=\"([^\"]*)\"[^>]*>");
  for (const auto& [name, file] : scene.data) {
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
      std::smatch found;
      if (line.find("<DataArray") == std::string::npos || !std::regex_search(line, found, array)) continue;
      const std::string& own = found[1];
      const bool one = line.find("NumberOfComponents") == std::string::npos ||
                       line.find("NumberOfComponents=\"1\"") != std::string::npos;
      if (one && own != "Points" && own != "connectivity" && own != "offsets" && own != "types") names.insert(own);
    }
  }
  return {names.begin(), names.end()};
}

std::vector<std::string> color_map_names() {
  std::vector<std::string> names;
  names.reserve(std::size(detail::kColorMaps));
  for (const detail::ColorMap& map : detail::kColorMaps) names.emplace_back(map.name);
  return names;
}

Box bounds_of_data(const std::vector<fs::path>& files) {
  Box box;
  for (const fs::path& file : files) {
    const vtkSmartPointer<vtkPointSet> data = file.extension() == ".vtu" ? points_of<vtkXMLUnstructuredGridReader>(file)
                                                                         : points_of<vtkXMLPolyDataReader>(file);
    vtkDataArray* radii = data->GetPointData()->GetArray("radius");
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
      Point center;
      data->GetPoint(i, center.data());
      const double radius = radii == nullptr ? 0 : radii->GetComponent(i, 0);
      box.extend(center - Point::Constant(radius));
      box.extend(center + Point::Constant(radius));
    }
  }
  return box;
}

PictureStatus draw_view(const fs::path& png, const Scene& scene, const PipelinePicture& picture) {
  std::set<Index> levels(scene.levels.begin(), scene.levels.end());
  if (levels.empty()) levels.insert(depth_of(scene));
  std::vector<std::string> more = arguments_of(scene.figure);
  more.insert(more.end(), {"--opacity", std::to_string(scene.opacity)});
  return detail::draw(png, picture, more, [&](const fs::path& prefix) { write_scene(prefix, scene, levels); });
}

PictureStatus show_view(const fs::path& png, const Scene& scene, const PipelinePicture& picture) {
  std::set<Index> levels;
  for (Index level = 0; level <= depth_of(scene); ++level) levels.insert(level);
  std::vector<std::string> more{"--window", "--opacity", std::to_string(scene.opacity)};
  if (!scene.levels.empty()) {
    more.emplace_back("--level");
    more.push_back(std::to_string(scene.levels.front()));
  }
  return detail::show(png, picture, more, [&](const fs::path& prefix) { write_scene(prefix, scene, levels); });
}

}  // namespace orchard
