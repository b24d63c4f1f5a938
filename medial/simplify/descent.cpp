#include "descent.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "../quality/boundary_reach.h"
#include "climb.h"
#include "contract_by_samples.h"
#include "improve.h"
#include "slab_quadrics.h"
#include "two_sided.h"

namespace orchard::detail {
namespace {

// Quadrics are used down to kBySlabs times the wanted number of vertices, but at least kMinBySlabs. They are fast; the
// rest is left to the samples, which are more accurate.
constexpr Index kBySlabs = 2, kMinBySlabs = 1000;
constexpr double kFree = 1e-5;     // diagonals: contractions that move a ball from its planes by less cost nothing
constexpr double kGuarded = 5e-4;  // diagonals: quadrics move no sample farther off as long as they can avoid it
constexpr double kShrink = 0.6;    // vertices left by one pass of contractions
constexpr double kMoved = 0.08;    // share of the vertices that the first round moves
constexpr double kWorthwhile =
    0.02;                            // of the largest distance: the search ends after two rounds in turn that gain less
constexpr double kNotable = 0.6;     // of the largest distance: places that are at least this far off become samples
constexpr double kInvisible = 2e-4;  // diagonals: shallower dents are not searched
constexpr std::size_t kSamplesPerDent = 50;  // samples of the surface for each dent that becomes a sample, at least
constexpr std::size_t kBallsPerLook = 3;     // one in so many balls of the axis is used to search for dents
constexpr FitOptions kBetween[] = {{.power = 4, .steps = 1, .middles = false}};
constexpr FitOptions kAtEnd[] = {
    {.power = 2, .steps = 2}, {.power = 4, .steps = 4, .search = false}, {.power = 8, .steps = 6, .search = false}};
constexpr FitOptions kAfterInsertion[] = {{.power = 4, .steps = 2, .search = false, .middles = false}};
constexpr FitOptions kAfterMoving[] = {{.power = 4, .steps = 2}, {.power = 8, .steps = 5, .search = false}};

// The vertices of a mesh in an order in which most are neighbours of the one before.
std::vector<Index> in_depth_first_order(const ContractibleMesh& mesh) {
  std::vector<Index> order, stack;
  std::vector<std::uint8_t> seen(mesh.size(), 0);
  order.reserve(mesh.size());
  for (Index start = 0; start < mesh.size(); ++start) {
    stack.push_back(start);
    while (!stack.empty()) {
      const Index v = stack.back();
      stack.pop_back();
      if (seen[v]) continue;
      seen[v] = 1;
      order.push_back(v);
      for (const Index other : mesh.neighbors(v)) {
        if (!seen[other]) stack.push_back(other);
      }
    }
  }
  return order;
}

}  // namespace

Descent::Descent(const Surface& surface, const MedialMesh& mesh, const SimplifyOptions& options,
                 const Progress& progress)
    : surface_(surface),
      options_(options),
      progress_(progress),
      diagonal_(surface.bounding_box().diagonal().norm()),
      vertices_before_(mesh.size()),
      whole_(mesh) {
  axis_balls_.reserve(mesh.size());
  for (const Index v : in_depth_first_order(whole_)) axis_balls_.push_back({mesh.centers[v], mesh.radii[v]});
}

Stage Descent::start(SimplifiedBalls contracted) const {
  return {whole_, fit_samples(surface_, options_.samples, options_.seed), {}, contracted};
}

void Descent::go_down(Stage& stage, Index count) const {
  contract_by_slabs(surface_, stage.mesh, stage.samples,
                    std::max({count, kBySlabs * std::min(count, stage.mesh.living()), kMinBySlabs}), count,
                    kFree * diagonal_, kGuarded * diagonal_);
  stage.feet = {};
  stage.feet.find(stage.mesh, stage.samples);
  refine(stage, kBetween);
  while (stage.mesh.living() > count) {
    const Index before = stage.mesh.living();
    contract(stage, std::max(count, static_cast<Index>(kShrink * before)));
    if (stage.mesh.living() == before) {
      if (!stage.mesh.make_contractible() && !stage.mesh.merge_edges()) break;
      stage.feet.feet.clear();  // the cells of some may be gone
    }
    refine(stage, kBetween);
  }
}

void Descent::contract(Stage& stage, Index count) const {
  const ContractionOptions options{stage.contracted, options_.balls == SimplifiedBalls::medial};
  contract_by_samples(surface_, stage.mesh, stage.samples, stage.feet, options, count);
}

void Descent::refine(Stage& stage, std::span<const FitOptions> passes) const {
  for (const FitOptions& pass : passes) fit(surface_, stage.mesh, stage.samples, stage.feet, options_.balls, pass);
}

Stage Descent::finished(Stage stage) const {
  const Index count = stage.mesh.living();
  refine(stage, kAtEnd);
  stage.feet.find_off(stage.mesh, stage.samples, kNotable * stage.feet.max);
  look_closer(stage, 0);
  double share = kMoved;
  bool failed = false;
  for (int round = 0; round < options_.rounds; ++round) {
    report_progress(progress_, "simplifying the axis: moving vertices", static_cast<double>(round) / options_.rounds);
    Stage next = stage;
    const Index moved = std::max(Index{1}, static_cast<Index>(share * count));
    if (insert_at_worst(surface_, next.mesh, next.samples, next.feet, moved) == 0) break;
    refine(next, kAfterInsertion);
    contract(next, count);
    if (next.mesh.living() > count) break;
    refine(next, kAfterMoving);
    next.feet.find_off(next.mesh, next.samples, kNotable * next.feet.max);
    look_closer(next, round + 1);
    // Both meshes are judged at the same places, and these are samples from now on, whichever mesh is kept.
    const std::vector<FitSample> found(next.samples.begin() + static_cast<std::ptrdiff_t>(stage.samples.size()),
                                       next.samples.end());
    add(stage, found);
    const double gain = 1 - next.feet.worst() / stage.feet.worst();
    if (gain > 0) stage = std::move(next);
    const bool enough = gain < kWorthwhile;
    if (enough && failed) break;
    failed = enough;
    if (enough) share /= 2;  // moving fewer vertices may succeed where many hindered each other
  }
  if (options_.balls == SimplifiedBalls::medial) make_medial(surface_, stage.mesh, stage.feet.worst());
  return stage;
}

void Descent::look_closer(Stage& stage, int round) const {
  std::vector<FitSample> others =
      fit_samples(surface_, options_.samples, options_.seed + static_cast<std::uint64_t>(round) + 1);
  Assignment feet;
  const double enough = kNotable * stage.feet.worst();
  feet.find_off(stage.mesh, others, enough);
  std::vector<FitSample> off;
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (std::abs(feet.feet[i].value) >= enough) off.push_back(others[i]);
  }
  climb(surface_, stage.mesh, std::sqrt(surface_.report().area / options_.samples), off);
  for (FitSample& sample : off) sample.area = 0;
  add(stage, off);
  if (enough > kInvisible * diagonal_) add_dents(stage, round, enough);
}

// Adds samples for dents, that is, for what the reconstruction leaves open deep below the surface. Samples on the
// surface cannot show the depth of a dent: none is as far from the reconstruction as the dent's bottom is from the
// surface.
void Descent::add_dents(Stage& stage, int round, double min_depth) const {
  std::vector<Sphere> balls;  // others in each round, since each dent is found from many balls
  for (std::size_t i = static_cast<std::size_t>(round) % kBallsPerLook; i < axis_balls_.size(); i += kBallsPerLook)
    balls.push_back(axis_balls_[i]);
  std::vector<Dent> dents = dents_seen_from(balls_beyond(stage.mesh, balls, min_depth), surface_,
                                            Reconstruction(stage.mesh.mesh()), min_depth);
  const std::size_t max = options_.samples / kSamplesPerDent;
  if (dents.size() > max) dents.resize(max);
  std::vector<FitSample> samples;
  samples.reserve(dents.size());
  for (const Dent& dent : dents) samples.push_back({dent.place, dent.outward, 1.0 / options_.samples, dent.depth});
  add(stage, samples);
}

void Descent::add(Stage& stage, std::span<const FitSample> samples) const {
  Assignment feet;
  feet.find(stage.mesh, samples);
  stage.samples.insert(stage.samples.end(), samples.begin(), samples.end());
  stage.feet.feet.insert(stage.feet.feet.end(), feet.feet.begin(), feet.feet.end());
  stage.feet.max = std::max(stage.feet.max, feet.max);
}

SimplifiedMedialMesh Descent::measured(const Stage& stage) const {
  SimplifiedMedialMesh result;
  result.mesh = stage.mesh.mesh();
  result.report.vertices_before = vertices_before_;
  result.report.vertices = result.mesh.size();
  measure_two_sided(surface_, result.mesh, axis_balls_, options_, result.report);
  return result;
}

}  // namespace orchard::detail
