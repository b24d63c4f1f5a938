#include "math/exact_sign.h"

#include <cfloat>
#include <cmath>

static_assert(FLT_EVAL_METHOD == 0, "the error-free transformations below need plain double arithmetic");

namespace orchard::runtime::detail {
namespace {

// With pairs of doubles, the relative error of a step is at most 2^-102, and there are fewer than 30 steps.
constexpr double kPairError = 0x1p-96;

int sign(double value) noexcept { return (value > 0) - (value < 0); }

struct Pair {  // an unevaluated sum, |low| <= ulp(high) / 2
  double high, low;
};

Pair two_sum(double a, double b) noexcept {
  const double sum = a + b, other = sum - a;
  return {sum, (a - (sum - other)) + (b - other)};
}

Pair two_product(double a, double b) noexcept {
  const double product = a * b;
#ifdef __MINGW32__  // its std::fma() rounds twice, so each number is split in halves of its digits (Dekker 1971)
  const auto high_part = [](double x) {
    const double shifted = 134217729.0 * x;  // 2^27 + 1
    return shifted - (shifted - x);
  };
  const double ah = high_part(a), bh = high_part(b), al = a - ah, bl = b - bh;
  return {product, ((ah * bh - product) + ah * bl + al * bh) + al * bl};
#else
  return {product, std::fma(a, b, -product)};
#endif
}

Pair difference(double a, double b) noexcept { return two_sum(a, -b); }  // exact

Pair add(Pair a, Pair b) noexcept {
  const Pair sum = two_sum(a.high, b.high);
  return two_sum(sum.high, sum.low + (a.low + b.low));
}

Pair negate(Pair a) noexcept { return {-a.high, -a.low}; }

Pair multiply(Pair a, Pair b) noexcept {
  const Pair product = two_product(a.high, b.high);
  return two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

// An exact sum of doubles. It is kept as parts that do not overlap, in increasing size. Adding a number to such a list
// by a chain of two_sum gives such a list again (Shewchuk 1997, theorem 10), so the last part has the sign of the sum.
class ExactSum {
 public:
  void add(double value) noexcept {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const Pair sum = two_sum(value, parts_[i]);
      if (sum.low != 0) parts_[kept++] = sum.low;
      value = sum.high;
    }
    if (value != 0) parts_[kept++] = value;
    size_ = kept;
  }

  void add_product(Pair a, Pair b, double factor) noexcept {
    for (const double x : {a.low, a.high}) {
      for (const double y : {b.low, b.high}) {
        if (x == 0 || y == 0) continue;
        const Pair xy = two_product(x, y);
        for (const double part : {xy.low, xy.high}) {
          const Pair product = two_product(part, factor);
          add(product.low);
          add(product.high);
        }
      }
    }
  }

  void add_product(Pair a, Pair b, Pair c) noexcept {
    if (c.low != 0) add_product(a, b, c.low);
    add_product(a, b, c.high);
  }

  int sign() const noexcept { return size_ == 0 ? 0 : detail::sign(parts_[size_ - 1]); }
  double value() const noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < size_; ++i) sum += parts_[i];
    return sum;
  }

 private:
  std::array<double, 192> parts_;  // six triple products of pairs, four doubles for each of their eight terms
  std::size_t size_ = 0;
};

using PairVector = std::array<Pair, 3>;

PairVector difference(const Vec3& a, const Vec3& b) noexcept {
  return {difference(a[0], b[0]), difference(a[1], b[1]), difference(a[2], b[2])};
}

Pair close_determinant(const PairVector& u, const PairVector& v, const PairVector& w) noexcept {
  Pair sum = {0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    sum = add(sum, multiply(u[i], add(multiply(v[j], w[k]), negate(multiply(v[k], w[j])))));
  }
  return sum;
}

ExactSum exact_determinant(const PairVector& u, const PairVector& v, const PairVector& w) noexcept {
  ExactSum exact;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    exact.add_product(v[j], w[k], u[i]);
    exact.add_product(v[k], w[j], negate(u[i]));
  }
  return exact;
}

// The determinant in plain double, and the sum of the sizes of its terms.
struct PlainDeterminant {
  double value, permanent;
  PlainDeterminant(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept {
    const double ux = a[0] - d[0], uy = a[1] - d[1], uz = a[2] - d[2];
    const double vx = b[0] - d[0], vy = b[1] - d[1], vz = b[2] - d[2];
    const double wx = c[0] - d[0], wy = c[1] - d[1], wz = c[2] - d[2];
    const double yz = vy * wz, zy = vz * wy, zx = vz * wx, xz = vx * wz, xy = vx * wy, yx = vy * wx;
    value = ux * (yz - zy) + uy * (zx - xz) + uz * (xy - yx);
    permanent = std::fabs(ux) * (std::fabs(yz) + std::fabs(zy)) + std::fabs(uy) * (std::fabs(zx) + std::fabs(xz)) +
                std::fabs(uz) * (std::fabs(xy) + std::fabs(yx));
  }
};

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept {
  const PlainDeterminant plain(a, b, c, d);
  if (std::fabs(plain.value) > kPlainDeterminantError * plain.permanent) return sign(plain.value);
  const PairVector u = difference(a, d), v = difference(b, d), w = difference(c, d);
  const Pair close = close_determinant(u, v, w);
  if (std::fabs(close.high) > kPairError * plain.permanent) return sign(close.high);
  return exact_determinant(u, v, w).sign();
}

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept {
  constexpr double kPlain = 0x1p-9, kClose = 0x1p-56;  // of the permanent: values above these have small enough errors
  const PlainDeterminant plain(a, b, c, d);
  if (std::fabs(plain.value) > kPlain * plain.permanent) return plain.value;
  const PairVector u = difference(a, d), v = difference(b, d), w = difference(c, d);
  const Pair close = close_determinant(u, v, w);
  if (std::fabs(close.high) > kClose * plain.permanent) return close.high;
  return exact_determinant(u, v, w).value();
}

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, std::size_t axis) noexcept {
  const std::size_t x = (axis + 1) % 3, y = (axis + 2) % 3;
  const double left = (a[x] - c[x]) * (b[y] - c[y]), right = (a[y] - c[y]) * (b[x] - c[x]);
  const double determinant = left - right;
  if (std::fabs(determinant) > kPlainDeterminantError * (std::fabs(left) + std::fabs(right))) return sign(determinant);
  ExactSum exact;
  exact.add_product(difference(a[x], c[x]), difference(b[y], c[y]), 1.0);
  exact.add_product(difference(a[y], c[y]), difference(b[x], c[x]), -1.0);
  return exact.sign();
}

bool in_line(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  return orientation(a, b, c, 0) == 0 && orientation(a, b, c, 1) == 0 && orientation(a, b, c, 2) == 0;
}

}  // namespace orchard::runtime::detail
