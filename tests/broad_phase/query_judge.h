#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "orchard/runtime/broad_queries.h"
#include "worlds.h"

// The answers of queries compared with asking every body, in more digits.
namespace orchard::runtime::test {

using Wide = long double;
struct WideVec {
  Wide x, y, z;
};
inline WideVec wide(const Vec3& v) { return {v[0], v[1], v[2]}; }
inline WideVec minus(const WideVec& a, const WideVec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Wide dot(const WideVec& a, const WideVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// What every body says: yes, no, or too close to tell in double.
enum class Says { no, unclear, yes };
inline Says says(Wide inside, Wide scale) {  // inside >= 0: it touches
  const Wide unclear = 1e-11L * scale;
  return inside > unclear ? Says::yes : inside < -unclear ? Says::no : Says::unclear;
}

inline Says ray_hits(const Motion& m, const Vec3& origin, const Vec3& direction, double longest, Wide& along) {
  const WideVec to = minus(wide(m.position), wide(origin)), d = wide(direction);
  const Wide r = m.radius, size = std::sqrt(dot(d, d)), far = std::sqrt(dot(to, to));
  along = 0;
  const Says inside = says(r - far, r + far);
  if (inside != Says::no || size == 0) return inside;
  const Wide middle = dot(to, d) / size;
  const WideVec off = {to.x - middle * d.x / size, to.y - middle * d.y / size, to.z - middle * d.z / size};
  const Wide apart = std::sqrt(dot(off, off)), scale = r + far;
  const Says meets = says(r - apart, scale);
  if (meets == Says::no) return Says::no;
  const Wide enter = middle - std::sqrt(std::max(0.0L, r * r - apart * apart));
  along = enter / size;
  if (meets == Says::unclear) return says(middle, scale) == Says::no ? Says::no : Says::unclear;
  const Says ahead = says(enter, scale), before_end = says(longest * size - enter, scale);
  return std::min(ahead, before_end);
}

inline Wide distance_to(const Motion& m, const Vec3& point) {
  const WideVec off = minus(wide(m.position), wide(point));
  return std::max(0.0L, std::sqrt(dot(off, off)) - Wide{m.radius});
}

inline Wide distance_to_box(const Motion& m, const Vec3& lower, const Vec3& upper) {
  Wide sum = 0;
  for (std::size_t d = 0; d < 3; ++d) {
    const Wide off = std::max({Wide{lower[d]} - m.position[d], Wide{m.position[d]} - upper[d], 0.0L});
    sum += off * off;
  }
  return std::sqrt(sum);
}

// Asks everything and compares. `where(body)` is its motion at the queries' time; null: it is not there.
class Judge {
 public:
  using Where = std::function<const Motion*(BodyIndex)>;
  Judge(BodyQueries& queries, std::size_t bodies, Where where, std::function<BodyFilter(BodyIndex)> filters = {})
      : queries_(queries), bodies_(bodies), where_(std::move(where)), filters_(std::move(filters)) {}

  void set_filter(const QueryFilter& filter) { filter_ = filter; }

  void ray(const Ray& ray) const {
    const auto first = queries_.first_hit(ray, filter_);
    ASSERT_FALSE(queries_.refused());
    hits(first, queries_.all_hits(ray, filter_), ray.origin, ray.direction, ray.longest);
  }
  void segment(const Vec3& p, const Vec3& q) const {
    const auto first = queries_.first_on_segment(p, q, filter_);
    hits(first, queries_.all_on_segment(p, q, filter_), p, q - p, 1);
  }
  void sphere(const Vec3& center, double radius) const {
    found(queries_.touching_sphere(center, radius, filter_), [&](const Motion& m) {
      const WideVec off = minus(wide(m.position), wide(center));
      const Wide reach = Wide{m.radius} + radius, far = std::sqrt(dot(off, off));
      return says(reach - far, reach + far);
    });
  }
  void box(const Vec3& lower, const Vec3& upper) const {
    found(queries_.touching_box(lower, upper, filter_), [&](const Motion& m) {
      const Wide far = distance_to_box(m, lower, upper);
      return says(m.radius - far, m.radius + far);
    });
  }
  void nearest(const Vec3& point, std::size_t k) const {
    const auto near = queries_.nearest(point, k, filter_);
    std::vector<Wide> expected;
    for (BodyIndex i = 0; i < bodies_; ++i) {
      if (const Motion* m = there(i)) expected.push_back(distance_to(*m, point));
    }
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(near.size(), std::min(k, expected.size()));
    std::set<BodyIndex> bodies;
    for (std::size_t i = 0; i < near.size(); ++i) {
      const Motion* m = there(near[i].body);
      ASSERT_NE(m, nullptr);
      ASSERT_TRUE(bodies.insert(near[i].body).second);
      const double scale = 1e-11 * (std::sqrt(runtime::dot(point, point)) + near[i].distance + 1);
      ASSERT_NEAR(near[i].distance, static_cast<double>(distance_to(*m, point)), scale);
      ASSERT_NEAR(near[i].distance, static_cast<double>(expected[i]), scale);
      if (i == 0) continue;
      ASSERT_TRUE(near[i - 1].distance < near[i].distance ||
                  (near[i - 1].distance == near[i].distance && near[i - 1].body < near[i].body));
    }
  }

 private:
  const Motion* there(BodyIndex i) const {
    const Motion* m = where_(i);
    if (m == nullptr || !is_valid(*m)) return nullptr;
    const BodyFilter own = filters_ ? filters_(i) : BodyFilter{};
    return (own.category & filter_.mask) != 0 && (own.mask & filter_.category) != 0 ? m : nullptr;
  }
  void hits(const std::optional<BodyHit>& first, std::span<const BodyHit> all, const Vec3& origin,
            const Vec3& direction, double longest) const {
    std::vector<double> along(bodies_, -1);
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_LT(all[i].body, bodies_);
      ASSERT_EQ(along[all[i].body], -1) << "twice";
      along[all[i].body] = all[i].along;
      if (i == 0) continue;
      ASSERT_TRUE(all[i - 1].along < all[i].along ||
                  (all[i - 1].along == all[i].along && all[i - 1].body < all[i].body));
    }
    const Wide size = std::sqrt(dot(wide(direction), wide(direction))), unit = size > 0 ? size : 1;
    for (BodyIndex i = 0; i < bodies_; ++i) {
      Wide enter = 0;
      const Motion* m = there(i);
      const Says truth = m == nullptr ? Says::no : ray_hits(*m, origin, direction, longest, enter);
      if (truth == Says::yes) {
        ASSERT_GE(along[i], 0) << "body " << i;
        const Vec3 off = m->position - origin;
        const double scale = std::sqrt(runtime::dot(off, off)) + m->radius;
        ASSERT_NEAR(static_cast<double>(along[i] * unit), static_cast<double>(enter * unit), 1e-5 * scale) << i;
      }
      if (truth == Says::no) {
        ASSERT_EQ(along[i], -1) << "body " << i;
      }
    }
    ASSERT_EQ(first.has_value(), !all.empty());
    if (!first) return;
    ASSERT_EQ(first->body, all[0].body);
    ASSERT_EQ(first->along, all[0].along);
  }
  template <typename Truth>
  void found(std::span<const BodyIndex> bodies, const Truth& truth) const {
    ASSERT_FALSE(queries_.refused());
    ASSERT_TRUE(std::is_sorted(bodies.begin(), bodies.end()));
    ASSERT_EQ(std::adjacent_find(bodies.begin(), bodies.end()), bodies.end());
    for (BodyIndex i = 0; i < bodies_; ++i) {
      const Motion* m = there(i);
      const Says said = m == nullptr ? Says::no : truth(*m);
      if (said == Says::unclear) continue;
      ASSERT_EQ(std::binary_search(bodies.begin(), bodies.end(), i), said == Says::yes) << "body " << i;
    }
  }

  BodyQueries& queries_;
  std::size_t bodies_;
  Where where_;
  std::function<BodyFilter(BodyIndex)> filters_;
  QueryFilter filter_;
};

// One of each kind, of all sizes, in and around a ball.
inline void ask_everything(const Judge& judge, Draw& draw, double ball) {
  const auto chance = [&](double share) { return draw.uniform(0, 1) < share; };
  const auto somewhere = [&] { return draw.in_ball(ball * (chance(0.1) ? 50 : 1.5)); };
  Ray ray{somewhere(), draw.direction(), std::numeric_limits<double>::infinity()};
  if (chance(0.3)) ray.longest = draw.uniform(0, 2 * ball);
  if (chance(0.3)) ray.direction[draw.bits() % 3] = 0;
  if (chance(0.2)) ray.direction = draw.in_ball(ball) - Vec3(ray.origin);
  if (chance(0.1)) {
    for (double& x : ray.direction) x = std::ldexp(x, chance(0.5) ? 300 : -900);
    if (ray.longest != std::numeric_limits<double>::infinity()) ray.longest = 1e-3;
  }
  if (std::ranges::all_of(ray.direction, [](double x) { return x == 0; })) ray.direction = {1, 0, 0};
  judge.ray(ray);
  const Vec3 p = somewhere();
  judge.segment(p, chance(0.1) ? p : chance(0.5) ? somewhere() : p + draw.in_ball(1));
  judge.sphere(somewhere(), chance(0.2) ? 0 : draw.uniform(0, chance(0.2) ? 2 * ball : 2));
  Vec3 lower = somewhere(), upper = lower + Vec3{draw.uniform(0, 3), chance(0.2) ? 0 : draw.uniform(0, 3), 1};
  if (chance(0.2)) lower = {-ball, -ball, lower[2]}, upper = {ball, ball, std::max(lower[2], upper[2])};
  judge.box(lower, upper);
  judge.nearest(somewhere(), 1 + draw.bits() % (chance(0.2) ? 100 : 5));
}

}  // namespace orchard::runtime::test
