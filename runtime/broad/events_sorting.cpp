#include "events.h"

// Where no window is longer than a step, boxes and events are of no use: the spheres are sorted anew at each step.
namespace orchard::runtime::detail {
namespace {

constexpr Step kNotSorted = 256;  // steps for which nothing is sorted once that has not suited

}  // namespace

// Everything is due: all windows were of one step.
void Events::collect_all(Step now) {
  for (BodyIndex body = 0; body < pool_.slots(); ++body) {
    Window& window = windows_[body];
    if (pending_[body]) {
      pending_[body] = 0;
      note_cancelled(window, now);
    } else if (window.end == now) {
      window.rely_longer();
    } else {
      continue;
    }
    due_.push_back(body);
  }
  changed_.clear();
}

// Static bodies have windows without end, which are worth keeping if there are many.
bool Events::worth_sorting(Step now) const noexcept {
  return plan_.window == 1 && pool_.slots() > BoxList::kMaxBodies && now >= sorts_from_ &&
         2 * pool_.statics() <= pool_.size();
}

void Events::begin_sorting() {
  wheel_.clear();
  overlaps_ahead_.clear();
  std::fill(places_.begin(), places_.end(), Place::nowhere);
  oversized_.clear();
  extent_ = kNothing;
  few_ = false;
  list_.release();
  grid_.release();
  grid_.take_counts();
  give_back(boxes_);
  give_back(spheres_);
  common_expiry_ = kNeverStep;
  sorting_ = true;
}

void Events::step_by_sorting(Step now) {
  if (!sorting_) begin_sorting();
  rebuilt_round_ = round_;
  all_are_due();
  motions_.resize(kBlock);
  lattice_.move_to(seconds_between(lattice_from_, now));
  sorted_.begin(due_.size(), lattice_.origin(), spacing_);
  for (std::size_t done = 0; done < due_.size();) {
    auto block = std::span(due_).subspan(done, std::min(kBlock, due_.size() - done));
    pool_.ask(now, block, std::span(motions_).first(block.size()));
    done += block.size();
    block = block.first(refuse_invalid(block));
    for (const BodyIndex body : block) {
      Window& window = windows_[body];
      window.end = now + 1;
      window.updated = round_;
      window.length = 1;
    }
    means_.add(std::span(motions_).first(block.size()));
    sorted_.add(block, std::span(motions_).first(block.size()));
  }
  sorted_.find(options_.vectors);
  if (pool_.filters_pairs()) sorted_.drop_pairs([&](const BodyPair& pair) { return !pool_.may_pair(pair); });
  overlaps_.assign(sorted_.pairs(), pool_.slots());
  if (!sorted_.suits()) sorts_from_ = now + kNotSorted;
}

}  // namespace orchard::runtime::detail
