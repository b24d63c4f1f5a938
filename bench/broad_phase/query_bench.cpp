// Queries of a broad phase against a loop over all bodies, in one run:
//   query_bench [most bodies]
// Spheres of broad_phase_bench at density 1, after 30 steps. Each query a thousand times at random places, the fastest
// of five runs (the loop as often as fits into a second), the answers of both compared.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>

#include "orchard/runtime/broad_queries.h"
#include "scene.h"

namespace {

using namespace orchard::bench;
using orchard::runtime::BodyHit;
using orchard::runtime::BodyQueries;
using orchard::runtime::BroadPhase;
using orchard::runtime::NearBody;
using orchard::runtime::Ray;

constexpr int kQueries = 1000, kRuns = 5;

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// The loop that an application without a broad phase would write, over positions and radii that lie side by side.
class Loop {
 public:
  explicit Loop(const Scene& scene) : positions_(scene.positions()), radii_(scene.radii()) {}

  std::uint64_t first_hit(const Vec3& origin, const Vec3& way) const {
    double best = std::numeric_limits<double>::infinity();
    std::uint64_t body = ~0u;
    for (std::size_t i = 0; i < radii_.size(); ++i) {
      const Vec3 to = positions_[i] - origin;
      const double middle = dot(to, way), room = radii_[i] * radii_[i] - (dot(to, to) - middle * middle);
      if (room < 0) continue;
      const double half = std::sqrt(room), at = std::max(0.0, middle - half);
      if (middle + half >= 0 && at < best) best = at, body = i;
    }
    return body;
  }
  std::uint64_t touching_sphere(const Vec3& center, double radius) const {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < radii_.size(); ++i) {
      const Vec3 off = positions_[i] - center;
      count += dot(off, off) <= (radii_[i] + radius) * (radii_[i] + radius);
    }
    return count;
  }
  std::uint64_t touching_box(const Vec3& lower, const Vec3& upper) const {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < radii_.size(); ++i) {
      Vec3 off;
      for (std::size_t d = 0; d < 3; ++d) {
        off[d] = positions_[i][d] - std::clamp(positions_[i][d], lower[d], upper[d]);
      }
      count += dot(off, off) <= radii_[i] * radii_[i];
    }
    return count;
  }
  std::uint64_t nearest(const Vec3& point, std::size_t k) {
    near_.clear();
    const auto closer = [](const NearBody& a, const NearBody& b) { return a.distance < b.distance; };
    for (std::size_t i = 0; i < radii_.size(); ++i) {
      const Vec3 off = positions_[i] - point;
      const NearBody one{static_cast<BodyIndex>(i), std::max(0.0, std::sqrt(dot(off, off)) - radii_[i])};
      if (near_.size() == k && !closer(one, near_.front())) continue;
      near_.push_back(one);
      std::push_heap(near_.begin(), near_.end(), closer);
      if (near_.size() <= k) continue;
      std::pop_heap(near_.begin(), near_.end(), closer);
      near_.pop_back();
    }
    return near_.front().body;
  }

 private:
  const std::vector<Vec3>& positions_;
  const std::vector<double>& radii_;
  std::vector<NearBody> near_;
};

bool right = true;

using Query = std::function<std::uint64_t(int)>;

// Microseconds a query.
void row(const char* name, const Scene& scene, const BroadPhase& world, const Query& ours, const Query& loop) {
  constexpr double kLong = 1e9;
  std::vector<std::uint64_t> answers(kQueries);
  double own = kLong, rival = kLong, motions = 0;
  for (int run = 0; run < kRuns; ++run) {
    double begin = seconds();
    const std::uint64_t asked = world.motions_asked();
    for (int i = 0; i < kQueries; ++i) answers[static_cast<std::size_t>(i)] = ours(i);
    own = std::min(own, (seconds() - begin) / kQueries);
    motions = static_cast<double>(world.motions_asked() - asked) / kQueries;
    begin = seconds();
    int done = 0;
    for (; done < kQueries && (done < 10 || seconds() - begin < 1.0 / kRuns); ++done) {
      if (loop(done) == answers[static_cast<std::size_t>(done)]) continue;
      std::printf("%s: another answer than the loop's, query %d\n", name, done);
      right = false;
    }
    rival = std::min(rival, (seconds() - begin) / done);
  }
  std::printf("| %zu | %s | %.2f | %.2f: %.1f times | %.1f |\n", scene.size(), name, 1e6 * own, 1e6 * rival,
              rival / own, motions);
  std::fflush(stdout);
}

void measure(std::size_t bodies) {
  Scene scene({.bodies = bodies}, 7);
  BroadPhase world(scene.source(), {});
  for (std::size_t i = 0; i < bodies; ++i) world.add();
  world.advance(scene.time());
  for (int step = 1; step <= 30; ++step) {
    scene.next_step();
    world.advance(scene.time());
  }
  BodyQueries queries(world);
  Loop loop(scene);
  const double ball = 200 * std::cbrt(static_cast<double>(bodies) / 100);
  orchard::runtime::test::Draw draw(3);
  std::vector<Vec3> points, ways;
  for (int i = 0; i < kQueries; ++i) points.push_back(draw.in_ball(ball)), ways.push_back(draw.direction());
  const auto at = [](const auto& v, int i) { return v[static_cast<std::size_t>(i)]; };
  row(
      "first hit of a ray", scene, world,
      [&](int i) {
        const auto hit = queries.first_hit(Ray{at(points, i), at(ways, i)});
        return hit ? std::uint64_t{hit->body} : ~0u;
      },
      [&](int i) { return loop.first_hit(at(points, i), at(ways, i)); });
  row(
      "sphere, radius 10", scene, world, [&](int i) { return queries.touching_sphere(at(points, i), 10).size(); },
      [&](int i) { return loop.touching_sphere(at(points, i), 10); });
  const Vec3 edge = {100, 100, 100};
  row(
      "box, edges 100", scene, world,
      [&](int i) { return queries.touching_box(at(points, i), at(points, i) + edge).size(); },
      [&](int i) { return loop.touching_box(at(points, i), at(points, i) + edge); });
  row(
      "8 nearest: the last one", scene, world,
      [&](int i) { return std::uint64_t{queries.nearest(at(points, i), 8).back().body}; },
      [&](int i) { return loop.nearest(at(points, i), 8); });
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t most = argc > 1 ? static_cast<std::size_t>(std::atoll(argv[1])) : 1'000'000;
  std::printf("| bodies | query | orchard, microseconds | loop over all | motions asked |\n|---|---|---|---|---|\n");
  for (const std::size_t bodies : {std::size_t{100}, std::size_t{10'000}, std::size_t{1'000'000}}) {
    if (bodies <= most) measure(bodies);
  }
  return right ? 0 : 1;
}
