// Whole frames of every scene: the detector against other libraries, with one and with two threads, and within budgets.
//   detector_bench frames BODIES STEPS            a table; rivals that are not installed are left out
//   detector_bench threads BODIES STEPS
//   detector_bench budgets BODIES STEPS all FRAMES    so many frames of steps that are played forth and back
//   detector_bench own BODIES STEPS               the detector alone, ten times, for a profiler
// Of all scenes, or with a scene's name after the steps of that one alone.
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "frame_rival.h"
#include "scene_run.h"
#include "thread_pool.h"

namespace {

using namespace orchard;
using runtime::test::Promises;
using runtime::test::Scene;
using Clock = std::chrono::steady_clock;

// Of this thread: what else the machine does is left out.
double processor_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

// What processor_ms() itself takes, which is more than a microsecond where it is a call of the kernel's: taken off what
// lies between two of them. Half of the calls take less.
double processor_clock_ms() {
  static const double taken = [] {
    std::array<double, 1001> times{};
    for (double& time : times) {
      const double before = processor_ms();
      time = processor_ms() - before;
    }
    std::nth_element(times.begin(), times.begin() + 500, times.end());
    return times[500];
  }();
  return taken;
}

double processor_ms_since(double before) { return processor_ms() - before - processor_clock_ms(); }

double milliseconds(Clock::duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

struct Run {
  double ms = 0, processor = 0;  // over all frames but the first, which makes everything
  std::size_t touching = 0;
  std::uint64_t pairs = 0, work = 0;
};

// The application's states of a step are its own business, and ready before the clock runs.
class OrchardFrames {
 public:
  OrchardFrames(const Scene& scene, runtime::Executor executor, bool watch = false)
      : scene_(scene), values_(2 * scene.bodies.size() + 64), ids_(scene.bodies.size()) {
    runtime::DetectorOptions options;
    options.time_step = scene.dt;
    options.executor = executor;
    options.watch = watch;
    detector_ = std::make_unique<runtime::Detector>(runtime::states_of(values_), options);
    for (const auto& shape : scene.shapes) {
      using Kind = runtime::test::SceneShape::Kind;
      shapes_.push_back(shape.kind == Kind::tree    ? detector_->add_shape(shape.tree)
                        : shape.kind == Kind::round ? detector_->add_capsule(shape.p, shape.q, shape.radius)
                                                    : detector_->add_box(shape.p));
    }
    for (const auto& plane : scene.planes) detector_->add_half_space(plane.normal, plane.offset);
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      const auto& body = scene.bodies[i];
      const bool always = body.birth <= 0 && body.death >= scene.steps;
      if (!always || scene.joints(i) > 0) changing_.push_back(i);
      everyone_.push_back(i);
    }
  }

  double processor = 0;  // of the last step, in ms

  // Frames beyond the recording play it back, then forth again.
  runtime::Frame step(int frame_number, const runtime::Budget& budget, Clock::duration& time) {
    const int period = 2 * (scene_.steps - 1), phase = frame_number % period;
    const bool back = phase >= scene_.steps - 1 && frame_number >= scene_.steps;
    const int step = phase < scene_.steps ? phase : period - phase;
    const double now = frame_number * scene_.dt;
    const auto state_of = [&](std::size_t i) {
      if (back) return scene_.state_backwards(step, now, i, 8);
      runtime::BodyState state = scene_.state(step, i, 8);
      state.expiry += now - step * scene_.dt;
      return state;
    };
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      if (ids_[i] != runtime::kNoBody) values_[ids_[i].index] = state_of(i);
    }
    const auto begin = Clock::now();
    const double before = processor_ms();
    const auto& visited = added_ ? changing_ : everyone_;
    added_ = true;
    for (const std::size_t i : visited) {
      const bool there = scene_.bodies[i].birth <= step && step < scene_.bodies[i].death;
      if (there && ids_[i] == runtime::kNoBody) {
        parts_.clear();
        for (std::size_t k = 0; k < scene_.bodies[i].parts.size(); ++k) {
          parts_.push_back({shapes_[scene_.bodies[i].parts[k]], scene_.local(step, i, k)});
        }
        ids_[i] = scene_.bodies[i].is_static
                      ? detector_->add_static(parts_, scene_.poses[static_cast<std::size_t>(step)][i])
                      : detector_->add_body(parts_, scene_.bodies[i].options);
        values_[ids_[i].index] = state_of(i);
      } else if (!there && ids_[i] != runtime::kNoBody) {
        detector_->remove(ids_[i]);
        ids_[i] = runtime::kNoBody;
      }
      const std::size_t joints = there ? scene_.joints(i) : 0;
      for (std::size_t k = 0; k < joints; ++k) detector_->set_local(ids_[i], k, scene_.local(step, i, k));
    }
    const runtime::Frame frame = detector_->step(now, budget);
    processor = processor_ms_since(before);
    time = Clock::now() - begin;
    return frame;
  }

 private:
  const Scene& scene_;
  std::vector<runtime::BodyState> values_;
  std::vector<runtime::BodyId> ids_;
  std::vector<std::size_t> everyone_, changing_;  // changing_: what comes, goes, or has parts that move
  bool added_ = false;
  std::vector<runtime::ShapeId> shapes_;
  std::vector<runtime::BodyPart> parts_;
  std::unique_ptr<runtime::Detector> detector_;
};

Run run_orchard(const Scene& scene, runtime::Executor executor) {
  OrchardFrames frames(scene, executor);
  Run run;
  for (int step = 0; step < scene.steps; ++step) {
    Clock::duration time{};
    const runtime::Frame frame = frames.step(step, {}, time);
    if (step == 0) continue;
    run.ms += milliseconds(time);
    run.processor += frames.processor;
    run.pairs += frame.pairs, run.work += frame.work;
    for (const auto& event : frame.events) run.touching += event.change != runtime::PairChange::end;
  }
  return run;
}

Run run_rival(const Scene& scene, bench::FrameRival& rival) {
  Run run;
  for (int step = 0; step < scene.steps; ++step) {
    const double begin = processor_ms();
    const std::size_t touching = rival.step(step);
    if (step == 0) continue;
    run.processor += processor_ms_since(begin);
    run.touching += touching;
  }
  return run;
}

struct Wanted {
  std::size_t bodies = 1000;
  int steps = 100;
  std::string scene = "all";
  int frames = 0;  // 0: as many as steps
};

// One at a time: a recording of 100,000 bodies takes some 10 MB a step.
template <typename Visit>
void for_scenes(const Wanted& wanted, Visit&& visit) {
  struct Maker {
    const char* name;
    Scene (*make)(std::size_t, int, std::uint64_t);
    std::uint64_t seed;
  };
  using namespace runtime::test;
  for (const auto& [name, make, seed] :
       {Maker{"flight", flight, 1}, Maker{"falling pile", falling_pile, 2}, Maker{"asteroid field", asteroid_field, 3},
        Maker{"robot arm", robot_arm, 4}, Maker{"machines", machines, 8}, Maker{"bouncing box", bouncing_box, 5},
        Maker{"conveyor", conveyor, 6}, Maker{"clusters", clusters, 7}, Maker{"chain", chain, 1}}) {
    if (wanted.scene == "all" || wanted.scene == name) visit(make(wanted.bodies, wanted.steps, seed));
  }
}

void own(const Wanted& wanted) {
  for_scenes(wanted, [&](const Scene& scene) {
    double least = std::numeric_limits<double>::infinity();
    std::uint64_t work = 0;
    for (int round = 0; round < 10; ++round) {
      const Run run = run_orchard(scene, {});
      least = std::min(least, run.processor);
      work = run.work;
    }
    const int timed = wanted.steps - 1;
    std::printf("%s: %.3f ms a frame, work %.0f\n", scene.name.c_str(), least / timed, double(work) / timed);
  });
}

void frames(const Wanted& wanted) {
  std::printf(
      "| scene | bodies | pairs a frame | touching | orchard, ms a frame | FCL float | FCL double | Bullet |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for_scenes(wanted, [&](const Scene& scene) {
    const Run ours = run_orchard(scene, {});
    const int timed = wanted.steps - 1;
    std::printf("| %s | %zu | %.0f | %.0f | %.3f |", scene.name.c_str(), wanted.bodies, double(ours.pairs) / timed,
                double(ours.touching) / timed, ours.processor / timed);
    for (auto* make : {bench::fcl_frames_float, bench::fcl_frames_double, bench::bullet_frames}) {
      const auto rival = make(scene);
      if (!rival) {
        std::printf(" - |");
        continue;
      }
      const Run theirs = run_rival(scene, *rival);
      std::printf(" %.1f times", theirs.processor / ours.processor);
      if (theirs.touching != ours.touching) {
        std::printf(" (%+.2f %% touching)", 100 * (double(theirs.touching) / double(ours.touching) - 1));
      }
      std::printf(" |");
      std::fflush(stdout);
    }
    std::printf("\n");
    std::fflush(stdout);
  });
}

// What a round of jobs without work takes, in microseconds, when the threads look for work: half of them take less.
double empty_round(runtime::Executor executor) {
  std::vector<double> times(1001);
  for (double& time : times) {
    const auto begin = Clock::now();
    executor.run(
        executor.context, 2, [](void*, std::size_t) {}, nullptr);
    time = 1e3 * milliseconds(Clock::now() - begin);
  }
  std::nth_element(times.begin(), times.begin() + 500, times.end());
  return times[500];
}

void threads(const Wanted& wanted) {
  constexpr runtime::test::ThreadPool::Duration kAwake(500);  // as in an engine, whose frames are full of jobs
  runtime::test::ThreadPool pool(2, kAwake);
  std::printf("An empty round of jobs takes %.1f us.\n\n", empty_round(pool.executor()));
  std::printf("| scene | bodies | ms a frame | with 2 threads |\n|---|---|---|---|\n");
  for_scenes(wanted, [&](const Scene& scene) {
    double one = 1e300, two = 1e300;
    for (int round = 0; round < 3; ++round) {
      one = std::min(one, run_orchard(scene, {}).ms);
      two = std::min(two, run_orchard(scene, pool.executor()).ms);
    }
    std::printf("| %s | %zu | %.3f | %.2f times as fast |\n", scene.name.c_str(), wanted.bodies,
                one / (wanted.steps - 1), one / two);
    std::fflush(stdout);
  });
}

// Whether the machine took the thread away since, as far as it tells: by its own count, or by the clock's.
class Preemption {
 public:
  bool happened(Clock::duration time, double processor) const {
    constexpr double kNoise = 0.02;  // ms between two clocks
    return switches() != before_ || milliseconds(time) > processor + kNoise;
  }

 private:
  static long switches() {
    rusage usage{};
    getrusage(RUSAGE_THREAD, &usage);
    return usage.ru_nivcsw;
  }
  long before_ = switches();
};

double percent(std::uint64_t part, std::uint64_t whole) {
  return 100.0 * double(part) / double(std::max<std::uint64_t>(whole, 1));
}

void budget_in_work(const Scene& scene, int count, std::uint64_t work) {
  OrchardFrames frames(scene, {});
  std::int64_t beyond = std::numeric_limits<std::int64_t>::min();
  std::uint64_t certain = 0, pairs = 0;
  Clock::duration time{};
  for (int i = 0; i < count; ++i) {
    const runtime::Frame frame = frames.step(i, {.work = work}, time);
    beyond = std::max(beyond, static_cast<std::int64_t>(frame.work) - static_cast<std::int64_t>(work));
    certain += frame.certain, pairs += frame.pairs;
  }
  std::printf(" %llu | %lld | %.1f %% |", static_cast<unsigned long long>(work), static_cast<long long>(beyond),
              percent(certain, pairs));
  std::fflush(stdout);
}

void budget_in_time(const Scene& scene, int count, double limit) {
  OrchardFrames frames(scene, {});
  std::vector<double> calm, disturbed;
  std::uint64_t certain = 0, pairs = 0;
  Clock::duration time{};
  for (int i = 0; i < count; ++i) {
    const Preemption preemption;
    const runtime::Frame frame =
        frames.step(i, {.time = std::chrono::nanoseconds(static_cast<std::int64_t>(limit * 1e6))}, time);
    if (i == 0) continue;
    certain += frame.certain, pairs += frame.pairs;
    (preemption.happened(time, frames.processor) ? disturbed : calm).push_back(milliseconds(time));
  }
  std::sort(calm.begin(), calm.end());
  const auto at = [&](double share) {
    return calm.empty() ? 0.0 : calm[std::min(calm.size() - 1, static_cast<std::size_t>(share * double(calm.size())))];
  };
  const double worst = disturbed.empty() ? 0 : *std::max_element(disturbed.begin(), disturbed.end());
  std::printf(" %.3f | %.3f | %.3f | %.3f | %.3f | %zu (%.3f) | %.1f %% |\n", limit, at(0.5), at(0.99), at(0.999),
              at(1), disturbed.size(), worst, percent(certain, pairs));
  std::fflush(stdout);
}

// The budget is half of what a frame takes in the mean without one.
void budgets(const Wanted& wanted) {
  std::printf(
      "| scene | bodies | frames | work a frame | budget | most beyond it | certain | budget, ms | p50 | p99 | p99.9 | "
      "max | preempted (max) | certain |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for_scenes(wanted, [&](const Scene& scene) {
    const int timed = wanted.steps - 1, count = std::max(wanted.frames, wanted.steps);
    const Run full = run_orchard(scene, {});
    std::printf("| %s | %zu | %d | %.0f |", scene.name.c_str(), wanted.bodies, count, double(full.work) / timed);
    budget_in_work(scene, count, full.work / static_cast<std::uint64_t>(2 * timed));
    budget_in_time(scene, count, std::max(0.05, full.ms / (2 * timed)));
  });
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  Wanted wanted;
  if (argc > 2) wanted.bodies = static_cast<std::size_t>(std::max(1, std::atoi(argv[2])));
  if (argc > 3) wanted.steps = std::max(3, std::atoi(argv[3]));
  if (argc > 4) wanted.scene = argv[4];
  if (argc > 5) wanted.frames = std::atoi(argv[5]);
  if (what == "frames") return frames(wanted), 0;
  if (what == "threads") return threads(wanted), 0;
  if (what == "budgets") return budgets(wanted), 0;
  if (what == "own") return own(wanted), 0;
  std::fprintf(stderr, "usage: detector_bench frames|threads|budgets|own [BODIES [STEPS [SCENE|all [FRAMES]]]]\n");
  return 2;
}
