#include "fit.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "normal_equations.h"
#include "protrusions.h"

namespace orchard::detail {
namespace {

constexpr double kFirstDamping = 1e-3, kMinDamping = 1e-6, kMaxDamping = 1e3;
constexpr std::size_t kInTurn = 64;      // the number of samples of one task, which are processed in order
constexpr double kExact = 0.5;           // of the largest distance: smaller distances do not have to be exact
constexpr double kHardly = 0.02;         // of the largest distance: balls that protrude by less are not moved for that
constexpr double kVolume = 0.01;         // of the solid's volume: the scale on which a missing or surplus volume counts
constexpr double kVolumeWeight = 1;      // over all other costs at the beginning: the cost of that much volume
constexpr double kInsideSurface = 1e-7;  // in bounding radii: centres outside are put this far inside the surface
constexpr double kFloor = 1e-3;          // the share of the weight that small distances keep at high powers

LookOptions look_options(const Surface& surface, std::span<const FitSample> samples, const FitOptions& options) {
  LookOptions look(surface, samples[0].weight);
  look.cells = options.middles;
  return look;
}

class Fitter {
 public:
  Fitter(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples, Assignment& feet,
         SimplifiedBalls balls, const FitOptions& options)
      : surface_(surface),
        mesh_(mesh),
        samples_(samples),
        feet_(feet),
        medial_(balls == SimplifiedBalls::medial),
        options_(options),
        walker_(mesh),
        places_(places_to_look(mesh, look_options(surface, samples, options))),
        inside_(places_.size()),
        equations_(mesh),
        volume_factor_(surface.report().area / (kVolume * surface.report().volume)) {}

  void run() {
    const bool known = feet_.feet.size() == samples_.size();
    if (known && medial_) {
      make_medial(surface_, mesh_, feet_.max);
      walker_.follow_mesh();
    }
    if (known) feet_.walk(samples_, walker_);
    if (options_.search || !known) feet_.find_off(mesh_, samples_, kExact * feet_.max);
    negligible_ = kHardly * feet_.max;
    protrusions_ = protruding();
    scale_ = std::max(feet_.max, 1e-300);
    for (const Protrusion& protrusion : protrusions_) scale_ = std::max(scale_, protrusion.value);
    if (medial_) volume_weight_ = kVolumeWeight * total();
    double cost = total();
    double damping = kFirstDamping;
    for (int step = 0; step < options_.steps && damping < kMaxDamping; ++step) {
      assemble();
      const std::vector<Ball4> before = balls();
      const Assignment feet_before = feet_;
      const std::vector<Protrusion> protrusions_before = protrusions_;
      move(before, damping);
      feet_.walk(samples_, walker_);
      protrusions_ = protruding();
      const double next = total();
      if (next < cost) {
        cost = next;
        damping = std::max(kMinDamping, damping / 4);
      } else {
        restore(before);
        feet_ = feet_before;
        protrusions_ = protrusions_before;
        damping *= 8;
      }
    }
    feet_.max_protrusion = 0;
    for (const Protrusion& protrusion : protrusions_)
      feet_.max_protrusion = std::max(feet_.max_protrusion, protrusion.value);
  }

 private:
  double weight_at(double value) const {
    return options_.power == 2 ? 1 : kFloor + std::pow(std::abs(value) / scale_, options_.power - 2);
  }
  double cost_of(double value) const {
    const double relative = std::abs(value) / scale_;
    return (options_.power == 2 ? 0 : kFloor * relative * relative) + std::pow(relative, options_.power);
  }

  double total() const {
    double sum = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) sum += samples_[i].weight * cost_of(feet_.feet[i].value);
    for (const Protrusion& protrusion : protrusions_) sum += ball_weight() * cost_of(protrusion.value);
    if (volume_weight_ > 0) sum += volume_weight_ * volume_error() * volume_error();
    return sum;
  }
  // Returns the missing volume as a multiple of the scale above, as estimated from the samples.
  double volume_error() const {
    double sum = 0;
    for (std::size_t i = 0; i < samples_.size(); ++i) sum += samples_[i].area * feet_.feet[i].value;
    return sum * volume_factor_;
  }
  double ball_weight() const { return kProtrusionWeight * samples_[0].weight; }

  std::vector<Protrusion> protruding() { return find_protrusions(surface_, mesh_, places_, negligible_, inside_); }

  // The distance |p - c| - r changes by -(u, 1) * (dc, dr). If p is outside and no farther away than the radius of c,
  // the curvature of |p - c| counts, too.
  void assemble() {
    equations_.clear();
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      const Foot& foot = feet_.feet[i];
      const Ball4 ball = foot.ball(mesh_);
      const Vector way = samples_[i].position - ball.head<3>();
      const double length = way.norm();
      const Vector unit = length > 0 ? Vector(way / length) : samples_[i].normal;
      const double weight = samples_[i].weight * weight_at(foot.value);
      Ball4 row;
      row << unit, 1;
      Eigen::Matrix4d block = (options_.power - 1) * row * row.transpose();
      if (foot.value > 0) {
        const double bend = length > foot.value ? foot.value / length : 1;
        block.topLeftCorner<3, 3>() += bend * (Eigen::Matrix3d::Identity() - unit * unit.transpose());
      }
      equations_.add(foot.corners, foot.weights, weight * block, weight * foot.value * row);
      if (medial_) equations_.add_to_vector(foot.corners, foot.weights, samples_[i].area * volume_factor_ * row);
    }
    for (const Protrusion& protrusion : protrusions_) {
      const double weight = ball_weight() * weight_at(protrusion.value);
      Ball4 row;
      row << protrusion.outward, 1;
      equations_.add(protrusion.corners, protrusion.weights, weight * (options_.power - 1) * row * row.transpose(),
                     -weight * protrusion.value * row);
    }
    // It is scaled as the other sums are, over power / scale^2.
    if (volume_weight_ > 0)
      equations_.add_square(2 * volume_weight_ * scale_ * scale_ / options_.power, volume_error());
  }

  // Moves the balls. A radius that would fall below 0 becomes 0.
  void move(const std::vector<Ball4>& before, double damping) {
    std::vector<std::uint8_t> held(mesh_.size(), 0);
    for (Index v = 0; v < mesh_.size(); ++v)
      held[v] = mesh_.alive(v) && !(before[v][3] > 0) && equations_.side(v)[3] < 0 ? 1 : 0;
    const std::vector<Ball4> step = equations_.solve(damping, held);
    for (Index v = 0; v < mesh_.size(); ++v) {
      if (!mesh_.alive(v)) continue;
      Ball4 ball = before[v] + step[v];
      ball[3] = std::max(ball[3], 0.0);
      mesh_.set_ball(v, medial_ ? medial_ball(surface_, ball, scale_) : ball);
    }
    walker_.follow_mesh();
  }

  std::vector<Ball4> balls() const {
    std::vector<Ball4> result(mesh_.size());
    for (Index v = 0; v < mesh_.size(); ++v) result[v] = mesh_.ball(v);
    return result;
  }
  void restore(const std::vector<Ball4>& balls) {
    for (Index v = 0; v < mesh_.size(); ++v) mesh_.set_ball(v, balls[v]);
  }

  const Surface& surface_;
  ContractibleMesh& mesh_;
  const std::span<const FitSample> samples_;
  Assignment& feet_;
  const bool medial_;
  const FitOptions options_;
  FootWalker walker_;
  const std::vector<Protrusion> places_;  // the places of balls that may protrude; their values are not set
  std::vector<InsideBall> inside_;        // the ball inside the solid that was last found for each of them
  NormalEquations equations_;
  std::vector<Protrusion> protrusions_;
  double scale_ = 1, negligible_ = 0;
  const double volume_factor_;  // from weighted sums of distances to multiples of the volume scale
  double volume_weight_ = 0;    // the weight of the squared volume error in the sum; 0 if it does not count
};

}  // namespace

void Assignment::find(const ContractibleMesh& mesh, std::span<const FitSample> samples) {
  const FootFinder finder(mesh);
  feet.resize(samples.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, samples.size(), 256), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      feet[i] = finder.find(samples[i].position).below(samples[i].depth);
  });
  find_max();
}

void Assignment::find_off(const ContractibleMesh& mesh, std::span<const FitSample> samples, double enough) {
  const FootFinder finder(mesh);
  const FootWalker walker(mesh);
  const bool known = feet.size() == samples.size();
  feet.resize(samples.size());
  tbb::parallel_for(std::size_t{0}, (samples.size() + kInTurn - 1) / kInTurn, [&](std::size_t block) {
    const std::size_t begin = block * kInTurn, end = std::min(samples.size(), begin + kInTurn);
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [position, normal, weight, depth, area] = samples[i];
      if (i == begin && !known) {
        feet[i] = finder.find(position).below(depth);
        continue;
      }
      const Foot near = walker.walk(position, feet[known ? i : i - 1]);
      const double slack = near.value + depth + enough;
      feet[i] = finder.find(position, &near, slack < 2 * enough ? std::max(0.0, slack) : 0).below(depth);
    }
  });
  find_max();
}

void Assignment::walk(std::span<const FitSample> samples, const FootWalker& walker) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, samples.size(), 256), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i)
      feet[i] = walker.walk(samples[i].position, feet[i]).below(samples[i].depth);
  });
  find_max();
}

void Assignment::find_max() {
  max = 0;
  for (const Foot& foot : feet) max = std::max(max, std::abs(foot.value));
}

void fit(const Surface& surface, ContractibleMesh& mesh, std::span<const FitSample> samples, Assignment& feet,
         SimplifiedBalls balls, const FitOptions& options) {
  Fitter(surface, mesh, samples, feet, balls, options).run();
}

Ball4 medial_ball(const Surface& surface, const Ball4& ball, double error) {
  ClosestPoint nearest;
  Ball4 result = ball;
  double depth = -surface.signed_distance(ball.head<3>(), nearest);
  if (depth < 0) {
    const double least = kInsideSurface * surface.bounding_radius();
    result.head<3>() = nearest.position - least * surface.pseudonormal(nearest.triangle, nearest.feature);
    depth = 0;
  }
  result[3] = std::clamp(ball[3], std::max(0.0, depth - error), depth + error);
  return result;
}

void make_medial(const Surface& surface, ContractibleMesh& mesh, double error) {
  for (Index v = 0; v < mesh.size(); ++v) {
    if (mesh.alive(v)) mesh.set_ball(v, medial_ball(surface, mesh.ball(v), error));
  }
}

}  // namespace orchard::detail
