#include "simulation.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <chrono>
#include <cmath>
#include <iterator>
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
  record.pairs += step.overlapping;
  record.no += step.overlapping - step.pairs.size();
  record.work += step.work;
  record.motions += step.motions;
  record.left_over += step.left_over;
  record.seconds_detection += step.seconds;
  for (const PairOutcome& pair : step.pairs) {
    switch (pair.verdict.answer) {
      case Answer::no:
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

constexpr const char* kLimitNames[] = {"none", "work", "time"};  // by Limits

Limits limits_of(const runtime::Budget& budget) {
  if (!budget.limited()) return Limits::none;
  return budget.time == runtime::Budget{}.time ? Limits::work : Limits::time;
}

// "4000:-:3:120:-": the work granted, and how far the step's parts got; -: no limit.
std::string to_word(const StepLimit& step) {
  std::string word;
  for (const std::uint64_t number : {step.work, step.cut.broad, step.cut.begun, step.cut.refined, step.cut.swept}) {
    if (!word.empty()) word += ':';
    word += number == runtime::kWholeStep ? "-" : std::to_string(number);
  }
  return word;
}

bool parse_word(const std::string& word, StepLimit& step) {
  const char *at = word.data(), *const end = at + word.size();
  for (std::uint64_t* number : {&step.work, &step.cut.broad, &step.cut.begun, &step.cut.refined, &step.cut.swept}) {
    if (number != &step.work && (at == end || *at++ != ':')) return false;
    if (at != end && *at == '-') {
      *number = runtime::kWholeStep;
      ++at;
      continue;
    }
    const auto [rest, error] = std::from_chars(at, end, *number);
    if (error != std::errc()) return false;
    at = rest;
  }
  return at == end;
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
  recording_ = {scene, checksum(shapes.front().tree), bodies, seed, Limits::none, {}, {}};
}

// A frame's time is shared evenly; work, too, with what does not divide for the first steps.
runtime::Budget Simulation::budget_of_step(const runtime::Budget& frame) const {
  runtime::Budget step = frame;
  if (replay_ != nullptr) {
    step = {};
    step.work = replay_->steps.at(steps_done_).work;
    return step;
  }
  const auto steps = static_cast<std::uint64_t>(steps_);
  if (frame.work != runtime::Budget{}.work) step.work = (frame.work + steps - 1) / steps;
  if (frame.time != std::chrono::nanoseconds::max()) step.time = frame.time / steps_;
  return step;
}

FrameRecord Simulation::frame(const runtime::Budget& budget, const Steering& steering) {
  FrameRecord record;
  record.frame = frames_;
  world_->steering = replay_ != nullptr ? replay_->steering.at(frames_) : steering;
  recording_.steering.push_back(world_->steering);
  recording_.limits = replay_ != nullptr ? replay_->limits : limits_of(budget);
  for (int step = 0; step < steps_; ++step) {
    auto begin = std::chrono::steady_clock::now();
    // Counted again, so that times of steps do not drift off the broad phase's own.
    world_->time = static_cast<double>(steps_done_) * world_->scene.step;
    world_->scene.before(*world_, world_->time);
    record.seconds_other += seconds_since(begin);
    const runtime::Budget allowed = budget_of_step(budget);
    const bool cut_again = replay_ != nullptr && replay_->limits == Limits::time;
    last_ = world_->detection.step(world_->time, allowed, cut_again ? &replay_->steps[steps_done_].cut : nullptr);
    begin = std::chrono::steady_clock::now();
    count(last_, *world_, record);
    recording_.steps.push_back({allowed.work, last_.cut});
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
  out << "orchard-recording 2\n"
      << r.scene << ' ' << r.bodies << ' ' << r.seed << ' ' << r.shape << ' '
      << kLimitNames[static_cast<std::size_t>(r.limits)] << '\n';
  const std::size_t steps = r.steering.empty() ? 0 : r.steps.size() / r.steering.size();
  for (std::size_t f = 0; f < r.steering.size(); ++f) {
    out << r.steering[f].throttle << ' ' << r.steering[f].yaw << ' ' << r.steering[f].pitch;
    for (std::size_t s = 0; s < steps; ++s) out << ' ' << to_word(r.steps[f * steps + s]);
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
  if (!next() || line != "orchard-recording 2")
    fail("not a recording: its first line should be \"orchard-recording 2\"");
  const std::string head_fault = "there should be a scene, bodies, a seed, a checksum, and none, work or time";
  if (!next()) fail(head_fault);
  std::istringstream head(line);
  std::string budget;
  if (!(head >> r.scene >> r.bodies >> r.seed >> r.shape >> budget) || !is_scene(r.scene)) fail(head_fault);
  const auto* const name = std::find(std::begin(kLimitNames), std::end(kLimitNames), budget);
  if (name == std::end(kLimitNames)) fail(head_fault);
  r.limits = static_cast<Limits>(name - std::begin(kLimitNames));
  while (next()) {
    std::istringstream words(line);
    Steering s;
    if (!(words >> s.throttle >> s.yaw >> s.pitch) || !(std::fabs(s.throttle) <= 1) || !(std::fabs(s.yaw) <= 1) ||
        !(std::fabs(s.pitch) <= 1))
      fail("a frame begins with throttle, yaw and pitch, from -1 to 1");
    std::size_t count = 0;
    for (std::string word; words >> word; ++count) {
      if (!parse_word(word, r.steps.emplace_back())) fail("a step has five numbers, as in 4000:-:3:120:-");
    }
    if (count == 0 || (steps != 0 && count != steps)) fail("every frame has the same number of steps");
    steps = count;
    r.steering.push_back(s);
  }
  return r;
}

std::string trace_header() {
  std::string text = "frame,time,bodies,pairs,no,maybe,yes";
  for (std::size_t level = 0; level < kLevels; ++level) text += ",maybe_at_" + std::to_string(level);
  return text + ",worst_bound,work,motions,left_over,state\n";
}

std::string trace_row(const FrameRecord& r) {
  std::ostringstream out;
  out.precision(17);
  out << r.frame << ',' << r.time << ',' << r.bodies << ',' << r.pairs << ',' << r.no << ',' << r.maybe << ',' << r.yes;
  for (const std::size_t count : r.stopped) out << ',' << count;
  out << ',' << r.worst_bound << ',' << r.work << ',' << r.motions << ',' << r.left_over << ',' << hexadecimal(r.state)
      << '\n';
  return out.str();
}

std::string times_header() { return "frame,detection_us,other_us\n"; }

std::string times_row(const FrameRecord& r) {
  std::ostringstream out;
  out << r.frame << ',' << 1e6 * r.seconds_detection << ',' << 1e6 * r.seconds_other << '\n';
  return out.str();
}

}  // namespace orchard::simulation
