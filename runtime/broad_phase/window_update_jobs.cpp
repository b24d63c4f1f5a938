#include <new>

#include "broad_phase/window_updates.h"
#include "execution/guarded.h"

// Updates the windows of many bodies by jobs.
namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kChunks = 8;       // in a wave
constexpr std::size_t kMaxWave = 32768;  // bodies; all waves but the last have one size, and none is a small rest

}  // namespace

struct WindowUpdates::GridPart {
  std::vector<BodyPair> near;
  GridCounts counts;
  NearPairs::Outcome outcome;
};

struct WindowUpdates::Shared {
  std::array<Chunk, kChunks> chunks;
  std::array<GridPart, SweptGrid::kParts> parts;
};

WindowUpdates::WindowUpdates(KineticState& state, NearPairs& pairs)
    : state_(state), pairs_(pairs), chunk_(std::make_unique<Chunk>()) {}
WindowUpdates::~WindowUpdates() = default;

std::size_t WindowUpdates::memory_bytes() const noexcept {
  std::size_t bytes = bytes_of(motions_, near_) + sizeof(Chunk) + chunk_->memory_bytes();
  if (!shared_) return bytes;
  bytes += sizeof(Shared);
  for (const Chunk& chunk : shared_->chunks) bytes += chunk.memory_bytes();
  for (const GridPart& part : shared_->parts) bytes += bytes_of(part.near) + part.outcome.memory_bytes();
  return bytes;
}

// Runs jobs. Nothing may be thrown through an executor, so a lack of memory is thrown when all jobs have ended.
template <typename Job>
void WindowUpdates::run_all(std::size_t count, const Job& job) {
  if (state_.options.executor.run == nullptr) {
    for (std::size_t i = 0; i < count; ++i) job(i);
    return;
  }
  std::array<bool, std::max(kChunks, 1 + SweptGrid::kParts)> done{};
  auto guarded_job = [&](std::size_t i) { done[i] = guarded([&] { return job(i), true; }, [] { return false; }); };
  run_jobs(state_.options.executor, count, guarded_job);
  if (std::all_of(done.begin(), done.begin() + static_cast<std::ptrdiff_t>(count), [](bool d) { return d; })) return;
#if defined(__cpp_exceptions) || defined(_CPPUNWIND)
  throw std::bad_alloc();
#endif
}

void WindowUpdates::find_in_part(Step now, std::size_t index) {
  GridPart& part = shared_->parts[index];
  part.near.clear();
  part.counts = {};
  for (const Chunk& chunk : shared_->chunks) {
    state_.boxes.lines().insert(chunk.visits[index].visits(), state_.boxes.packed(), part.near, part.counts);
  }
  const BodyPool& pool = state_.pool;
  if (pool.filters.has_function()) return;
  if (pool.filters_pairs()) {
    part.counts.pairs -= std::erase_if(part.near, [&](const BodyPair& pair) { return !pool.may_pair(pair); });
  }
  pairs_.test_near(now, part.near, part.outcome);
}

void WindowUpdates::update_wave(Step now, Step from, std::span<const BodyIndex> bodies) {
  const std::size_t share = (bodies.size() + kChunks - 1) / kChunks;
  const std::size_t size = (share + kBlock - 1) / kBlock * kBlock;
  Block update = block_at(now, from);
  update.by_part = true;
  run_all(kChunks, [&](std::size_t i) {
    const std::size_t begin = std::min(bodies.size(), i * size), end = std::min(bodies.size(), begin + size);
    Block block = update;
    place_chunk(shared_->chunks[i], block, bodies.subspan(begin, end - begin));
  });
  run_all(1 + SweptGrid::kParts, [&](std::size_t i) {  // find_in_part() uses nothing that fold() changes
    if (i > 0) return find_in_part(now, i - 1);
    for (Chunk& chunk : shared_->chunks) fold(chunk);
  });
  for (GridPart& part : shared_->parts) {
    state_.counts += part.counts;
    if (state_.pool.filters.has_function()) {  // only one thread may call it
      near_.insert(near_.end(), part.near.begin(), part.near.end());
    } else {
      pairs_.take(part.outcome);
    }
  }
  for (Chunk& chunk : shared_->chunks) place_left(chunk, update);
  test_near(now);
}

void WindowUpdates::update_all(Step now, Step from, std::span<const BodyIndex> bodies) {
  const bool many = !bodies.empty() && bodies.size() >= state_.options.min_bodies_for_jobs;
  if (!many || state_.pool.motions.check() != nullptr) return update(now, from, bodies);
  if (!shared_) shared_ = std::make_unique<Shared>();
  near_.clear();
  const std::size_t waves = (bodies.size() + kMaxWave - 1) / kMaxWave;
  const std::size_t size = (bodies.size() + waves - 1) / waves;
  for (std::size_t done = 0; done < bodies.size(); done += size) {
    update_wave(now, from, bodies.subspan(done, std::min(size, bodies.size() - done)));
  }
}

}  // namespace orchard::runtime::detail
