// The simulator in a window:  orchard-fly TREE.orchard [SCENE] [--budget TESTS] [--bodies N] [--seed N] [--level L]
//   [--bounds] [--frames N] [--screenshot FILE.png]
// Keys: arrows steer, w and s open and close the throttle, 0 to 9 show a level's spheres, n none, b the space-time
// bounds, space pauses, q ends. With --frames it ends by itself, and with --screenshot writes the last picture.
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkCallbackCommand.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

#include "orchard/runtime/tree_file.h"
#include "view.h"

namespace {

using namespace orchard;
using simulation::FrameRecord;
using simulation::Simulation;
using Clock = std::chrono::steady_clock;

struct Request {
  std::string tree, scene = "flight", screenshot;
  std::uint64_t budget = 0, seed = 1;  // 0: none
  std::size_t bodies = 0;
  long frames = 0;  // 0: until q
  window::Shown shown;
};

bool parse(int argc, char** argv, Request& request) {
  int plain = 0;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--bounds")
      request.shown.bounds = true;
    else if (word == "--budget" && has_value)
      request.budget = std::strtoull(argv[++i], nullptr, 10);
    else if (word == "--bodies" && has_value)
      request.bodies = std::strtoull(argv[++i], nullptr, 10);
    else if (word == "--seed" && has_value)
      request.seed = std::strtoull(argv[++i], nullptr, 10);
    else if (word == "--level" && has_value)
      request.shown.level = std::atoi(argv[++i]);
    else if (word == "--frames" && has_value)
      request.frames = std::atol(argv[++i]);
    else if (word == "--screenshot" && has_value)
      request.screenshot = argv[++i];
    else if (word.starts_with("-") || plain == 2)
      return false;
    else
      (plain++ == 0 ? request.tree : request.scene) = word;
  }
  return plain > 0 && simulation::is_scene(request.scene);
}

// What the keys have done since the last frame.
struct Controls {
  simulation::Steering steering;
  window::Shown shown;
  bool paused = false, done = false;
};

void on_key(vtkObject* caller, unsigned long, void* data, void*) {
  Controls& c = *static_cast<Controls*>(data);
  const std::string key = static_cast<vtkRenderWindowInteractor*>(caller)->GetKeySym();
  const auto turn = [](double& value, double by) { value = std::clamp(value + by, -1.0, 1.0); };
  if (key == "Left") turn(c.steering.yaw, 0.25);
  if (key == "Right") turn(c.steering.yaw, -0.25);
  if (key == "Up") turn(c.steering.pitch, 0.25);
  if (key == "Down") turn(c.steering.pitch, -0.25);
  if (key == "w") turn(c.steering.throttle, 0.25);
  if (key == "s") turn(c.steering.throttle, -0.25);
  if (key == "n") c.shown.level = -1;
  if (key == "b") c.shown.bounds = !c.shown.bounds;
  if (key == "space") c.paused = !c.paused;
  if (key == "q" || key == "Escape") c.done = true;
  if (key.size() == 1 && key[0] >= '0' && key[0] <= '9') c.shown.level = key[0] - '0';
}

std::string hud(const Simulation& simulation, const FrameRecord& frame, const Controls& controls, double seconds) {
  std::uint32_t level = 0;
  double bound = 0;
  for (const simulation::PairOutcome& pair : simulation.pairs()) {
    if (pair.verdict.answer != runtime::Answer::maybe) continue;
    level = std::max(level, pair.verdict.level);
    bound = std::max(bound, pair.verdict.separation_bound);
  }
  const std::string reached = frame.maybe == 0 ? "all, every pair is certain" : std::to_string(level);
  const double radius = simulation.world().shapes[0].radius;
  char text[512];
  std::snprintf(text, sizeof text,
                "frame %6.1f ms   detection %6.0f us\npairs %3zu: no %zu, maybe %zu, yes %zu\n"
                "level reached: %s   bound %.3f R\nthrottle %+.2f  yaw %+.2f  pitch %+.2f\n"
                "spheres: %s   bounds: %s",
                1e3 * seconds, 1e6 * frame.seconds_detection, frame.pairs, frame.no, frame.maybe, frame.yes,
                reached.c_str(), std::min(bound / radius, 99.0), controls.steering.throttle, controls.steering.yaw,
                controls.steering.pitch,
                controls.shown.level < 0 ? "none" : ("level " + std::to_string(controls.shown.level)).c_str(),
                controls.shown.bounds ? "shown" : "none");
  return text;
}

void fly(const Request& request, const runtime::PackedSphereTree& tree) {
  Simulation simulation(request.scene, {simulation::shape_of(tree)}, request.bodies, request.seed);
  window::View view(simulation, 1024, 720);
  Controls controls;
  controls.shown = request.shown;
  controls.steering.throttle = 0.5;
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(view.window());
  interactor->SetInteractorStyle(nullptr);  // none of VTK's own keys and mouse
  vtkNew<vtkCallbackCommand> keys;
  keys->SetCallback(on_key);
  keys->SetClientData(&controls);
  interactor->AddObserver(vtkCommand::KeyPressEvent, keys);
  interactor->Initialize();
  runtime::Budget budget;
  if (request.budget > 0) budget.work = request.budget;
  const auto period = std::chrono::duration<double>(simulation.world().scene.frame);
  FrameRecord frame;
  double seconds = 0;
  for (long count = 0; !controls.done && (request.frames == 0 || count < request.frames); ++count) {
    const auto begin = Clock::now();
    interactor->ProcessEvents();
    controls.done = controls.done || interactor->GetDone();
    if (!controls.paused) frame = simulation.frame(budget, controls.steering);
    view.update(controls.shown, hud(simulation, frame, controls, seconds));
    view.window()->Render();
    seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    if (request.frames == 0) std::this_thread::sleep_until(begin + period);
  }
  if (!request.screenshot.empty()) view.write_png(request.screenshot);
}

// Why no window can be opened, in words; empty if one can. VTK ends the program where there is no display, or one that
// does not draw, so that a copy of it tries first.
std::string window_missing() {
  const char* const display = std::getenv("DISPLAY");
  if (display == nullptr || *display == '\0') return "DISPLAY is not set: there is no screen to show it on";
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    vtkNew<vtkRenderWindow> window;
    window->SetShowWindow(false);
    window->SetSize(8, 8);
    window->Render();
    _exit(0);
  }
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return std::string("nothing can be drawn on the display ") + display;
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  if (!parse(argc, argv, request)) {
    std::fprintf(stderr,
                 "usage: orchard-fly TREE.orchard [flight|pile|asteroids|robot|box|conveyor|clusters] [--budget TESTS] "
                 "[--bodies N] [--seed N] [--level L] [--bounds] [--frames N] [--screenshot FILE.png]\n");
    return 2;
  }
  runtime::PackedSphereTree tree;
  if (const auto status = runtime::load_file(request.tree.c_str(), tree); status != runtime::LoadStatus::ok) {
    std::fprintf(stderr, "orchard-fly: %s: %s\n", request.tree.c_str(), runtime::message(status));
    return 2;
  }
  if (const std::string missing = window_missing(); !missing.empty()) {
    std::fprintf(stderr, "orchard-fly: no window was opened: %s\n", missing.c_str());
    return 1;
  }
  fly(request, tree);
  return 0;
}
