#include "drawing.h"

#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <fstream>
#include <iterator>
#include <numbers>
#include <optional>
#include <regex>

#include "child_process.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"

namespace orchard {
namespace {

namespace fs = std::filesystem;
using detail::Clock;

constexpr std::chrono::seconds kPatienceForDisplay{10};  // Xvfb takes 0.1 s on an idle machine
constexpr const char* kPrefix = "picture";               // the prefix of the temporary files

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "orchard-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw Error("cannot make a temporary folder " + name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

fs::path find_renderer(const PipelinePicture& picture) {
  if (!picture.renderer.empty()) return picture.renderer;
  if (const std::string named = variable("ORCHARD_RENDER"); !named.empty()) return named;
  std::error_code failure;
  const fs::path program = fs::read_symlink("/proc/self/exe", failure);
  fs::path beside = program.parent_path() / "orchard-render";
  if (!failure && access(beside.c_str(), X_OK) == 0) return beside;
  return detail::find_in_path("orchard-render");
}

// Returns the last line that a program wrote, if any, for a message, without the control sequences with which VTK
// colours its log.
std::string last_words(const fs::path& log) {
  const std::string text = std::regex_replace(content(log), std::regex("\\x1b\\[[0-9;]*m"), "");
  const std::size_t end = text.find_last_not_of(" \n");
  if (end == std::string::npos) return {};
  const std::size_t before = text.find_last_of('\n', end);
  return " (" + text.substr(before + 1, end - before) + ")";
}

struct Drawing {
  const PipelinePicture& picture;
  const std::vector<std::string>& more;  // options of orchard-render
  fs::path renderer, folder, png;
};

std::vector<std::string> arguments_of(const Drawing& drawing) {
  const PipelinePicture& picture = drawing.picture;
  static constexpr std::array kAxes{"x", "y", "z"};
  constexpr double kDegrees = 180 / std::numbers::pi;
  std::vector<std::string> arguments{(drawing.folder / kPrefix).string() + ".vtm",
                                     drawing.png.string(),
                                     "--width",
                                     std::to_string(picture.width),
                                     "--height",
                                     std::to_string(picture.height),
                                     "--up",
                                     kAxes.at(static_cast<std::size_t>(picture.up)),
                                     "--azimuth",
                                     std::to_string(picture.azimuth * kDegrees),
                                     "--elevation",
                                     std::to_string(picture.elevation * kDegrees),
                                     "--title",
                                     picture.title};
  arguments.insert(arguments.end(), drawing.more.begin(), drawing.more.end());
  return arguments;
}

// Returns why a program with this exit status failed, or nullopt if it did not fail.
std::optional<std::string> failure_of(const std::string& where, int status, const fs::path& log) {
  if (WIFSIGNALED(status)) return where + " was ended by signal " + std::to_string(WTERMSIG(status)) + last_words(log);
  if (WEXITSTATUS(status) != 0) return where + " failed" + last_words(log);
  return std::nullopt;
}

bool is_vector_ending(const std::string& ending) { return ending == ".svg" || ending == ".pdf"; }

// Runs orchard-render on one display. Returns why it failed, or nullopt.
std::optional<std::string> run_renderer(const Drawing& drawing, const std::string& display) {
  const PipelinePicture& picture = drawing.picture;
  const fs::path log = drawing.folder / "render.log";
  detail::ChildProcess child(
      {.program = drawing.renderer, .arguments = arguments_of(drawing), .display = display, .log = log});
  const std::optional<int> status = child.wait_until(Clock::now() + picture.timeout, picture.progress);
  const std::string where = display.empty() ? "orchard-render" : "orchard-render on display " + display;
  if (!status) return where + " took longer than " + std::to_string(picture.timeout.count()) + " s";
  return failure_of(where, *status, log);
}

std::optional<std::string> run_on_virtual_display(const Drawing& drawing) {
  const fs::path xvfb = detail::find_in_path("Xvfb");
  if (xvfb.empty()) return "Xvfb (package xvfb) is not in PATH";
  const fs::path log = drawing.folder / "xvfb.log";
  try {
    const detail::VirtualDisplay display(xvfb, log, kPatienceForDisplay, drawing.picture.progress);
    return run_renderer(drawing, display.name());
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    return error.what() + last_words(log);
  }
}

// Pictures of lines need no display. Otherwise, the present display is tried first if there is one.
std::optional<std::string> run_somewhere(const Drawing& drawing) {
  if (is_vector_ending(drawing.png.extension().string())) return run_renderer(drawing, "");
  std::string reasons = "DISPLAY is not set";
  if (const std::string display = variable("DISPLAY"); !display.empty()) {
    const std::optional<std::string> failure = run_renderer(drawing, display);
    if (!failure) return std::nullopt;
    reasons = *failure;
  }
  const std::optional<std::string> failure = run_on_virtual_display(drawing);
  if (!failure) return std::nullopt;
  return reasons + ", and " + *failure;
}

// Returns the result of `work`, or the reason why it failed.
template <class Work>
PictureStatus tried(const Work& work) {
  try {
    return work();
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    return {false, error.what()};
  } catch (const fs::filesystem_error& error) {
    return {false, error.what()};
  }
}

}  // namespace

std::string renderer_missing(const PipelinePicture& picture) {
  const fs::path renderer = find_renderer(picture);
  if (renderer.empty())
    return "the program that draws, orchard-render, is neither beside this one nor in PATH: build it (cmake --build "
           "--preset release --target orchard_render), install it with the package orchard-tools, or name it in the "
           "variable "
           "ORCHARD_RENDER";
  if (access(renderer.c_str(), X_OK) == 0) return {};
  return renderer.string() + ", named as the program that draws (ORCHARD_RENDER), " +
         (fs::exists(renderer) ? "cannot be run" : "is not there") + ": name orchard-render, or none, to find it";
}

PictureStatus detail::draw(const fs::path& png, const PipelinePicture& picture, const std::vector<std::string>& more,
                           const WriteScene& write) {
  return tried([&]() -> PictureStatus {
    if (std::string missing = renderer_missing(picture); !missing.empty()) return {false, std::move(missing)};
    const fs::path renderer = find_renderer(picture);
    const TemporaryFolder folder;
    write(folder.path() / kPrefix);
    report_progress(picture.progress, "picture", 0);
    const std::string ending = is_vector_ending(png.extension().string()) ? png.extension().string() : ".png";
    const Drawing drawing{picture, more, renderer, folder.path(), folder.path() / ("picture" + ending)};
    if (const auto reason = run_somewhere(drawing)) return {false, *reason};
    write_file(png, content(drawing.png));
    return {true, {}};
  });
}

PictureStatus detail::show(const fs::path& png, const PipelinePicture& picture, const std::vector<std::string>& more,
                           const WriteScene& write) {
  return tried([&]() -> PictureStatus {
    if (std::string missing = renderer_missing(picture); !missing.empty()) return {false, std::move(missing)};
    const fs::path renderer = find_renderer(picture);
    if (variable("DISPLAY").empty()) return {false, "DISPLAY is not set: there is no screen to show it on"};
    const TemporaryFolder folder;
    write(folder.path() / kPrefix);
    const Drawing drawing{picture, more, renderer, folder.path(), png};
    detail::ChildProcess child({.program = renderer, .arguments = arguments_of(drawing), .display = {}, .log = {}});
    const std::optional<int> status = child.wait_until(Clock::time_point::max(), picture.progress);
    if (const auto reason = failure_of("the window", *status, {})) return {false, *reason};
    return {true, {}};
  });
}

}  // namespace orchard
