#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

#include "command_line/commands.h"
#include "command_line/number_text.h"
#include "input/input_file.h"
#include "orchard/geometry/error.h"
#include "output/array_descriptions.h"
#include "output/outputs.h"
#include "output/picture.h"
#include "output/stamp.h"
#include "show/view_files.h"

#ifdef ORCHARD_HAS_VIZ
#include <array>
#include <numbers>

#include "orchard/viz/view.h"
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
      throw InputError(std::string(option).append(" ").append(text).append(": expected ").append(expected));
    result.at(i) = *value;
    at = end + 1;
  }
  return result;
}

// "radius (mesh units)"; the name alone if the array has no unit that its name does not say.
std::string title_of(const std::string& array) {
  const std::optional<ArrayDescription> description = description_of(array);
  if (!description || description->unit == "-" || description->unit == "count" || description->unit == "code")
    return array;
  return array + " (" + description->unit + ")";
}

Figure figure_of(const ViewCommand& command) {
  Figure figure{.color = command.color,
                .bar_title = title_of(command.color),
                .map = command.map,
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
    if (a == 0 && b == 0 && c == 0) throw InputError("--clip " + command.clip + ": A, B and C must not all be 0");
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
      throw InputError("--camera " + command.camera +
                       ": the first angle must be from -360 to 360, and the second one from -80 to 80");
    picture.azimuth = azimuth * std::numbers::pi / 180;
    picture.elevation = elevation * std::numbers::pi / 180;
  }
  if (!command.size.empty()) {
    const auto [width, height] = two_numbers("--size", command.size, 'x', "pixels, such as 1200x800");
    if (std::min(width, height) < kMinPixels || std::max(width, height) > kMaxPixels)
      throw InputError(fmt::format("--size {}: width and height must be from {} to {} pixels", command.size, kMinPixels,
                                   kMaxPixels));
    picture.width = static_cast<int>(width);
    picture.height = static_cast<int>(height);
  }
  return picture;
}

// A level below all trees' deepest is a mistake.
void check_levels(const Scene& scene) {
  if (scene.levels.empty()) return;
  if (scene.trees.empty()) throw InputError("--level: there is no tree among the files; give an .orchard or .sph file");
  Index depth = 0;
  for (const auto& tree : scene.trees) depth = std::max(depth, tree.value.depth());
  for (const Index level : scene.levels)
    if (level > depth)
      throw InputError(fmt::format("--level {}: the deepest level is {}, and the root is 0", level, depth));
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

// A picture to draw: how far it is turned, in radians, and which time step of each series it shows.
struct ViewFrame {
  std::filesystem::path file;
  double turned = 0;
  std::size_t step = 0;
};

// The pictures, and which time step each shows; the last one if none is named.
std::vector<ViewFrame> frames_of(const ViewCommand& command, std::size_t steps) {
  const std::size_t shown = command.frame > 0 ? command.frame - 1 : steps == 0 ? 0 : steps - 1;
  if (command.turn == 0 && !command.play) return {{command.picture, 0.0, shown}};
  const std::size_t count = command.play ? steps : command.turn;
  std::vector<ViewFrame> frames;
  const std::string stem = command.picture.stem().string(), ending = command.picture.extension().string();
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    frames.push_back({command.picture.parent_path() / fmt::format("{}-{:03}{}", stem, i + 1, ending),
                      command.turn > 0 ? turn : 0, command.play ? i : shown});
  }
  return frames;
}

bool is_of_lines(const ViewCommand& command) {
  const std::string ending = lower_extension(command.picture);
  return ending == ".svg" || ending == ".pdf";
}

void check_window(const ViewCommand& command) {
  if (command.turn > 0 || command.play || command.transparent || !command.color.empty() || !command.clip.empty() ||
      !command.look_at.empty() || command.edges || command.balls || command.layout == "beside")
    throw InputError(
        "view: a --window takes no options of a figure (--color, --look-at, --clip, --edges, --balls, "
        "--layout, --transparent, --turn, --play); leave --window out for a picture");
}

// What can be refused before anything is read.
void check_view(const ViewCommand& command) {
  if (command.picture.empty() && !command.window)
    throw InputError("view: name a picture with -o PICTURE.png, or open a --window");
  const std::string ending = lower_extension(command.picture);
  if (!command.picture.empty() && ending != ".png" && (command.window || !is_of_lines(command)))
    throw InputError(command.picture.string() + ": pictures are .png files" +
                     (command.window ? "" : ", or .svg and .pdf files of lines"));
  if (command.window) check_window(command);
  if (!is_of_lines(command)) return;
  if (!command.color.empty())
    throw InputError("view: --color colours surfaces, but " + command.picture.string() +
                     " is a picture of lines; name a .png file");
  if (command.picture.extension() != ending)
    throw InputError(command.picture.string() + ": write the ending in small letters, " + ending);
}

// Cut spheres are no outlines of spheres, and polyhedra in a heap no lines that one could read.
void check_lines(const ViewCommand& command, const Scene& scene) {
  if (!is_of_lines(command)) return;
  if (!scene.diagrams.empty()) throw InputError("view: a line drawing cannot show a Voronoi diagram; name a .png file");
  if (!command.clip.empty() && (!scene.trees.empty() || command.balls))
    throw InputError("view: --clip cannot cut spheres in a line drawing; name a .png file");
}

SeriesList read_all_series(const ViewCommand& command) {
  SeriesList all;
  for (const std::filesystem::path& file : command.files)
    if (lower_extension(file) == ".pvd") all.push_back(read_series(file));
  const std::size_t length = length_of(all);
  if (all.empty() && (command.play || command.frame > 0))
    throw InputError("view: --play and --frame belong to a series (.pvd), and there is none among the files");
  if (command.play && command.turn > 0 && command.turn != length)
    throw InputError(
        fmt::format("--turn {}: with --play there is a picture for each of the {} time steps; turn by as "
                    "many",
                    command.turn, length));
  if (command.frame > length)
    throw InputError(fmt::format("--frame {}: the series has {} time steps", command.frame, length));
  return all;
}

void draw_frame(const ViewCommand& command, const ViewFrame& frame, const Scene& scene, PipelinePicture picture,
                const std::string& line) {
  const auto before = written_at(frame.file);
  picture.azimuth += frame.turned;
  const PictureStatus status =
      command.window ? show_view(frame.file, scene, picture) : draw_view(frame.file, scene, picture);
  throw_if_interrupted();
  // A window leaves a picture only if the user saved one; an older one stays as it is.
  if (status && !frame.file.empty() && written_at(frame.file) != before) stamp(frame.file, line);
  if (!status)
    throw Error(std::string(command.window ? "no window was opened: " : "no picture was made: ") + status.reason);
  if (!command.window && !command.quiet) fmt::print("  {}\n", frame.file.string());
}

}  // namespace

void view(const ViewCommand& command) {
  check_view(command);
  PipelinePicture picture = picture_of(command);
  if (const std::string missing = renderer_missing(); !missing.empty())
    throw InputError((command.window ? "no window can be opened: " : "no picture can be made: ") + missing);
  for (const std::filesystem::path& file : command.files) check_input(file);
  const SeriesList series = read_all_series(command);
  const std::vector<ViewFrame> frames = frames_of(command, length_of(series));
  if (!command.picture.empty())
    for (const ViewFrame& frame : frames) check_output(frame.file, command.files);
  const std::string line = line_of(provenance_of(command.run, command.files));

  Scene scene;
  scene.levels = command.levels;
  scene.opacity = command.opacity;
  scene.figure = figure_of(command);
  if (command.play) scene.figure.room = room_of(series);
  for (const std::filesystem::path& file : command.files)
    if (lower_extension(file) != ".pvd") add_file(file, command.input, scene, !command.quiet);
  check_levels(scene);
  check_lines(command, scene);
  const std::size_t still = scene.data.size();
  show_step(frames.front().step, series, still, scene);
  check_color(scene);

  const Writing writing;
  if (command.window) picture.title = "orchard: " + command.files.front().filename().string();
  for (const ViewFrame& frame : frames) {
    show_step(frame.step, series, still, scene);
    draw_frame(command, frame, scene, picture, line);
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
