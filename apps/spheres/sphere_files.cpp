#include "spheres/sphere_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "input/input_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/ply_tables.h"
#include "output/sphere_lists.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;

SphereFile read_ply(const fs::path& file) {
  const PlyTables ply(file);
  const PlyTables::Table* vertices = ply.find("vertex");
  if (vertices == nullptr)
    throw InputError(file.string() + ": the file has no element vertex; write one with x, y, z and radius");
  const auto column = [&](std::initializer_list<const char*> names) -> const PlyTables::Column& {
    for (const char* name : names)
      if (const PlyTables::Column* found = vertices->find(name); found != nullptr && !found->list) return *found;
    throw InputError(fmt::format("{}: its vertices have no property {}", file.string(), *names.begin()));
  };
  const auto &x = column({"x"}), &y = column({"y"}), &z = column({"z"}), &r = column({"radius", "r"});
  SphereGroup group;
  for (std::size_t i = 0; i < vertices->rows(); ++i)
    add_sphere(group, Point(x.numbers[i], y.numbers[i], z.numbers[i]), r.numbers[i],
               fmt::format("{}: vertex {}", file.string(), i));
  return {"PLY with radii", {std::move(group)}};
}

// The leaves, wherever they end.
SphereFile read_tree(const fs::path& file) {
  const SphereLists lists = read_spheres(file);
  SphereGroup group;
  for (const Level* level : {&lists.levels.back(), &lists.carried.back()})
    for (const Sphere& sphere : *level) add_sphere(group, sphere.center, sphere.radius, file.string());
  return {"the leaves of a tree", {std::move(group)}};
}

SphereFile read_by_ending(const fs::path& file) {
  const std::string ending = lower_extension(file);
  if (ending == ".json") return read_json_spheres(file);
  if (ending == ".yml" || ending == ".yaml" || ending == ".xrdf") return read_yaml_spheres(file);
  if (ending == ".urdf") return read_urdf_spheres(file);
  if (ending == ".srdf") return read_srdf_spheres(file);
  if (ending == ".xml") return read_mjcf_spheres(file);
  if (ending == ".mol") return read_lammps_spheres(file);
  if (ending == ".py") return read_yade_spheres(file);
  if (ending == ".ply") return read_ply(file);
  if (ending == ".sph" || ending == ".orchard") return read_tree(file);
  if (ending == ".txt" || ending == ".csv" || ending == ".xyz") return read_text_spheres(file);
  throw InputError(file.string() +
                   ": the format is unknown; spheres are read from .txt, .csv, .xyz, .json, .yml, .yaml, .xrdf, .urdf, "
                   ".srdf, .xml, .mol, "
                   ".py, .ply, .sph and .orchard; name it so");
}

// MorphIt's, one file a mesh.
SphereFile read_folder(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (lower_extension(entry.path()) == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  SphereFile result{"MorphIt's JSON", {}};
  for (const fs::path& file : files) {
    const std::string stem = file.stem().string();
    const std::size_t bar = stem.rfind('_');
    const std::string digits = bar == std::string::npos ? "" : stem.substr(bar + 1);
    if (digits.empty() || digits.size() > 4 || digits.find_first_not_of("0123456789") != std::string::npos) continue;
    SphereFile one = read_json_spheres(file);
    if (one.groups.size() != 1 || !one.groups.front().name.empty())
      throw InputError(file.string() + ": the file must have the spheres of one mesh, as centers and radii");
    SphereGroup& group = result.groups.emplace_back(std::move(one.groups.front()));
    group.name = stem.substr(0, bar);
    group.frame = SphereFrame::mesh;
    group.element = static_cast<Index>(std::stoul(digits));
  }
  if (result.groups.empty())
    throw InputError(folder.string() + ": the folder has no files LINK_K.json, as MorphIt writes them");
  return result;
}

}  // namespace

void add_sphere(SphereGroup& group, const Point& center, double radius, const std::string& where) {
  if (!center.allFinite() || !std::isfinite(radius))
    throw InputError(where +
                     ": a sphere has a centre or a radius that is not a finite number; correct it or leave it out");
  if (radius > 0)
    group.spheres.push_back({center, radius});
  else
    ++group.switched_off;
}

SphereFile read_sphere_file(const fs::path& file) {
  SphereFile spheres = fs::is_directory(file) ? read_folder(file) : read_by_ending(file);
  std::erase_if(spheres.groups,
                [](const SphereGroup& group) { return group.spheres.empty() && group.switched_off == 0; });
  if (spheres.groups.empty()) throw InputError(file.string() + ": the file has no sphere");
  return spheres;
}

const SphereGroup& group_named(const SphereFile& spheres, const fs::path& file, const std::string& name) {
  std::vector<std::string> names;
  for (const SphereGroup& group : spheres.groups) {
    if (group.name == name && !name.empty()) return group;
    names.push_back(group.name);
  }
  if (name.empty() && spheres.groups.size() == 1) return spheres.groups.front();
  if (names == std::vector<std::string>{""})
    throw InputError(file.string() + ": the file names no links; leave out --link");
  const std::string fault = name.empty() ? "holds several links; choose one by --link" : "has no link " + name;
  throw InputError(fmt::format("{}: {}: {}", file.string(), fault, fmt::join(names, ", ")));
}

}  // namespace orchard::apps
