#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Four numbers in a vector (a GCC and Clang extension). The alignment is that of code for SSE (see wide.h).
struct FourNumbers {
  static constexpr std::size_t kLanes = 4;
  using Lanes = double __attribute__((vector_size(32), aligned(16)));
  Lanes numbers;
};

// The points that are farthest from a place, among many. All functions are in this header, so that they are inlined
// into code that is compiled for AVX2.
class [[gnu::visibility("hidden")]] FarPoints {
 public:
  static constexpr std::size_t kMax = 40;  // the number of points that are kept

  // `squared` has the squared distances of the points. Keeps those of at least squared_min, which is above 0, and at
  // most squared_max, but only the kMax farthest of them.
  void take(const std::vector<FourNumbers>& squared, std::size_t points, double squared_min, double squared_max) {
    gather(squared, points, squared_min);
    if (count_ > kMax && !keep_by_counting(squared_min, squared_max)) keep_by_order();
  }
  std::size_t count() const { return count_; }
  double squared(std::size_t i) const { return squared_[i]; }
  Index point(std::size_t i) const { return points_[i]; }

 private:
  static constexpr std::size_t kLanes = FourNumbers::kLanes;
  static constexpr int kCountings = 14;

  void gather(const std::vector<FourNumbers>& squared, std::size_t points, double squared_min) {
    const std::size_t room = kLanes * (squared.size() + 1);
    if (squared_.size() < room) squared_.resize(room);
    if (points_.size() < room) points_.resize(room);
    count_ = 0;
    for (std::size_t b = 0; b < squared.size(); ++b) {
      const FourNumbers::Lanes& four = squared[b].numbers;
      if (std::max(std::max(four[0], four[1]), std::max(four[2], four[3])) < squared_min) continue;
      const std::size_t end = std::min(kLanes, points - kLanes * b);
      for (std::size_t k = 0; k < end; ++k) {  // without a branch: entries that are not far enough are overwritten
        squared_[count_] = four[k];
        points_[count_] = static_cast<Index>(kLanes * b + k);
        count_ += static_cast<std::size_t>((four[k] >= squared_min) & (four[k] > 0));
      }
    }
  }

  // Finds a distance beyond which kMax points lie, by counting, which is faster than sorting. Returns false if there is
  // no such distance, or if it was not found.
  bool keep_by_counting(double low, double high) {
    for (std::size_t i = count_; i % kLanes != 0; ++i) squared_[i] = 0;
    double beyond_low = static_cast<double>(count_), beyond_high = 0;
    for (int k = 0; k < kCountings; ++k) {
      const double part = k % 3 == 2 ? 0.5 : (beyond_low - static_cast<double>(kMax)) / (beyond_low - beyond_high);
      const double limit = low + part * (high - low);
      const std::size_t beyond = count_beyond(limit);
      if (beyond == kMax) {
        keep_beyond(limit);
        return true;
      }
      (beyond > kMax ? low : high) = limit;
      (beyond > kMax ? beyond_low : beyond_high) = static_cast<double>(beyond);
    }
    return false;
  }

  std::size_t count_beyond(double limit) const {
    using Counts = std::int64_t __attribute__((vector_size(32), aligned(16)));
    Counts counts{};
    for (std::size_t i = 0; i < count_; i += kLanes) {
      FourNumbers::Lanes four;
      std::memcpy(&four, &squared_[i], sizeof four);
      counts -= four > limit;
    }
    return static_cast<std::size_t>(counts[0] + counts[1] + counts[2] + counts[3]);
  }

  void keep_beyond(double limit) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double far = squared_[i];
      squared_[kept] = far;
      points_[kept] = points_[i];
      kept += static_cast<std::size_t>(far > limit);
    }
    count_ = kept;
  }

  // Of points that are equally far, those with the highest numbers are kept.
  void keep_by_order() {
    struct Far {
      double squared;
      Index point;
    };
    std::vector<Far> far(count_);
    for (std::size_t i = 0; i < count_; ++i) far[i] = {squared_[i], points_[i]};
    const auto farther = [](const Far& a, const Far& b) {
      return a.squared > b.squared || (a.squared == b.squared && a.point > b.point);
    };
    std::nth_element(far.begin(), far.begin() + kMax, far.end(), farther);
    count_ = kMax;
    for (std::size_t i = 0; i < count_; ++i) {
      squared_[i] = far[i].squared;
      points_[i] = far[i].point;
    }
  }

  // In the order of the points, with room for one more group.
  std::vector<double> squared_;
  std::vector<Index> points_;
  std::size_t count_ = 0;
};

}  // namespace orchard::detail
