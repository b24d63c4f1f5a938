#include "input/mesh_input.h"

#include <algorithm>

#include "input/input_file.h"
#include "input/scene_mesh.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/reconstruct.h"

namespace orchard::apps {
namespace {

std::string format_of(const std::filesystem::path& file, const MeshInput& input) {
  if (!input.format.empty()) return input.format;
  const std::string extension = lower_extension(file);
  return extension.empty() ? extension : extension.substr(1);
}

// Coordinates and what was measured on them.
void scale_reading(const std::string& name, const MeshInput& input, MeshReading& reading) {
  MeshReadReport& report = reading.report;
  if (input.scale != 1) {
    for (Point& vertex : reading.mesh.vertices) vertex *= input.scale;
    if (report.from_points) report.from_points->scale_by(input.scale);
    report.scale = input.scale;
    report.unit.clear();  // the file's no longer
    try {
      if (!reading.mesh.triangles.empty()) require_usable_size(reading.mesh);
    } catch (const InputError& error) {
      throw InputError(name + ", scaled by " + std::to_string(input.scale) + ": " + error.what());
    }
  }
  if (!input.unit.empty()) report.unit = input.unit;
}

MeshReading read_reconstructed(const OrientedPoints& points, const std::string& name, const Progress& progress) {
  MeshReading reading;
  try {
    ReconstructedMesh made = reconstruct_surface(points, {}, progress);
    reading.mesh = std::move(made.mesh);
    reading.report.from_points = PointsReading{.points = static_cast<Index>(points.points.size()),
                                               .spacing = made.spacing,
                                               .mean_from_points = made.mean_from_points,
                                               .max_from_points = made.max_from_points,
                                               .max_to_points = made.to_points.upper};
    require_usable_size(reading.mesh);
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  }
  return reading;
}

// Formats of which some files have points and some have faces.
MeshReading read_mesh_or_reconstruct(const std::filesystem::path& file, const std::string& format,
                                     const Progress& progress) {
  MeshReading reading = read_points_or_mesh_and_report(file, format);
  if (reading.mesh.triangles.empty())
    return read_reconstructed(*read_oriented_points(file, format), file.string(), progress);
  try {
    require_usable_size(reading.mesh);
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
  return reading;
}

}  // namespace

std::vector<std::string> input_formats() {
  std::vector<std::string> names = mesh_formats();
  names.insert(names.end(), {"glb", "gltf", "3mf", "dae", "xyz"});
  return names;
}

std::string input_formats_in_words() {
  std::string text;
  const std::vector<std::string> names = input_formats();
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "." : i + 1 == names.size() ? " or ." : ", .") + names[i];
  return "(" + text + ")";
}

bool is_mesh_name(const std::filesystem::path& file) {
  const std::vector<std::string> names = input_formats();
  const std::string extension = lower_extension(file);
  return std::ranges::any_of(names, [&](const std::string& name) { return name != "xyz" && extension == "." + name; });
}

MeshReading read_input(const std::filesystem::path& file, const MeshInput& input, const Progress& progress) {
  const std::string format = format_of(file, input);
  MeshReading reading;
  if (is_scene_format(format)) {
    reading = read_scene(file, format);
  } else if (format == "xyz" || format == "ply") {
    reading = read_mesh_or_reconstruct(file, format, progress);
  } else {
    reading = read_mesh_and_report(file, format);
  }
  scale_reading(file.string(), input, reading);
  return reading;
}

MeshReading read_input_or_points(const std::filesystem::path& file, const MeshInput& input) {
  const std::string format = format_of(file, input);
  MeshReading reading =
      is_scene_format(format) ? read_scene(file, format) : read_points_or_mesh_and_report(file, format);
  scale_reading(file.string(), input, reading);
  return reading;
}

}  // namespace orchard::apps
