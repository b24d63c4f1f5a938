// Section 4.4: M and d of an object that a user drags, predicted from noisy samples, by finite differences, by a spring
// and by a Kalman filter:  sec_4_4_tracking [folder for CSV and SVG] [minutes of dragging]
// No recording is published, so the hand is simulated: it reaches for one random place in a ball of 0.3 m after the
// other along minimum-jerk paths (Flash and Hogan 1985) of 0.3 to 1 s, with pauses. A tracker gives 60 samples a second
// with normal jitter of 0.5 mm; one in fifty is lost, and then up to eight more. At each frame a bound is asked for
// that is to hold for 0.1 s. Tightness is how far the bound reaches at its end, from its middle; a promise is broken if
// the object leaves the bound before. Finite differences take the last three samples that lie equally far apart, and
// allow for four standard deviations of jitter in the position.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "broad_phase_methods/motion_filter.h"
#include "orchard/runtime/motion_helpers.h"
#include "svg_plot.h"
#include "worlds.h"

namespace {

using namespace orchard::runtime;
using orchard::broad_phase_methods::MotionFilter;
using orchard::plot::Plot;
using orchard::plot::Series;

constexpr double kFrame = 1.0 / 60, kHorizon = 0.1, kJitter = 5e-4;  // seconds, seconds, metres
constexpr int kFine = 16;                                            // times at which a frame is looked at
constexpr int kAhead = static_cast<int>(kHorizon / kFrame + 0.5);    // frames
constexpr double kFineStep = kFrame / kFine;

class Noise : public test::Draw {
 public:
  using test::Draw::Draw;
  double normal() { return std::sqrt(-2 * std::log(uniform(1e-300, 1))) * std::cos(uniform(0, 2 * std::numbers::pi)); }
};

// What the hand does at each fine time, and what the tracker gives at each frame.
struct Drag {
  std::vector<Vec3> hand;
  std::vector<std::optional<Vec3>> samples;
};

std::vector<Vec3> reaching(double seconds, Noise& noise) {
  std::vector<Vec3> hand;
  Vec3 from{};
  while (static_cast<double>(hand.size()) * kFineStep < seconds) {
    const Vec3 to = noise.in_ball(0.3);
    const double duration = noise.uniform(0.3, 1), pause = noise.uniform(0, 0.4);
    for (double t = 0; t < duration + pause; t += kFineStep) {
      const double s = std::min(1.0, t / duration);
      hand.push_back(from + (s * s * s * (10 + s * (6 * s - 15))) * (to - from));
    }
    from = to;
  }
  return hand;
}

Drag drag_of(double seconds, std::uint64_t seed) {
  Noise noise(seed);
  Drag drag{reaching(seconds, noise), {}};
  int lost = 0;
  for (std::size_t i = 0; i < drag.hand.size(); i += kFine) {
    if (lost == 0 && noise.uniform(0, 1) < 0.02) lost = 1 + static_cast<int>(noise.uniform(0, 9));
    const Vec3 jitter{kJitter * noise.normal(), kJitter * noise.normal(), kJitter * noise.normal()};
    drag.samples.push_back(lost > 0 ? std::nullopt : std::optional(drag.hand[i] + jitter));
    lost -= lost > 0;
  }
  return drag;
}

// A bound that an approach gives at a frame, and of what: the hand, or an object that follows it.
struct Promise {
  std::size_t frame;
  Motion motion;  // as of the frame
};

struct Outcome {
  double reach = 0, bound = 0;      // medians, metres: at the horizon; M
  double broken = 0, too_weak = 0;  // shares: of the bounds; of M, less than the acceleration that followed
  double directed = 0, wrong = 0;   // shares: with a half-space; of those, that the acceleration left
  double lag = 0;                   // metres on average, of the object behind the hand
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

// The acceleration of a path at a fine time, by differences of what is known without noise.
Vec3 acceleration(const std::vector<Vec3>& path, std::size_t i) {
  return (1 / (kFineStep * kFineStep)) * (path[i + 1] - 2.0 * path[i] + path[i - 1]);
}

bool holds(const Motion& m, double s, const Vec3& position) {
  const Vec3 off = position - (m.position + s * m.velocity);
  const double more = m.radius + m.drift * s, size = length(m.half_space);
  return length(off) <= more + m.acceleration * s * s / 2 && (size == 0 || dot(off, m.half_space) <= more * size);
}

Outcome judge(const std::vector<Promise>& promises, const std::vector<Vec3>& path, const std::vector<Vec3>& hand) {
  Outcome outcome;
  std::vector<double> reaches, bounds;
  double directed = 0;
  for (const auto& [frame, m] : promises) {
    reaches.push_back(m.radius + m.drift * kHorizon + m.acceleration * kHorizon * kHorizon / 2);
    bounds.push_back(m.acceleration);
    bool holding = true, enough = true, on_side = true;
    for (std::size_t k = 0; k <= kAhead * kFine; ++k) {
      const std::size_t i = frame * kFine + k;
      const Vec3 a = acceleration(path, i);
      holding = holding && holds(m, static_cast<double>(k) * kFineStep, path[i]);
      enough = enough && length(a) <= m.acceleration * (1 + 1e-6);
      on_side = on_side && dot(a, m.half_space) <= 1e-6;
    }
    const bool has_side = length(m.half_space) > 0;
    outcome.broken += !holding, outcome.too_weak += !enough, directed += has_side, outcome.wrong += !on_side;
    outcome.lag += length(path[frame * kFine] - hand[frame * kFine]);
  }
  const auto count = static_cast<double>(promises.size());
  outcome.reach = median(reaches), outcome.bound = median(bounds);
  outcome.broken /= count, outcome.too_weak /= count, outcome.lag /= count;
  outcome.wrong /= std::max(1.0, directed), outcome.directed = directed / count;
  return outcome;
}

constexpr std::size_t kWarmUp = 60;  // frames without a promise

std::size_t frames_of(const Drag& drag) { return drag.hand.size() / kFine - kAhead - 1; }

// The same motion as of a later time.
Motion aged(Motion m, double age) {
  m.position = m.position + age * m.velocity;
  m.radius += m.drift * age + m.acceleration * age * age / 2;
  m.drift += m.acceleration * age;
  return m;
}

Outcome by_differences(const Drag& drag, double max_jerk, std::size_t stride) {
  std::vector<Promise> promises;
  for (std::size_t frame = kWarmUp; frame < frames_of(drag); ++frame) {
    const auto known = [&](std::size_t last) {
      return drag.samples[last] && drag.samples[last - stride] && drag.samples[last - 2 * stride];
    };
    std::size_t last = frame;
    while (last > 2 * stride && !known(last)) --last;
    if (!known(last)) continue;
    const Dragged dragged{*drag.samples[last - 2 * stride],
                          *drag.samples[last - stride],
                          *drag.samples[last],
                          static_cast<double>(stride) * kFrame,
                          4 * kJitter,
                          max_jerk};
    const double age = static_cast<double>(frame - last) * kFrame;
    promises.push_back({frame, aged(dragged_motion(dragged, 0, age + kHorizon), age)});
  }
  return judge(promises, drag.hand, drag.hand);
}

Outcome by_filter(const Drag& drag, double jerk_density, double confidence) {
  MotionFilter filter({.noise = kJitter,
                       .jerk_density = jerk_density,
                       .max_speed = 1,
                       .max_acceleration = 10,
                       .confidence = confidence});
  std::vector<Promise> promises;
  for (std::size_t frame = 0; frame < frames_of(drag); ++frame) {
    const double time = static_cast<double>(frame) * kFrame;
    if (drag.samples[frame]) filter.add(time, *drag.samples[frame]);
    if (frame >= kWarmUp) promises.push_back({frame, filter.motion(0, time, kHorizon)});
  }
  return judge(promises, drag.hand, drag.hand);
}

// The object hangs on a critically damped spring to the last sample.
Outcome by_spring(const Drag& drag, double frequency, double cursor_reach) {
  const double stiffness = frequency * frequency, damping = 2 * frequency;
  constexpr int kParts = 4;  // of a fine step
  std::vector<Promise> promises;
  std::vector<Vec3> path;
  Vec3 y{}, v{}, cursor{};
  for (std::size_t frame = 0; frame < frames_of(drag) + kAhead + 1; ++frame) {
    if (drag.samples[frame]) cursor = *drag.samples[frame];
    if (frame >= kWarmUp && frame < frames_of(drag))
      promises.push_back({frame, spring_motion({y, v, 0, cursor, stiffness, damping, cursor_reach}, 0, kHorizon)});
    for (int i = 0; i < kFine; ++i) {
      path.push_back(y);
      for (int k = 0; k < kParts; ++k) {
        const double h = kFineStep / kParts;
        v = v + h * (stiffness * (cursor - y) - damping * v);
        y = y + h * v;
      }
    }
  }
  return judge(promises, path, drag.hand);
}

struct Trial {
  std::string approach, parameters;
  std::function<Outcome(const Drag&)> run;
};

std::string text(const char* format, double a, double b) {
  char buffer[80];
  std::snprintf(buffer, sizeof buffer, format, a, b);
  return buffer;
}

std::vector<Trial> trials() {
  std::vector<Trial> all;
  for (const std::size_t stride : {1u, 3u, 6u})
    for (const double jerk : {10.0, 30.0, 100.0, 300.0, 1000.0})
      all.push_back({"finite differences, step " + std::to_string(stride) + "/60 s", text("jerk %.0f m/s^3", jerk, 0),
                     [=](const Drag& drag) { return by_differences(drag, jerk, stride); }});
  for (const double frequency : {10.0, 20.0, 40.0})
    for (const double reach : {0.003, 0.01, 0.03})
      all.push_back({text("spring, %.0f/s", frequency, 0), text("cursor within %.3f m", reach, 0),
                     [=](const Drag& drag) { return by_spring(drag, frequency, reach); }});
  for (const double confidence : {0.9, 0.99, 0.999})
    for (const double density : {10.0, 30.0, 100.0, 300.0, 1000.0})
      all.push_back({text("Kalman filter, confidence %.3g", confidence, 0),
                     text("jerk density %.0f m^2/s^5", density, 0),
                     [=](const Drag& drag) { return by_filter(drag, density, confidence); }});
  return all;
}

// The fastest of many rounds of all samples.
void print_speed(const Drag& drag) {
  using Clock = std::chrono::steady_clock;
  MotionFilter filter;
  double sum = 0, sampling = 1e300, asking = 1e300;
  const std::size_t count = std::min<std::size_t>(drag.samples.size(), 2000);
  for (int round = 0; round < 200; ++round) {
    filter.reset();
    const auto begin = Clock::now();
    for (std::size_t i = 0; i < count; ++i) filter.add(static_cast<double>(i) * kFrame, drag.hand[i * kFine]);
    const auto middle = Clock::now();
    for (std::size_t i = 0; i < count; ++i)
      sum += filter.motion(0, static_cast<double>(count + i) * kFrame, kHorizon).acceleration;
    const auto end = Clock::now();
    sampling = std::min(sampling, std::chrono::duration<double>(middle - begin).count());
    asking = std::min(asking, std::chrono::duration<double>(end - middle).count());
  }
  std::printf("\nThe filter takes %.0f ns for a sample and %.0f ns for a bound%s.\n",
              1e9 * sampling / static_cast<double>(count), 1e9 * asking / static_cast<double>(count),
              sum > 0 ? "" : " (M is never positive)");
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  const double minutes = argc > 2 ? std::max(0.1, std::atof(argv[2])) : 10;
  std::filesystem::create_directories(folder);
  const Drag drag = drag_of(60 * minutes, 1);
  std::ofstream csv(folder / "sec_4_4.csv");
  csv << "approach,parameters,reach,bound,broken,too_weak,directed,wrong,lag\n";
  std::printf(
      "| approach | assumed | reach after 0.1 s, median mm | promises broken, %% | M, median m/s^2 | M too small, %% "
      "| with d, %% | d wrong, %% of those | lag, mm |\n|---|---|--:|--:|--:|--:|--:|--:|--:|\n");
  Plot plot{.title = "4.4: tightness against broken promises",
            .x_label = "reach after 0.1 s, median mm",
            .y_label = "promises broken, % (0.01 for none)",
            .log_x = true,
            .log_y = true,
            .series = {},
            .levels = {},
            .x_names = {}};
  for (const Trial& trial : trials()) {
    const Outcome o = trial.run(drag);
    std::printf("| %s | %s | %.1f | %.2f | %.1f | %.1f | %.0f | %.1f | %.1f |\n", trial.approach.c_str(),
                trial.parameters.c_str(), 1e3 * o.reach, 100 * o.broken, o.bound, 100 * o.too_weak, 100 * o.directed,
                100 * o.wrong, 1e3 * o.lag);
    csv << '"' << trial.approach << "\",\"" << trial.parameters << "\"," << o.reach << ',' << o.bound << ',' << o.broken
        << ',' << o.too_weak << ',' << o.directed << ',' << o.wrong << ',' << o.lag << '\n';
    if (plot.series.empty() || plot.series.back().name != trial.approach)
      plot.series.push_back({trial.approach, {}, {}, Series::Kind::line});
    plot.series.back().x.push_back(1e3 * o.reach);
    plot.series.back().y.push_back(std::max(0.01, 100 * o.broken));
  }
  print_speed(drag);
  orchard::plot::write_svg(folder / "sec_4_4.svg", {plot});
  return 0;
}
