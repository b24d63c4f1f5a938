// Normals and depths of contacts, ours and other libraries', against the least way out along any of 2,000 directions at
// the same shallow poses:  contact_accuracy_bench [-n poses] [-seed first]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>

#include "least_way_out.h"
#include "orchard/runtime/contacts.h"
#include "rival.h"

namespace {

using namespace orchard::bench;
using namespace orchard::runtime;
using orchard::runtime::test::MinimumTranslation;
using orchard::runtime::test::Vec;

constexpr int kPasses = 5;

struct Score {
  std::vector<double> angles, depth_ratios, times;
};

// The best of a few passes, in microseconds.
double time_of(const std::function<void()>& run) {
  using Clock = std::chrono::steady_clock;
  double best = 1e300;
  for (int pass = 0; pass < kPasses; ++pass) {
    const auto start = Clock::now();
    run();
    best = std::min(best, std::chrono::duration<double, std::micro>(Clock::now() - start).count());
  }
  return best;
}

// To the line, whichever way it points: conventions differ. 90 degrees where there is no normal.
double angle_to(const Vec& normal, const Vec& way) {
  const double along = std::fabs(orchard::runtime::test::inner(normal, way));
  return std::acos(std::min(1.0, along)) * 180 / std::numbers::pi;
}

// What each engine says of the poses so far, by its name.
class Table {
 public:
  // `unique`: whether normals count.
  void add(const std::string& name, const Vec& normal, double depth, double time, const MinimumTranslation& least,
           bool unique) {
    Score& score = scores_[name];
    if (unique) score.angles.push_back(angle_to(normal, least.direction));
    score.depth_ratios.push_back(depth / least.depth);
    score.times.push_back(time);
  }

  void print() const {
    std::printf("%-36s %9s %9s %9s %9s %9s %9s %9s\n", "", "normal", "", "within", "depth", "within", "", "time");
    std::printf("%-36s %9s %9s %9s %9s %9s %9s %9s\n", "", "mean", "max", "10 deg", "median", "5 %", "20 %", "us");
    for (const auto& entry : scores_) {
      const Score& score = entry.second;
      const auto share = [](const std::vector<double>& v, const auto& holds) {
        return v.empty() ? 0.0
                         : 100.0 * static_cast<double>(std::count_if(v.begin(), v.end(), holds)) /
                               static_cast<double>(v.size());
      };
      const auto off_by = [&](double most) {
        return share(score.depth_ratios, [most](double r) { return std::fabs(r - 1) <= most; });
      };
      std::vector<double> ratios = score.depth_ratios;
      std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2), ratios.end());
      std::printf("%-36s %9.2f %9.2f %7.1f %% %9.3f %7.1f %% %7.1f %% %9.2f\n", entry.first.c_str(), mean(score.angles),
                  score.angles.empty() ? 0 : *std::max_element(score.angles.begin(), score.angles.end()),
                  share(score.angles, [](double a) { return a <= 10; }), ratios[ratios.size() / 2], off_by(0.05),
                  off_by(0.2), mean(score.times));
    }
  }

 private:
  static double mean(const std::vector<double>& v) {
    double sum = 0;
    for (const double x : v) sum += x;
    return v.empty() ? 0 : sum / static_cast<double>(v.size());
  }
  std::map<std::string, Score> scores_;
};

// Of each two bodies, made when first asked for.
class Rivals {
 public:
  explicit Rivals(const std::vector<orchard::runtime::test::Body>& all) : all_(all) {}
  const std::vector<std::unique_ptr<PairRival>>& of(std::size_t i, std::size_t j) {
    auto& rivals = made_[{i, j}];
    if (!rivals.empty()) return rivals;
    for (const auto& make : {fcl_float, fcl_double, bullet}) {
      if (auto rival = make(all_[i].tree, all_[j].tree)) rivals.push_back(std::move(rival));
    }
    return rivals;
  }

 private:
  const std::vector<orchard::runtime::test::Body>& all_;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::unique_ptr<PairRival>>> made_;
};

void compare(int poses, std::uint64_t seed) {
  const auto all = orchard::runtime::test::bodies();
  std::vector<PreparedTree> trees;
  trees.reserve(all.size());
  for (const auto& body : all) trees.emplace_back(body.tree);
  Workspace workspace;
  Rivals rivals(all);
  Table table;
  int unique_poses = 0;
  for (int done = 0; done < poses; ++seed) {
    orchard::runtime::test::Draw draw(seed);
    const auto pose = shallow_pose(draw, all, trees, workspace);
    if (!pose) continue;
    const TreePair pair(trees[pose->i], trees[pose->j]);
    const Manifold ours = contacts(workspace, pair, pose->a, pose->b);
    if (ours.depth < 1e-7 * pose->reach) continue;  // too shallow for the judge
    orchard::runtime::test::LeastWayOut judge(pair, pose->a, pose->b);
    const std::vector<MinimumTranslation> ways = judge.find(draw, 1.5 * ours.depth);
    if (ways.empty()) continue;  // no direction of the judge's comes near
    ++done;
    const bool unique = is_unique(ways);
    unique_poses += unique;
    const auto add_ours = [&](const std::string& name, const ContactOptions& options) {
      const Manifold m = contacts(workspace, pair, pose->a, pose->b, options);
      const double time = time_of([&] { contacts(workspace, pair, pose->a, pose->b, options); });
      table.add(name, m.normal, m.depth, time, ways[0], unique);
    };
    add_ours("orchard", {});
    add_ours("orchard, first normal's depth", {.refinements = 0});
    for (const auto& rival : rivals.of(pose->i, pose->j)) {
      rival->place({{pose->a, pose->b, 0}});
      const ContactResponse theirs = rival->response(0);
      const double time = time_of([&] { rival->contacts(0); });
      table.add(rival->name() + ", deepest", theirs.deepest_normal, theirs.depth, time, ways[0], unique);
      table.add(rival->name() + ", mean", theirs.normal, theirs.depth, time, ways[0], unique);
    }
  }
  std::printf("%d poses, %d with a unique way out; degrees, shares of the poses, depths as part of the judge's\n",
              poses, unique_poses);
  table.print();
}

}  // namespace

int main(int argc, char** argv) {
  int poses = 500;
  std::uint64_t seed = 500'000;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    if (option == "-n") {
      poses = std::atoi(argv[i + 1]);
    } else if (option == "-seed") {
      seed = std::strtoull(argv[i + 1], nullptr, 10);
    } else {
      std::fprintf(stderr, "usage: contact_accuracy_bench [-n poses] [-seed first]\n");
      return 2;
    }
  }
  if (poses > 0) compare(poses, seed);
  return 0;
}
