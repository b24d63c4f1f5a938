#include <fmt/core.h>

#include <algorithm>
#include <cctype>

#include "commands.h"
#include "finite_number.h"
#include "input_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "outputs.h"
#include "picture.h"
#include "reading_report.h"
#include "sphere_lists.h"
#include "stamp.h"

#ifdef ORCHARD_HAS_VIZ
#include <numbers>

#include "orchard/medial/medial_mesh.h"
#include "orchard/viz/view.h"
#include "orchard/voronoi/diagram_io.h"
#endif

namespace orchard::apps {

#ifdef ORCHARD_HAS_VIZ
namespace {

constexpr int kMinPixels = 64, kMaxPixels = 8192;

// "35,20" or "1200x800".
std::pair<double, double> two_numbers(const std::string& option, const std::string& text, char separator,
                                      const char* expected) {
  const std::size_t at = text.find(separator);
  const auto first = finite_number(text.substr(0, at));
  const auto second = at == std::string::npos ? std::nullopt : finite_number(text.substr(at + 1));
  if (!first || !second) throw InputError(option + " " + text + ": expected " + expected);
  return {*first, *second};
}

PipelinePicture picture_of(const ViewCommand& command) {
  PipelinePicture picture;
  picture.up = parse_up(command.up);
  picture.progress = cancelled_by_interrupts();
  if (!command.camera.empty()) {
    const auto [azimuth, elevation] =
        two_numbers("--camera", command.camera, ',', "two angles in degrees, to the right and up, such as 35,20");
    if (std::abs(azimuth) > 360 || std::abs(elevation) > 80)
      throw InputError("--camera " + command.camera + ": the first angle is -360 to 360, the second one -80 to 80");
    picture.azimuth = azimuth * std::numbers::pi / 180;
    picture.elevation = elevation * std::numbers::pi / 180;
  }
  if (!command.size.empty()) {
    const auto [width, height] = two_numbers("--size", command.size, 'x', "pixels, such as 1200x800");
    if (std::min(width, height) < kMinPixels || std::max(width, height) > kMaxPixels)
      throw InputError(
          fmt::format("--size {}: width and height are {} to {} pixels", command.size, kMinPixels, kMaxPixels));
    picture.width = static_cast<int>(width);
    picture.height = static_cast<int>(height);
  }
  return picture;
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

void add(const std::filesystem::path& file, Scene& scene, bool talk) {
  const std::string extension = lower_extension(file), name = file.filename().string();
  if (extension == ".orchard" || extension == ".sph") {
    scene.trees.push_back({name, *read_spheres(file).tree});
  } else if (extension == ".ma") {
    scene.axes.push_back({name, read_ma(file)});
  } else if (extension == ".vor") {
    scene.diagrams.push_back({name, read_vor(file)});
  } else {
    auto [mesh, reading] = read_points_or_mesh_and_report(file);
    if (talk) print_reading(file, reading);
    if (mesh.triangles.empty()) {
      scene.points.push_back({name, std::move(mesh.vertices)});
    } else {
      scene.meshes.push_back({name, Surface(std::move(mesh))});
    }
  }
}

// A level below all trees' deepest is a mistake.
void check_levels(const Scene& scene) {
  if (scene.levels.empty()) return;
  if (scene.trees.empty()) throw InputError("--level: there is no tree among the files; give an .orchard or .sph file");
  Index depth = 0;
  for (const auto& tree : scene.trees) depth = std::max(depth, tree.value.depth());
  for (const Index level : scene.levels)
    if (level > depth)
      throw InputError(fmt::format("--level {}: the deepest level there is is {}; the root is 0", level, depth));
}

// The smallest time if there is no such file.
std::filesystem::file_time_type written_at(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::last_write_time(file, ignored);
}

}  // namespace

void view(const ViewCommand& command) {
  if (command.picture.empty() && !command.window)
    throw InputError("view: name a picture with -o PICTURE.png, or open a --window");
  if (!command.picture.empty() && lower_extension(command.picture) != ".png")
    throw InputError(command.picture.string() + ": pictures are .png files");
  PipelinePicture picture = picture_of(command);
  if (const std::string missing = renderer_missing(); !missing.empty())
    throw InputError((command.window ? "no window can be opened: " : "no picture can be made: ") + missing);
  for (const std::filesystem::path& file : command.files) check_input(file);
  if (!command.picture.empty()) check_output(command.picture, command.files);
  const Provenance provenance = provenance_of(command.run, command.files);

  Scene scene;
  scene.levels = command.levels;
  scene.opacity = command.opacity;
  for (const std::filesystem::path& file : command.files) add(file, scene, !command.quiet);
  check_levels(scene);

  const Writing writing;
  const auto before = written_at(command.picture);
  if (command.window) picture.title = "orchard: " + command.files.front().filename().string();
  const PictureStatus status =
      command.window ? show_view(command.picture, scene, picture) : draw_view(command.picture, scene, picture);
  throw_if_interrupted();
  // A window leaves a picture only if the user saved one; an older one stays as it is.
  if (status && !command.picture.empty() && written_at(command.picture) != before)
    stamp(command.picture, line_of(provenance));
  if (!status)
    throw Error(std::string(command.window ? "no window was opened: " : "no picture was made: ") + status.reason);
  if (!command.window && !command.quiet) fmt::print("  {}\n", command.picture.string());
}

#else

void view(const ViewCommand&) {
  throw InputError(
      "view: this program was built without VTK, which draws: get it (tools/install-packages), and configure and build "
      "again with ORCHARD_VIZ=ON");
}

#endif

}  // namespace orchard::apps
