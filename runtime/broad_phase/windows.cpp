#include "broad_phase/windows.h"

namespace orchard::runtime::detail {
namespace {

constexpr double kLongerWindow = 0.4;  // a window may be longer than planned by this share, to save an update

}  // namespace

// The time until a bound expires is divided into windows of equal length.
Step Windows::end_of(Step from, BodyIndex body, const Motion& motion) const noexcept {
  if (!all_end_ && (pool_.statics.has(body) || rests(motion))) return kNeverStep;
  const Step last = pool_.clock.last_before_expiry(motion.expiry);
  Step window = planned_;
  if (last < from + 64 * planned_) {
    const double steps = static_cast<double>(std::max<Step>(0, last - from) + 1);
    const double longer = fixed_ > 0 ? 0 : kLongerWindow;
    const double parts = std::max(1.0, std::ceil(steps / static_cast<double>(planned_) - longer));
    window = std::min(kLongestWindow - 1, static_cast<Step>(std::ceil(steps / parts)));
  }
  return from + window;
}

}  // namespace orchard::runtime::detail
