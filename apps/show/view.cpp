#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "command_line/commands.h"
#include "command_line/number_text.h"
#include "input/input_file.h"
#include "input/mesh_input.h"
#include "input/reading_report.h"
#include "orchard/geometry/error.h"
#include "output/outputs.h"
#include "output/picture.h"
#include "output/sphere_lists.h"
#include "output/stamp.h"

#ifdef ORCHARD_HAS_VIZ
#include <array>
#include <numbers>

#include "orchard/medial/medial_mesh.h"
#include "orchard/viz/view.h"
#include "orchard/voronoi/diagram_io.h"
#endif

namespace orchard::apps {

#ifdef ORCHARD_HAS_VIZ
namespace {

constexpr int kMinPixels = 64, kMaxPixels = 8192;

// "1,2,3".
template <std::size_t count>
std::array<double, count> numbers_of(const std::string& option, const std::string& text, const char* expected) {
  std::array<double, count> result{};
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const auto value = finite_number(text.substr(std::min(at, text.size()), end - at));
    if (!value || (end == text.size()) != (i + 1 == count))
      throw InputError(option + " " + text + ": expected " + expected);
    result.at(i) = *value;
    at = end + 1;
  }
  return result;
}

Figure figure_of(const ViewCommand& command) {
  Figure figure{.color = command.color,
                .span = command.width.value_or(0),
                .edges = command.edges,
                .balls = command.balls,
                .beside = command.layout == "beside",
                .captions = command.captions,
                .transparent = command.transparent,
                .steady = command.turn > 0};
  if (!command.range.empty()) {
    figure.range = numbers_of<2>("--range", command.range, "two numbers, such as 0,3");
    if ((*figure.range)[0] >= (*figure.range)[1])
      throw InputError("--range " + command.range + ": the first number must be below the second one");
  }
  if (!command.look_at.empty()) {
    const auto place = numbers_of<3>("--look-at", command.look_at, "three coordinates, such as 1.5,0,2");
    figure.look_at = Point(place[0], place[1], place[2]);
  }
  if (!command.clip.empty()) {
    figure.clip =
        numbers_of<4>("--clip", command.clip, "four numbers A,B,C,D, such as 1,0,0,0.5 for what is right of x = 0.5");
    const auto& [a, b, c, d] = *figure.clip;
    if (a == 0 && b == 0 && c == 0)
      throw InputError("--clip " + command.clip + ": A, B and C are all 0, which is no plane");
  }
  return figure;
}

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

void add(const std::filesystem::path& file, const MeshInput& input, Scene& scene, bool talk) {
  const std::string extension = lower_extension(file), name = file.filename().string();
  if (extension == ".orchard" || extension == ".sph") {
    scene.trees.push_back({name, *read_spheres(file).tree});
  } else if (extension == ".ma") {
    scene.axes.push_back({name, read_ma(file)});
  } else if (extension == ".vtp") {
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

void check_color(const Scene& scene) {
  if (scene.figure.color.empty()) return;
  const std::vector<std::string> names = color_arrays(scene);
  if (std::find(names.begin(), names.end(), scene.figure.color) != names.end()) return;
  throw InputError(fmt::format("--color {}: no file has an array of this name; they have {}", scene.figure.color,
                               names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

// The smallest time if there is no such file.
std::filesystem::file_time_type written_at(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::last_write_time(file, ignored);
}

// The pictures, and how far each is turned, in radians.
std::vector<std::pair<std::filesystem::path, double>> frames_of(const ViewCommand& command) {
  if (command.turn == 0) return {{command.picture, 0.0}};
  std::vector<std::pair<std::filesystem::path, double>> frames;
  const std::string stem = command.picture.stem().string();
  for (Index i = 0; i < command.turn; ++i)
    frames.emplace_back(command.picture.parent_path() / fmt::format("{}-{:03}.png", stem, i + 1),
                        2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(command.turn));
  return frames;
}

}  // namespace

void view(const ViewCommand& command) {
  if (command.picture.empty() && !command.window)
    throw InputError("view: name a picture with -o PICTURE.png, or open a --window");
  if (!command.picture.empty() && lower_extension(command.picture) != ".png")
    throw InputError(command.picture.string() + ": pictures are .png files");
  if (command.window && (command.turn > 0 || command.transparent || !command.color.empty() || !command.clip.empty() ||
                         !command.look_at.empty() || command.edges || command.balls || command.layout == "beside"))
    throw InputError(
        "view: a --window takes no options of a figure (--color, --look-at, --clip, --edges, --balls, "
        "--layout, --transparent, --turn); leave --window out for a picture");
  PipelinePicture picture = picture_of(command);
  if (const std::string missing = renderer_missing(); !missing.empty())
    throw InputError((command.window ? "no window can be opened: " : "no picture can be made: ") + missing);
  for (const std::filesystem::path& file : command.files) check_input(file);
  if (!command.picture.empty())
    for (const auto& frame : frames_of(command)) check_output(frame.first, command.files);
  const Provenance provenance = provenance_of(command.run, command.files);

  Scene scene;
  scene.levels = command.levels;
  scene.opacity = command.opacity;
  scene.figure = figure_of(command);
  for (const std::filesystem::path& file : command.files) add(file, command.input, scene, !command.quiet);
  check_levels(scene);
  check_color(scene);

  const Writing writing;
  if (command.window) picture.title = "orchard: " + command.files.front().filename().string();
  for (const auto& [file, turned] : frames_of(command)) {
    const auto before = written_at(file);
    PipelinePicture frame = picture;
    frame.azimuth += turned;
    const PictureStatus status = command.window ? show_view(file, scene, frame) : draw_view(file, scene, frame);
    throw_if_interrupted();
    // A window leaves a picture only if the user saved one; an older one stays as it is.
    if (status && !file.empty() && written_at(file) != before) stamp(file, line_of(provenance));
    if (!status)
      throw Error(std::string(command.window ? "no window was opened: " : "no picture was made: ") + status.reason);
    if (!command.window && !command.quiet) fmt::print("  {}\n", file.string());
  }
}

#else

void view(const ViewCommand&) {
  throw InputError(
      "view: this program was built without VTK, which draws: get it (tools/install-packages), and configure and build "
      "again with ORCHARD_VIZ=ON");
}

#endif

}  // namespace orchard::apps
