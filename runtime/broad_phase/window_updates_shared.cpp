#include <new>

#include "broad_phase/window_updates.h"
#include "execution/guarded.h"

// Window updates of many bodies, all of whose windows start over, by jobs that may run at once. Bodies come in waves.
// Of a wave each job first makes the boxes of a chunk, and notes which lines of the grid they go to; then each puts
// those of all chunks into one part of the lines, and tests what it finds near. How that is cut depends on the number
// of bodies alone, and everything that has an order is put together in that of the chunks, or of the parts: so nothing
// depends on the executor. One thread gains by it, too, where all lines do not fit into its cache and a part of them
// does.
namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kChunks = 8;         // in a wave
constexpr std::size_t kMaxWave = 32768;    // bodies; waves are as large as each other, so that none is a rest
constexpr std::size_t kSampledEvery = 64;  // of which one says how bodies move: there are enough

}  // namespace

struct WindowUpdates::Chunk {
  struct Run {
    Step end;
    std::size_t bodies;
  };
  SweptGrid::VisitsByPart visits;
  std::vector<BodyIndex> placed;   // in order
  std::vector<Run> runs;           // of these, those one after the other whose windows end together
  std::vector<BodyIndex> unknown;  // what holds from the later step on
  std::vector<BodyIndex> rest;     // not valid, or too large: updated one by one
  std::vector<Motion> sampled;     // for the plan
  QuantizedAabb extent;
  BodyPool::Answers answers;
  std::uint64_t asked;

  void note_run(Step end, std::size_t bodies) {
    if (runs.empty() || runs.back().end != end) runs.push_back({end, 0});
    runs.back().bodies += bodies;
  }
  void clear() noexcept {
    for (auto& part : visits) part.clear();
    placed.clear(), runs.clear(), unknown.clear(), rest.clear(), sampled.clear();
    extent = BoxIndex::nothing();
    asked = 0;
  }
  std::size_t memory_bytes() const noexcept {
    std::size_t bytes = bytes_of(placed) + bytes_of(runs) + bytes_of(unknown) + bytes_of(rest) + bytes_of(sampled) +
                        bytes_of(answers.moving) + bytes_of(answers.motions);
    for (const auto& part : visits) bytes += part.memory_bytes();
    return bytes;
  }
};

struct WindowUpdates::GridPart {
  std::vector<BodyPair> near;
  GridCounts counts;
  NearPairs::Outcome outcome;
};

struct WindowUpdates::Shared {
  std::array<Chunk, kChunks> chunks;
  std::array<GridPart, SweptGrid::kParts> parts;
  std::vector<BodyIndex> rest;
};

WindowUpdates::WindowUpdates(const Parts& parts, const BroadPhaseOptions& options) : parts_(parts), options_(options) {}
WindowUpdates::~WindowUpdates() = default;

std::size_t WindowUpdates::memory_bytes() const noexcept {
  std::size_t bytes = bytes_of(motions_) + bytes_of(near_);
  if (!shared_) return bytes;
  bytes += sizeof(Shared) + bytes_of(shared_->rest);
  for (const Chunk& chunk : shared_->chunks) bytes += chunk.memory_bytes();
  for (const GridPart& part : shared_->parts) bytes += bytes_of(part.near) + part.outcome.memory_bytes();
  return bytes;
}

// Nothing may be thrown through an executor: lack of memory is told when all jobs have ended.
template <typename Job>
void WindowUpdates::run_all(std::size_t count, const Job& job) {
  if (options_.executor.run == nullptr) {
    for (std::size_t i = 0; i < count; ++i) job(i);
    return;
  }
  std::array<bool, std::max(kChunks, 1 + SweptGrid::kParts)> done{};
  auto guarded_job = [&](std::size_t i) { done[i] = guarded([&] { return job(i), true; }, [] { return false; }); };
  run_jobs(options_.executor, count, guarded_job);
  if (std::all_of(done.begin(), done.begin() + static_cast<std::ptrdiff_t>(count), [](bool d) { return d; })) return;
#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
  throw std::bad_alloc();
#endif
}

// Those of a block that can be placed now; the others are left to the rest.
void WindowUpdates::place_shared(Chunk& chunk, Block& block, std::span<BodyIndex> bodies,
                                 std::span<Motion> motions) const {
  std::size_t count = bodies.size();
  const auto leave_unless = [&](const auto& good) {
    std::size_t front = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (!good(i)) {
        chunk.rest.push_back(bodies[i]);
        continue;
      }
      bodies[front] = bodies[i];
      motions[front++] = motions[i];
    }
    count = front;
  };
  bool same = true;
  for (bool fit = false; !fit && count > 0;) {
    same = set_ends(block, bodies.first(count), motions.first(count));
    const bool valid = make_boxes(block, motions.first(count), same);
    fit = valid && BoxIndex::all_fit(block.boxes);
    if (!valid) {
      leave_unless([&](std::size_t i) { return is_valid(motions[i]); });
    } else if (!fit) {
      leave_unless([&](std::size_t i) { return BoxIndex::fits(block.boxes.get(i)); });
    }
  }
  bodies = bodies.first(count);
  const bool alike = same && count > 0 && block.ends[0] != kNeverStep;
  if (alike) {
    parts_.windows.set_alike(bodies, block.from, block.ends[0]);
  } else {
    parts_.windows.set(bodies, block.from, std::span(block.ends).first(count));
  }
  for (std::size_t i = 0; parts_.pairs.notes_spheres() && i < count; ++i) {
    parts_.pairs.note_sphere(bodies[i], motions[i], block.quantized_grid, block.durations[i]);
  }
  for (std::size_t i = 0; i < count;) {
    const std::size_t more = alike ? count : 1;
    chunk.note_run(block.ends[i], more);
    i += more;
  }
  if (count > 0 && chunk.placed.size() >= kSampledEvery * chunk.sampled.size()) chunk.sampled.push_back(motions[0]);
  chunk.placed.insert(chunk.placed.end(), bodies.begin(), bodies.end());
  parts_.boxes.note_fitting(bodies, block.boxes, chunk.extent);
  parts_.boxes.scatter(bodies, block.boxes, chunk.visits);
}

void WindowUpdates::place_chunk(Chunk& chunk, Block& block, std::span<const BodyIndex> bodies) const {
  chunk.clear();
  std::array<BodyIndex, kBlock> ids;
  std::array<Motion, kBlock> answers;
  for (std::size_t done = 0; done < bodies.size(); done += kBlock) {
    const auto some = bodies.subspan(done, std::min(kBlock, bodies.size() - done));
    auto known = std::span(ids).first(some.size());
    const auto motions = std::span(answers).first(some.size());
    std::copy(some.begin(), some.end(), known.begin());
    parts_.pool.ask(block.now, known, motions, chunk.answers);
    chunk.asked += some.size();
    if (block.from > block.now) {
      const std::size_t front = known_at(block.from, known, motions);
      chunk.unknown.insert(chunk.unknown.end(), known.begin() + static_cast<std::ptrdiff_t>(front), known.end());
      known = known.first(front);
    }
    place_shared(chunk, block, known, motions.first(known.size()));
  }
}

// What one job has to do for all.
void WindowUpdates::fold(Chunk& chunk) {
  std::span<const BodyIndex> placed = chunk.placed;
  parts_.overlaps.mark_updated(placed);
  for (const Chunk::Run& run : chunk.runs) {
    if (run.end != kNeverStep) parts_.wheel.set_due(placed.first(run.bodies), run.end);
    parts_.windows.vote(run.end, run.bodies);
    placed = placed.subspan(run.bodies);
  }
  for (const BodyIndex body : chunk.unknown) parts_.changes.note(body);
  parts_.planner.note_sample(chunk.sampled);
  parts_.boxes.include(chunk.extent);
  parts_.boxes.count({.bodies = chunk.placed.size()});
  parts_.pool.count_asked(chunk.asked);
  shared_->rest.insert(shared_->rest.end(), chunk.rest.begin(), chunk.rest.end());
}

void WindowUpdates::find_in_part(Step now, std::size_t index) {
  GridPart& part = shared_->parts[index];
  part.near.clear();
  part.counts = {};
  if (!parts_.boxes.in_order()) parts_.boxes.empty_part(index);  // in the cache where it is used at once
  for (const Chunk& chunk : shared_->chunks)
    parts_.boxes.insert_part(chunk.visits[index].visits(), part.near, part.counts);
  const BodyPool& pool = parts_.pool;
  if (pool.asks_user_filter()) return;
  if (pool.filters_pairs()) {
    part.counts.pairs -= std::erase_if(part.near, [&](const BodyPair& pair) { return !pool.may_pair(pair); });
  }
  parts_.pairs.test_near(now, part.near, part.outcome);
}

void WindowUpdates::update_wave(Step now, Step from, std::span<const BodyIndex> bodies) {
  const std::size_t share = (bodies.size() + kChunks - 1) / kChunks;
  const std::size_t size = (share + kBlock - 1) / kBlock * kBlock;
  Block update;
  update.now = now;
  update.from = from;
  update.quantized_grid = parts_.boxes.quantized_grid_at(now);
  run_all(kChunks, [&](std::size_t i) {
    const std::size_t begin = std::min(bodies.size(), i * size), end = std::min(bodies.size(), begin + size);
    Block block = update;
    place_chunk(shared_->chunks[i], block, bodies.subspan(begin, end - begin));
  });
  run_all(1 + SweptGrid::kParts, [&](std::size_t i) {  // what a part's job uses is none of what folding changes
    if (i > 0) return find_in_part(now, i - 1);
    for (Chunk& chunk : shared_->chunks) fold(chunk);
  });
  parts_.boxes.all_parts_emptied();
  for (GridPart& part : shared_->parts) {
    parts_.boxes.count(part.counts);
    if (parts_.pool.asks_user_filter()) {  // it is asked by one thread
      near_.insert(near_.end(), part.near.begin(), part.near.end());
      test_near(now);
    } else {
      parts_.pairs.take(part.outcome);
    }
  }
}

// Whether jobs are worth it: what they have to do is told by the bodies, and by the pairs that are near, of which so
// many make up for a body. A thread that is alone takes a little longer with jobs unless there are many of either.
bool WindowUpdates::are_many(std::size_t bodies) const noexcept {
  constexpr std::size_t kFewer = 4;
  constexpr double kPairsOfBody = 48;
  const std::size_t least = options_.min_bodies_for_jobs;
  const double pairs = parts_.planner.plan().pairs_per_body;
  const double work = static_cast<double>(bodies) * (1 + pairs / kPairsOfBody);
  return bodies > 0 && bodies >= least / kFewer && work >= static_cast<double>(least);
}

void WindowUpdates::update_all(Step now, Step from, std::span<const BodyIndex> bodies) {
  const bool many = are_many(bodies.size()) && parts_.boxes.shares() && parts_.pool.motion_bound_check() == nullptr;
  if (!many) {
    parts_.boxes.empty(options_.executor);
    return update(now, from, bodies);
  }
  if (!shared_) shared_ = std::make_unique<Shared>();
  near_.clear();
  shared_->rest.clear();
  const std::size_t waves = (bodies.size() + kMaxWave - 1) / kMaxWave;
  const std::size_t size = (bodies.size() + waves - 1) / waves;
  for (std::size_t done = 0; done < bodies.size(); done += size) {
    update_wave(now, from, bodies.subspan(done, std::min(size, bodies.size() - done)));
  }
  if (!shared_->rest.empty()) update(now, from, shared_->rest);
}

}  // namespace orchard::runtime::detail
