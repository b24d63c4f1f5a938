#pragma once
#include <vector>

#include "twofold.h"

namespace orchard::detail {

// An exact sum of doubles that do not overlap, the smallest first, none of them zero (Priest 1991, Shewchuk 1997). For
// determinants that lower precision cannot tell from zero; slow, and rarely needed. Exact unless it over- or
// underflows.
class Expansion {
 public:
  Expansion() = default;
  explicit Expansion(const Twofold& exact) {
    append(exact.low);
    append(exact.high);
  }

  // The nearest double, or one next to it.
  double value() const {
    double sum = 0;
    for (const double term : terms_) sum += term;
    return sum;
  }
  int sign() const { return terms_.empty() ? 0 : terms_.back() > 0 ? 1 : -1; }

  friend Expansion operator+(const Expansion& a, const Expansion& b) {
    // All terms by size, then one pass that keeps the sum of what came before apart from what it rounds off.
    Expansion sum;
    sum.terms_.reserve(a.terms_.size() + b.terms_.size());
    std::size_t i = 0, j = 0;
    const auto next = [&] {
      if (j == b.terms_.size()) return a.terms_[i++];
      if (i == a.terms_.size()) return b.terms_[j++];
      return std::abs(a.terms_[i]) < std::abs(b.terms_[j]) ? a.terms_[i++] : b.terms_[j++];
    };
    double total = 0;
    while (i < a.terms_.size() || j < b.terms_.size()) {
      const Twofold step = exact_sum(total, next());
      sum.append(step.low);
      total = step.high;
    }
    sum.append(total);
    return sum;
  }
  friend Expansion operator-(Expansion a) {
    for (double& term : a.terms_) term = -term;
    return a;
  }
  friend Expansion operator-(const Expansion& a, const Expansion& b) { return a + -b; }
  friend Expansion operator*(const Expansion& a, const Expansion& b) {
    Expansion sum;
    for (const double term : b.terms_) sum = sum + a.scaled(term);
    return sum;
  }

 private:
  Expansion scaled(double factor) const {
    Expansion product;
    product.terms_.reserve(2 * terms_.size());
    double total = 0;
    for (const double term : terms_) {
      const Twofold exact = exact_product(term, factor);
      const Twofold low = exact_sum(total, exact.low);
      product.append(low.low);
      const Twofold high = exact_sum(exact.high, low.high);
      product.append(high.low);
      total = high.high;
    }
    product.append(total);
    return product;
  }
  void append(double term) {
    if (term != 0) terms_.push_back(term);
  }

  std::vector<double> terms_;
};

}  // namespace orchard::detail
