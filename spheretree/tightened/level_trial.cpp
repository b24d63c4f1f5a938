#include "level_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "infinity.h"
#include "wide.h"

// The numbers below were tuned on four models of 700 to 2000 triangles; none of them matters much.
namespace orchard::detail {
namespace {

constexpr float kBarred = std::numeric_limits<float>::infinity();  // what a ball may not own gets it no less loose
constexpr int kSharingRounds = 2, kSharingRoundsOfFew = 3;         // of sharing out
constexpr int kFirstEvaluations = 5, kLastEvaluations = 12;
constexpr double kWantedShare = 0.7;  // of trials that begin where the caller wants; the others at any loose ball
constexpr double kMoveShare = 0.35;   // of trials that move a cheap ball to a dear place
constexpr double kStayShare = 0.3,
                 kOneRestartShare = 0.45;  // of the others, in which none or one ball starts over, not two
constexpr double kAllRestartShare = 0.3,
                 kEachRestartShare = 0.4;   // of very few balls, all start over, or each does
constexpr Index kFewForMoves = 8;           // balls, up to which there is no such move
constexpr Index kFewAtStake = 128;          // balls, up to which more is put at stake at a time
constexpr double kWorthwhileSaving = 1e-6;  // part of the cost that must go
// By what part of its looseness a ball may still get tighter in the last round: an estimate.
constexpr double kHoped = 0.3;

// Neighbours are chosen at random: each distance is multiplied by a random number between these two, then the nearest
// are taken.
constexpr double kNearer = 0.8, kFarther = 1.25;

// The state of the generator after so many more draws. Compilers turn the loop into one step.
Random after(Index draws, Random random) {
  for (Index i = 0; i < draws; ++i) random.bits();
  return random;
}

// What a ball of the trial can choose from: the samples that no other ball of the level holds, each with the looseness
// that the best ball so far would need for it. Single precision is enough: between two balls that would become equally
// loose it does not matter which takes the sample.
struct Offered {
  std::size_t count;
  const float *x, *y, *z;
  const float* barred;  // 0, or infinity for samples that the ball may not own
  float *min, *owner;   // the least looseness, and the ball (whole numbers, as wide as the rest)
};

// Gives the ball those samples that it can hold with less looseness than the best of the balls before it. Looseness is
// that of looseness_with().
inline void divide(const FittedBall& ball, Index number, const Offered& to) {
  const auto cx = static_cast<float>(ball.center.x()), cy = static_cast<float>(ball.center.y()),
             cz = static_cast<float>(ball.center.z()), distance = static_cast<float>(ball.center_distance);
  const auto own = static_cast<float>(number);
  const float* __restrict x = to.x, * __restrict y = to.y, * __restrict z = to.z, * __restrict barred = to.barred;
  float* __restrict min = to.min, * __restrict owner = to.owner;
  for (std::size_t k = 0; k < to.count; ++k) {
    const float dx = x[k] - cx, dy = y[k] - cy, dz = z[k] - cz;
    const float loose = std::sqrt(dx * dx + (dy * dy + dz * dz)) + distance + barred[k];
    const float old = min[k], owned = owner[k];  // both are read in any case, so that the loop has no branch
    const bool less = loose < old;
    min[k] = less ? loose : old;
    owner[k] = less ? own : owned;
  }
}

ORCHARD_FOR_AVX2 void divide_wide(const FittedBall& ball, Index number, const Offered& to) { divide(ball, number, to); }

class Proposal {
 public:
  Proposal(const LevelBalls& balls, const LevelObjective& objective, std::span<const double> wanted, Random random,
           TrialScratch& scratch)
      : balls_(balls),
        regions_(balls.regions()),
        samples_(regions_.samples()),
        objective_(objective),
        wanted_(wanted),
        random_(random),
        scratch_(scratch),
        fitter_(scratch.fitter) {}

  LevelTrial run() {
    choose();
    freed_ = balls_.held_only_by(trial_.chosen);
    if (freed_.empty()) return std::move(trial_);
    copy_chosen();
    restart_some();
    if (!share_out() || !(objective_.cost(trial_.balls) < trial_.max_cost)) trial_.balls.clear();
    return std::move(trial_);
  }

 private:
  // Chooses a ball, costly ones more often, and some of its neighbours. Sometimes also a cheap ball from anywhere that
  // is to move here, together with neighbours that must take over its samples.
  void choose() {
    const bool as_wanted = !very_few() && random_.uniform() < kWantedShare;
    trial_.chosen.push_back(as_wanted ? pick_wanted() : pick(1 + random_.below(3), true));
    add_neighbors(trial_.chosen[0], very_few() ? 1 + random_.below(5) : few_neighbors(few() ? 5 : 3));
    if (very_few() || random_.uniform() >= kMoveShare) return;
    const Index cheap = pick(few() ? 4 : 8, false);
    if (is_chosen(cheap)) return;
    trial_.moved = static_cast<Index>(trial_.chosen.size());
    trial_.chosen.push_back(cheap);
    add_neighbors(cheap, few_neighbors(3));
  }

  Index pick_wanted() {
    const auto at = std::upper_bound(wanted_.begin(), wanted_.end(), random_.uniform() * wanted_.back());
    return std::min(static_cast<Index>(at - wanted_.begin()), balls_.size() - 1);
  }

  // A random number from 1 to `max`, mostly small: trials of few balls cost little and succeed most often.
  std::size_t few_neighbors(std::size_t max) {
    const std::size_t one = random_.below(max), other = random_.below(max);
    return 1 + std::min(one, other);
  }

  // The loosest (or the tightest) of `tournament` balls that are picked at random.
  Index pick(std::uint64_t tournament, bool loose) {
    Index best = static_cast<Index>(random_.below(balls_.size()));
    for (std::uint64_t i = 1; i < tournament; ++i) {
      const Index other = static_cast<Index>(random_.below(balls_.size()));
      if ((balls_[other].looseness() > balls_[best].looseness()) == loose) best = other;
    }
    return best;
  }

  // Each other ball of the level has its own random factor, but only those of nearby balls are computed: the result
  // is as if all had been drawn.
  void add_neighbors(Index of, std::size_t how_many) {
    std::vector<std::pair<double, Index>> near;
    for (Index b : balls_.places().nearest(of, how_many, kNearer, kFarther)) {
      const double apart = (balls_[b].center - balls_[of].center).norm() - 0.5 * balls_[b].radius;
      near.emplace_back(apart * after(b < of ? b : b - 1, random_).uniform(kNearer, kFarther), b);
    }
    random_ = after(balls_.size() - 1, random_);
    how_many = std::min(how_many, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(how_many), near.end());
    for (std::size_t i = 0; i < how_many; ++i)
      if (!is_chosen(near[i].second)) trial_.chosen.push_back(near[i].second);
  }

  bool few() const { return balls_.size() <= kFewAtStake; }
  // With so few balls the search gets stuck in a local minimum unless most of them change at a time.
  bool very_few() const { return balls_.size() <= kFewForMoves; }

  bool is_chosen(Index ball) const {
    return std::find(trial_.chosen.begin(), trial_.chosen.end(), ball) != trial_.chosen.end();
  }

  void copy_chosen() {
    double cost = 0;
    for (Index b : trial_.chosen) {
      cost += objective_.cost(balls_[b]);
      LevelBall& copy = trial_.balls.emplace_back();
      static_cast<FittedBall&>(copy) = balls_[b];
      copy.path_region = balls_[b].path_region;
    }
    trial_.max_cost = cost * (1 - kWorthwhileSaving);
  }

  void restart_some() {
    const bool moves = trial_.moved != kNone;
    if (moves) {
      const std::vector<Index>& there = balls_[trial_.chosen[0]].samples;
      restart(trial_.balls[trial_.moved], there.empty() ? freed_ : there);
    }
    if (moves) return;
    const double which = random_.uniform();
    if (very_few()) {
      const double share = which < kAllRestartShare ? 1.0 : kEachRestartShare;
      for (LevelBall& ball : trial_.balls)
        if (random_.uniform() < share) restart(ball, freed_);
      return;
    }
    const int restarts = which < kStayShare ? 0 : which < kStayShare + kOneRestartShare ? 1 : 2;
    for (int k = 0; k < restarts; ++k) restart(trial_.balls[random_.below(trial_.balls.size())], freed_);
  }

  // Starts a ball over near one of the samples, in a path region that holds the sample.
  void restart(LevelBall& ball, const std::vector<Index>& samples) {
    const Index sample = samples[random_.below(samples.size())];
    Point center = samples_.starts[sample];
    if (random_.uniform() < 0.3) center = 0.5 * (center + samples_.points[sample]);
    static_cast<FittedBall&>(ball) = fitter_.at(center);
    const std::vector<Index>& regions = regions_.regions_of(sample);
    ball.path_region = regions[random_.below(regions.size())];
  }

  // Lloyd's iteration among the trial's balls: samples to balls, balls to samples. Returns false if a sample lies in no
  // path region of theirs, if a ball is left without samples, or if the balls are so loose that another round would not
  // make the trial worthwhile.
  bool share_out() {
    trial_.needs.resize(trial_.balls.size());
    gather_freed();
    const int rounds = few() ? kSharingRoundsOfFew : kSharingRounds;
    for (int round = 1; round <= rounds; ++round)
      if (!divide_freed() || !fit_all(round == rounds)) return false;
    return std::none_of(trial_.needs.begin(), trial_.needs.end(), [](const auto& list) { return list.empty(); });
  }

  // Fits each ball to its samples, the loosest first: a trial that is going to fail mostly fails by these.
  bool fit_all(bool last) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < trial_.balls.size(); ++i) {
      if (trial_.needs[i].empty())
        restart(trial_.balls[i], freed_);
      else
        order.push_back(i);
    }
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return looseness_[a] > looseness_[b] || (looseness_[a] == looseness_[b] && a < b);
    });
    double hoped = 0;
    for (std::size_t i : order) {
      LevelBall& ball = trial_.balls[i];
      static_cast<FittedBall&>(ball) = fitter_.fit(trial_.needs[i], ball, last ? kLastEvaluations : kFirstEvaluations);
      FittedBall tighter = ball;
      if (!last) tighter.radius -= kHoped * ball.looseness();
      hoped += objective_.cost(tighter);
      if (hoped >= trial_.max_cost) return false;
    }
    return true;
  }

  void gather_freed() {
    auto& [fitter, x, y, z, min, owner] = scratch_;
    for (auto* numbers : {&x, &y, &z, &min, &owner}) numbers->resize(freed_.size());
    for (std::size_t k = 0; k < freed_.size(); ++k) {
      const Point& p = samples_.points[freed_[k]];
      x[k] = static_cast<float>(p.x()), y[k] = static_cast<float>(p.y()), z[k] = static_cast<float>(p.z());
    }
  }

  // For each sample to be shared out: 0 if it lies in the path region, else infinity.
  const std::vector<float>& barred(Index path_region) {
    const auto known =
        std::find_if(barred_.begin(), barred_.end(), [&](const auto& b) { return b.first == path_region; });
    if (known != barred_.end()) return known->second;
    std::vector<float>& bars = barred_.emplace_back(path_region, std::vector<float>(freed_.size())).second;
    for (std::size_t k = 0; k < bars.size(); ++k) bars[k] = regions_.holds_sample(path_region, freed_[k]) ? 0 : kBarred;
    return bars;
  }

  // Gives each sample to the ball that can hold it with the least looseness.
  bool divide_freed() {
    auto& [fitter, x, y, z, min, owners] = scratch_;
    std::fill(min.begin(), min.end(), kBarred);
    for (Index i = 0; i < trial_.balls.size(); ++i) {
      const LevelBall& ball = trial_.balls[i];
      const float* bars = barred(ball.path_region).data();
      (wide() ? divide_wide : divide)(ball, i,
                                      {freed_.size(), x.data(), y.data(), z.data(), bars, min.data(), owners.data()});
    }
    if (std::any_of(min.begin(), min.end(), [](float loose) { return !(loose < kBarred); })) return false;
    for (auto& list : trial_.needs) list.clear();
    looseness_.assign(trial_.balls.size(), -kInfinity);
    for (std::size_t k = 0; k < freed_.size(); ++k) {
      const auto owner = static_cast<std::size_t>(owners[k]);
      trial_.needs[owner].push_back(samples_.points[freed_[k]]);
      looseness_[owner] = std::max(looseness_[owner], static_cast<double>(min[k]));
    }
    return true;
  }

  const LevelBalls& balls_;
  const PathRegions& regions_;
  const Samples& samples_;
  const LevelObjective& objective_;
  const std::span<const double> wanted_;
  Random random_;
  LevelTrial trial_;
  TrialScratch& scratch_;
  BallFitter& fitter_;
  std::vector<Index> freed_;                                  // samples that only the chosen balls hold
  std::vector<std::pair<Index, std::vector<float>>> barred_;  // by path region
  std::vector<double> looseness_;                             // of the trial's balls, with what each owns
};

}  // namespace

LevelTrial propose_trial(const LevelBalls& balls, const LevelObjective& objective, std::span<const double> wanted,
                         Random random, TrialScratch& scratch) {
  return Proposal(balls, objective, wanted, random, scratch).run();
}

}  // namespace orchard::detail
