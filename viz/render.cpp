#include "orchard/viz/render.h"

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
#include "orchard/viz/medial_writer.h"

namespace orchard {
namespace {

namespace fs = std::filesystem;
using detail::Clock;

constexpr std::chrono::seconds kPatienceForDisplay{10};  // Xvfb takes 0.1 s on an idle machine
constexpr const char* kPrefix = "picture";               // of what is drawn, in the temporary folder

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

// The last line that a program wrote, if any, for a message; without the control sequences that VTK colours its log
// with.
std::string last_words(const fs::path& log) {
  const std::string text = std::regex_replace(content(log), std::regex("\\x1b\\[[0-9;]*m"), "");
  const std::size_t end = text.find_last_not_of(" \n");
  if (end == std::string::npos) return {};
  const std::size_t before = text.find_last_of('\n', end);
  return " (" + text.substr(before + 1, end - before) + ")";
}

// Runs orchard-render on one display; the reason why it failed, or nothing.
std::optional<std::string> run_renderer(const fs::path& renderer, const PipelinePicture& picture,
                                        const fs::path& folder, const std::string& display) {
  const fs::path log = folder / "render.log";
  static constexpr std::array kAxes{"x", "y", "z"};
  constexpr double kDegrees = 180 / std::numbers::pi;
  detail::ChildProcess child(
      {.program = renderer,
       .arguments = {(folder / kPrefix).string() + ".vtm", (folder / "picture.png").string(), "--width",
                     std::to_string(picture.width), "--height", std::to_string(picture.height), "--up",
                     kAxes.at(static_cast<std::size_t>(picture.up)), "--azimuth",
                     std::to_string(picture.azimuth * kDegrees), "--elevation",
                     std::to_string(picture.elevation * kDegrees), "--title", picture.title},
       .display = display,
       .log = log});
  const std::optional<int> status = child.wait_until(Clock::now() + picture.timeout, picture.progress);
  const std::string where = "orchard-render on display " + display;
  if (!status) return where + " took longer than " + std::to_string(picture.timeout.count()) + " s";
  if (WIFSIGNALED(*status))
    return where + " was ended by signal " + std::to_string(WTERMSIG(*status)) + last_words(log);
  if (WEXITSTATUS(*status) != 0) return where + " failed" + last_words(log);
  return std::nullopt;
}

std::optional<std::string> run_on_virtual_display(const fs::path& renderer, const PipelinePicture& picture,
                                                  const fs::path& folder) {
  const fs::path xvfb = detail::find_in_path("Xvfb");
  if (xvfb.empty()) return "Xvfb (package xvfb) is not in PATH";
  const fs::path log = folder / "xvfb.log";
  try {
    const detail::VirtualDisplay display(xvfb, log, kPatienceForDisplay, picture.progress);
    return run_renderer(renderer, picture, folder, display.name());
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    return error.what() + last_words(log);
  }
}

// Where there is a display it is tried first.
std::optional<std::string> run_somewhere(const fs::path& renderer, const PipelinePicture& picture,
                                         const fs::path& folder) {
  std::string reasons = "DISPLAY is not set";
  if (const std::string display = variable("DISPLAY"); !display.empty()) {
    const std::optional<std::string> failure = run_renderer(renderer, picture, folder, display);
    if (!failure) return std::nullopt;
    reasons = *failure;
  }
  const std::optional<std::string> failure = run_on_virtual_display(renderer, picture, folder);
  if (!failure) return std::nullopt;
  return reasons + ", and " + *failure;
}

// write(prefix): the files to draw, with prefix.vtm to open them.
template <class Write>
PictureStatus draw(const fs::path& png, const PipelinePicture& picture, const Write& write) {
  try {
    const fs::path renderer = find_renderer(picture);
    if (renderer.empty()) return {false, "the program orchard-render is neither beside this one nor in PATH"};
    const TemporaryFolder folder;
    write(folder.path() / kPrefix);
    report_progress(picture.progress, "picture", 0);
    if (const auto reason = run_somewhere(renderer, picture, folder.path())) return {false, *reason};
    write_file(png, content(folder.path() / "picture.png"));
    return {true, {}};
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    return {false, error.what()};
  } catch (const fs::filesystem_error& error) {
    return {false, error.what()};
  }
}

}  // namespace

PictureStatus draw_pipeline(const fs::path& png, const PipelinePicture& picture) {
  return draw(png, picture, [&](const fs::path& prefix) { write_pipeline(prefix, picture.values); });
}

PictureStatus draw_medial_errors(const fs::path& png, const MedialErrorsPicture& errors,
                                 const PipelinePicture& picture) {
  return draw(png, picture, [&](const fs::path& prefix) {
    std::vector<NamedFile> files;
    const auto add = [&](const std::string& name, const std::string& ending) {
      const fs::path file = with_ending(prefix, ending);
      files.push_back({name, file.filename()});
      return file;
    };
    write_mesh(add("mesh", "-mesh.vtp"), *errors.surface);
    write_points(add("surface points", "-points.vtp"), *errors.sampling, {{"coverage", errors.coverage}});
    write_medial_mesh(add("medial mesh", "-medial.vtp"), *errors.mesh, {{"protrusion", errors.protrusion}});
    write_worst_places(add("worst places", "-worst.vtp"), errors.worst);
    write_multiblock(with_ending(prefix, ".vtm"), files);
  });
}

}  // namespace orchard
