#include "simulation.h"

#include <bit>
#include <chrono>
#include <cmath>
#include <sstream>
#include <stdexcept>

namespace orchard::simulation {
namespace {

using runtime::Answer;

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

class Checksum {  // Fowler, Noll, Vo
 public:
  void add(std::uint64_t value) {
    for (int byte = 0; byte < 8; ++byte) {
      sum_ = (sum_ ^ (value & 0xff)) * 0x100000001b3u;
      value >>= 8;
    }
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325u;
};

std::uint64_t state_of(const std::vector<Body>& bodies) {
  Checksum sum;
  for (const Body& body : bodies) {
    if (!body.there) continue;
    for (const double x : body.position) sum.add(x);
    for (const double x : body.velocity) sum.add(x);
    for (const double x : body.attitude) sum.add(x);
  }
  return sum.value();
}

void count(const StepOutcome& step, const World& world, FrameRecord& record) {
  record.pairs += step.pairs.size();
  record.work += step.work;
  record.motions += step.motions;
  record.seconds_broad += step.seconds_broad;
  record.seconds_narrow += step.seconds_narrow;
  for (const PairOutcome& pair : step.pairs) {
    switch (pair.verdict.answer) {
      case Answer::no:
        ++record.no;
        break;
      case Answer::yes:
        ++record.yes;
        break;
      case Answer::maybe: {
        ++record.maybe;
        ++record.stopped[std::min<std::size_t>(pair.verdict.level, kLevels - 1)];
        const double size = world.bodies[pair.a].radius + world.bodies[pair.b].radius;
        record.worst_bound = std::max(record.worst_bound, std::min(pair.verdict.separation_bound, 2 * size));
        break;
      }
    }
  }
}

std::string hexadecimal(std::uint64_t value) {
  std::ostringstream text;
  text << std::hex << value;
  return text.str();
}

}  // namespace

std::string checksum(const runtime::TreeView& tree) {
  Checksum sum;
  for (const auto& block : tree.blocks) {
    for (std::size_t lane = 0; lane < runtime::kBlockWidth; ++lane) {
      for (const float x : {block.x[lane], block.y[lane], block.z[lane], block.radius[lane]})
        sum.add(std::uint64_t{std::bit_cast<std::uint32_t>(x)});
    }
  }
  return hexadecimal(sum.value());
}

Simulation::Simulation(const std::string& scene, const std::vector<Shape>& shapes, std::size_t bodies,
                       std::uint64_t seed, const Recording* replay)
    : world_(make_world(scene, shapes, bodies, seed)), replay_(replay) {
  steps_ = static_cast<int>(std::lround(world_->scene.frame / world_->scene.step));
  recording_ = {scene, checksum(shapes.front().tree), bodies, seed, false, {}, {}};
}

// A frame's time is shared evenly; work, too, with what does not divide for the first steps.
runtime::Budget Simulation::budget_of_step(const runtime::Budget& frame) const {
  if (replay_ != nullptr) {
    const std::uint64_t work = replay_->work.at(steps_done_);
    return replay_->budgeted ? runtime::Budget{work, std::chrono::nanoseconds::max()} : runtime::Budget{};
  }
  const auto steps = static_cast<std::uint64_t>(steps_);
  runtime::Budget step = frame;
  if (frame.pair_tests != runtime::Budget{}.pair_tests) step.pair_tests = (frame.pair_tests + steps - 1) / steps;
  if (frame.time != std::chrono::nanoseconds::max()) step.time = frame.time / steps_;
  return step;
}

FrameRecord Simulation::frame(const runtime::Budget& budget, const Steering& steering) {
  FrameRecord record;
  record.frame = frames_;
  world_->steering = replay_ != nullptr ? replay_->steering.at(frames_) : steering;
  recording_.steering.push_back(world_->steering);
  recording_.budgeted = replay_ != nullptr ? replay_->budgeted : !unlimited(budget);
  for (int step = 0; step < steps_; ++step) {
    auto begin = std::chrono::steady_clock::now();
    // Counted anew, so that times of steps do not drift off the broad phase's own.
    world_->time = static_cast<double>(steps_done_) * world_->scene.step;
    world_->scene.before(*world_, world_->time);
    record.seconds_other += seconds_since(begin);
    last_ = world_->detection.step(world_->time, budget_of_step(budget));
    begin = std::chrono::steady_clock::now();
    count(last_, *world_, record);
    recording_.work.push_back(last_.refined);
    respond_and_move(*world_, last_);
    record.seconds_other += seconds_since(begin);
    ++steps_done_;
  }
  ++frames_;
  record.time = world_->time;
  for (const Body& body : world_->bodies) record.bodies += body.there;
  record.state = state_of(world_->bodies);
  return record;
}

std::string to_text(const Recording& r) {
  std::ostringstream out;
  out.precision(17);
  out << "orchard-recording 1\n"
      << r.scene << ' ' << r.bodies << ' ' << r.seed << ' ' << r.shape << ' ' << (r.budgeted ? "budgeted" : "unlimited")
      << '\n';
  const std::size_t steps = r.steering.empty() ? 0 : r.work.size() / r.steering.size();
  for (std::size_t f = 0; f < r.steering.size(); ++f) {
    out << r.steering[f].throttle << ' ' << r.steering[f].yaw << ' ' << r.steering[f].pitch;
    for (std::size_t s = 0; s < steps; ++s) out << ' ' << r.work[f * steps + s];
    out << '\n';
  }
  return out.str();
}

Recording parse_recording(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::size_t number = 0, steps = 0;
  const auto fail = [&](const std::string& what) {
    throw std::runtime_error("line " + std::to_string(number) + ": " + what);
  };
  const auto next = [&] {
    ++number;
    return static_cast<bool>(std::getline(lines, line));
  };
  Recording r;
  if (!next() || line != "orchard-recording 1")
    fail("not a recording: its first line should be \"orchard-recording 1\"");
  const std::string head_fault = "there should be a scene, bodies, a seed, a checksum, and budgeted or unlimited";
  if (!next()) fail(head_fault);
  std::istringstream head(line);
  std::string budget;
  if (!(head >> r.scene >> r.bodies >> r.seed >> r.shape >> budget) || !is_scene(r.scene) ||
      (budget != "budgeted" && budget != "unlimited"))
    fail(head_fault);
  r.budgeted = budget == "budgeted";
  while (next()) {
    std::istringstream words(line);
    Steering s;
    if (!(words >> s.throttle >> s.yaw >> s.pitch) || !(std::fabs(s.throttle) <= 1) || !(std::fabs(s.yaw) <= 1) ||
        !(std::fabs(s.pitch) <= 1))
      fail("a frame begins with throttle, yaw and pitch, from -1 to 1");
    std::size_t count = 0;
    for (std::uint64_t work = 0; words >> work; ++count) r.work.push_back(work);
    if (!words.eof() || count == 0 || (steps != 0 && count != steps))
      fail("every frame has the same number of steps, with a whole number of tests each");
    steps = count;
    r.steering.push_back(s);
  }
  return r;
}

std::string trace_header() {
  std::string text = "frame,time,bodies,pairs,no,maybe,yes";
  for (std::size_t level = 0; level < kLevels; ++level) text += ",maybe_at_" + std::to_string(level);
  return text + ",worst_bound,work,motions,state\n";
}

std::string trace_row(const FrameRecord& r) {
  std::ostringstream out;
  out.precision(17);
  out << r.frame << ',' << r.time << ',' << r.bodies << ',' << r.pairs << ',' << r.no << ',' << r.maybe << ',' << r.yes;
  for (const std::size_t count : r.stopped) out << ',' << count;
  out << ',' << r.worst_bound << ',' << r.work << ',' << r.motions << ',' << hexadecimal(r.state) << '\n';
  return out.str();
}

std::string times_header() { return "frame,broad_us,narrow_us,other_us\n"; }

std::string times_row(const FrameRecord& r) {
  std::ostringstream out;
  out << r.frame << ',' << 1e6 * r.seconds_broad << ',' << 1e6 * r.seconds_narrow << ',' << 1e6 * r.seconds_other
      << '\n';
  return out.str();
}

}  // namespace orchard::simulation
