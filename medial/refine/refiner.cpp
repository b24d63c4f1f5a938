#include "refiner.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "../axis_triangles.h"
#include "axis_of_balls.h"
#include "cut_at_level.h"
#include "dents_below.h"
#include "drop_degenerate.h"
#include "drop_doubled.h"
#include "drop_flakes.h"
#include "extend_sheets.h"
#include "orchard/geometry/angle.h"
#include "orchard/geometry/error.h"
#include "orchard/medial/quality.h"
#include "small_pieces.h"
#include "solve_again.h"
#include "spread_flat.h"

namespace orchard::detail {
namespace {

constexpr const char* kStage = "refining the axis";
// Contacts merge where the ball between them would lose this much of what a border may lose: fine enough to see on
// which side of the level a vertex is.
constexpr double kMerging = 0.25;
constexpr int kBorderPasses = 3;     // of filling notches and reaching edges: the last ones find next to nothing
constexpr double kMinLength = 1e-3;  // diagonals: shorter edges are not divided
constexpr std::size_t kEnough = 24;  // seeds of a vertex: coalesced ones have hundreds
constexpr double kOpen = 1.65;       // of the border loss: places left open by more are reached for
constexpr double kResolution = 0.1;  // spacings, of looking for these
constexpr double kDetail = 0.15;     // of what is left open: places open by this more are not missed
constexpr double kDentWidth = 0.5;   // of what is left open: narrower dents are missed
constexpr int kReachPasses = 3;      // of reaching for what dropped pieces leave open: one does for most meshes
constexpr int kDentRounds = 3;       // of looking for these, once nothing is open: some stay where no ball fits
constexpr double kApart = 0.5;       // spacings, between two that are reached for at once
constexpr double kShorter = 0.5;     // spacings, by which the borders become shorter where a doubled sheet goes
constexpr double kDegree = std::numbers::pi / 180;
// Of borders as the diagram leaves them, and as they grow.
constexpr NotchLimits kNotches{
    .max_angle = 150 * kDegree, .max_bend = 180 * kDegree, .max_length = 4, .min_loss = 0.5, .on_trial = false};
// Of borders where they go in steps from one facet of the surface to the next; over wide angles, since what is in
// between has a ball that would lose less, but still something.
constexpr NotchLimits kSteps{
    .max_angle = 176 * kDegree, .max_bend = 60 * kDegree, .max_length = 6, .min_loss = 0.2, .on_trial = true};
constexpr double kCoincident = 1e-6;  // diagonals: vertices that are nearer are one

void check(const RefineOptions& options) {
  if (!(options.border_loss >= 0 && std::isfinite(options.border_loss)))
    throw InputError("border loss: a finite number of diagonals, not negative");
  if (!(options.tolerance > 0 && std::isfinite(options.tolerance)))
    throw InputError("refining tolerance: a finite number of diagonals above 0");
  if (!(options.sharp_angle >= 0 && options.sharp_angle <= std::numbers::pi))
    throw InputError("sharp angle: between 0 and pi");
  if (options.max_rounds < 0) throw InputError("rounds of refining: not negative");
  if (!(options.reach_detail >= 0 && std::isfinite(options.reach_detail)))
    throw InputError("detail that is reached for: a finite number, not negative");
  if (options.reach_rounds < 0) throw InputError("rounds of reaching for open places: not negative");
}

// Where balls are of which others were taken away, by their numbers before; kNone for those.
std::vector<Index> numbers_of(const std::vector<ExactBall>& before, const std::vector<ExactBall>& left) {
  std::vector<Index> number(before.size(), kNone);
  Index next = 0;
  for (std::size_t v = 0; v < before.size() && next < left.size(); ++v) {
    if (before[v].center == left[next].center && before[v].radius == left[next].radius) number[v] = next++;
  }
  return number;
}

}  // namespace

double left_open(const Surface& surface, const RefineOptions& options, Index points) {
  const double squared_spacing = surface.report().area / points / surface.bounding_box().diagonal().squaredNorm();
  return std::max(kOpen * std::max(options.border_loss, options.tolerance), options.reach_detail * squared_spacing);
}

Refiner::Refiner(const Surface& surface, const SurfaceSampling& sampling, const MedialAxis& axis,
                 const RefineOptions& options, const Progress& progress)
    : surface_(surface),
      sampling_(sampling),
      axis_(axis),
      options_(options),
      progress_(progress),
      diagonal_(surface.bounding_box().diagonal().norm()),
      level_(std::max(options.border_loss, std::numeric_limits<double>::min()) * diagonal_),
      guard_(sampling.points, left_open()) {
  check(options);
}

void Refiner::refine(FoundBalls* found) {
  report_.vertices_before = axis_.size();
  make_complex();
  find_balls(found);
  solve_outliers_again(surface_, complex_, kMerging * level_);
  report_progress(progress_, kStage, 0.25);
  drop_folded();
  report_.border_cuts = cut_at_level(surface_, complex_, level_, kMerging * level_);
  report_.small_pieces = drop_small_pieces(complex_, &guard_);
  report_progress(progress_, kStage, 0.45);
  mend_borders();
  report_.small_pieces += drop_small_pieces(complex_, &guard_);
  report_progress(progress_, kStage, 0.6);
}

RefinedAxis Refiner::finish() {
  std::vector<Sphere> around;
  drop_degenerate_cells(false, around);
  drop_doubled_and_flakes();
  smooth_borders();
  divide();
  reach();
  spread_flat(surface_, complex_, kMerging * level_);
  report_progress(progress_, kStage, 1);
  return result();
}

// What is left of flat triangles may hang on the rest by one vertex. Returns whether such pieces went, or flakes, and
// adds spheres around them.
bool Refiner::drop_degenerate_cells(bool and_flakes, std::vector<Sphere>& around) {
  const std::vector<ExactBall> before = complex_.balls;
  report_.degenerate += drop_degenerate(complex_, kCoincident * diagonal_);
  Index pieces = and_flakes ? drop_flakes(complex_, &guard_, &around) : 0;
  pieces += drop_small_pieces(complex_, &guard_, &around);
  report_.small_pieces += pieces;
  split_errors_.renumber(numbers_of(before, complex_.balls));
  return pieces > 0;
}

// Before anything is divided: what is taken away needs no dividing, and what it covered alone is reached for.
void Refiner::drop_doubled_and_flakes() {
  report_.doubled = drop_doubled(complex_, options_.tolerance * diagonal_, kShorter * border_options().spacing);
  report_.small_pieces += drop_flakes(complex_, &guard_);
  report_.small_pieces += drop_small_pieces(complex_, &guard_);
}

// Between one facet of the surface and the next, what sheets lose jumps, and their borders go in steps.
void Refiner::smooth_borders() {
  BallSolver solver = this->solver();
  report_.notches += fill_notches(surface_, complex_, solver, border_options(), split_options(), kSteps);
}

BallSolver Refiner::solver() const { return {surface_, kMerging * level_}; }

ClosestPoint Refiner::place(Index point) const {
  return {.position = sampling_.points[point],
          .distance = 0,
          .triangle = sampling_.triangles[point],
          .feature = sampling_.features[point]};
}

void Refiner::make_complex() {
  AxisTriangles triangles = axis_triangles(axis_);
  face_of_triangle_ = std::move(triangles.face_of_triangle);
  complex_.balls.resize(triangles.mesh.size());
  for (Index v = 0; v < triangles.mesh.size(); ++v) complex_.balls[v].center = triangles.mesh.centers[v];
  complex_.edges = std::move(triangles.mesh.edges);
  complex_.triangles = std::move(triangles.mesh.triangles);
}

// Where the ball of a vertex is looked for: its forming points; for the middle of a face, its two points.
void Refiner::seeds_of(Index vertex, const std::vector<Index>& face_of_middle, std::vector<ClosestPoint>& seeds) const {
  seeds.clear();
  const auto add = [&](Index point) { seeds.push_back(place(point)); };
  if (vertex < axis_.size()) {
    const std::span<const Index> points = axis_.forming_points[vertex];
    std::for_each_n(points.begin(), std::min(kEnough, points.size()), add);
  } else {
    for (const Index point : points_of(face_of_middle[vertex - axis_.size()])) add(point);
  }
}

void Refiner::find_balls(FoundBalls* found) {
  std::vector<Index> face_of_middle(complex_.size() - axis_.size(), kNone);
  for (Index t = 0; t < complex_.triangles.size(); ++t) {
    for (const Index v : complex_.triangles[t]) {
      if (v >= axis_.size()) face_of_middle[v - axis_.size()] = face_of_triangle_[t];
    }
  }
  std::vector<Point> starts;
  for (const ExactBall& ball : complex_.balls) starts.push_back(ball.center);
  tbb::parallel_for(tbb::blocked_range<Index>(0, complex_.size(), 64), [&](const auto& range) {
    BallSolver solver = this->solver();
    std::vector<ClosestPoint> seeds;
    for (Index v = range.begin(); v != range.end(); ++v) {
      seeds_of(v, face_of_middle, seeds);
      const ExactBall* known = found ? found->find(starts[v], seeds) : nullptr;
      complex_.balls[v] = known ? *known : solver.solve(starts[v], seeds);
    }
  });
  if (!found) return;
  std::vector<ClosestPoint> seeds;
  for (Index v = 0; v < complex_.size(); ++v) {
    seeds_of(v, face_of_middle, seeds);
    found->add(starts[v], seeds, complex_.balls[v]);
  }
}

const std::array<Index, 2>& Refiner::points_of(Index face) const {
  return face < axis_.faces.size() ? axis_.face_points[face] : axis_.wall_points[face - axis_.faces.size()];
}

std::span<const Index> Refiner::corners_of(Index face) const {
  return face < axis_.faces.size() ? axis_.faces[face] : axis_.walls[face - axis_.faces.size()];
}

// Whether the two points of a face have, seen from its middle, contacts between which nothing is lost: such a face
// folds onto its sheet, or stands on the surface.
bool Refiner::folded(Index face, BallSolver& solver) const {
  Point middle = Point::Zero();
  for (const Index v : corners_of(face)) middle += axis_.centers[v];
  middle /= static_cast<double>(corners_of(face).size());
  const auto& [p, q] = points_of(face);
  const ClosestPoint a = solver.descend(middle, place(p)), b = solver.descend(middle, place(q));
  const double angle = angle_between(a.position - middle, b.position - middle);
  return BallSolver::loss(std::min(a.distance, b.distance), angle) < level_;
}

void Refiner::drop_folded() {
  std::vector<std::uint8_t> folded_faces(axis_.faces.size() + axis_.walls.size(), 0);
  tbb::parallel_for(tbb::blocked_range<Index>(0, static_cast<Index>(folded_faces.size()), 128), [&](const auto& range) {
    BallSolver solver = this->solver();
    for (Index face = range.begin(); face != range.end(); ++face) folded_faces[face] = folded(face, solver) ? 1 : 0;
  });
  // Edges go with all of their triangles, vertices with all of their edges; those without triangles stay.
  std::vector<std::uint8_t> has(complex_.edges.size(), 0);
  Doomed doomed(complex_);
  std::fill(doomed.edges.begin(), doomed.edges.end(), std::uint8_t{1});
  std::fill(doomed.vertices.begin(), doomed.vertices.end(), std::uint8_t{1});
  const EdgeNumbers edge = complex_.edge_numbers();
  for (Index t = 0; t < complex_.triangles.size(); ++t) {
    const auto& [a, b, c] = complex_.triangles[t];
    for (const Index e : {edge(a, b), edge(a, c), edge(b, c)}) {
      has[e] = 1;
      if (!folded_faces[face_of_triangle_[t]]) doomed.edges[e] = 0;
    }
  }
  for (Index e = 0; e < complex_.edges.size(); ++e) {
    if (!has[e]) doomed.edges[e] = 0;
    if (doomed.edges[e]) continue;
    for (const Index v : complex_.edges[e]) doomed.vertices[v] = 0;
  }
  const std::size_t before = complex_.triangles.size();
  collapse(complex_, doomed, std::vector<double>(complex_.size(), 0));
  complex_.complete();  // triangles came in the order of the axis's faces
  report_.folded_triangles = static_cast<Index>(before - complex_.triangles.size());
}

BorderOptions Refiner::border_options() const {
  return {.level = level_,
          .tolerance = options_.tolerance * diagonal_,
          .spacing = std::sqrt(surface_.report().area / sampling_.size()),
          .merging = kMerging * level_,
          .sharp_angle = options_.sharp_angle};
}

void Refiner::mend_borders() {
  const BorderOptions border = border_options();
  BallSolver solver = this->solver();
  for (int pass = 0; pass < kBorderPasses; ++pass) {
    const Index notches = fill_notches(surface_, complex_, solver, border, split_options(), kNotches);
    const Index seams = extend_to_seams(surface_, complex_, border);
    Index reached = extend_to_edges(surface_, complex_, border);
    reached += follow_edges(surface_, complex_, border);
    reached += extend_to_corners(surface_, complex_, border);
    report_.notches += notches;
    report_.edge_vertices += reached;
    if (notches == 0 && seams == 0 && reached == 0) break;
  }
  report_.notches += fill_along_edges(surface_, complex_, border);
  report_.edge_vertices += follow_edges(surface_, complex_, border);
}

SplitOptions Refiner::split_options() const {
  return {.tolerance = options_.tolerance * diagonal_,
          .merging = kMerging * level_,
          .min_length = kMinLength * diagonal_,
          .max_rounds = options_.max_rounds};
}

void Refiner::divide() {
  const SplitReport split = split_nonlinear(surface_, complex_, split_options(), split_errors_, progress_);
  report_.divided += split.divided;
  report_.undivided = split.undivided;
}

double Refiner::left_open() const { return detail::left_open(surface_, options_, sampling_.size()) * diagonal_; }

Index Refiner::reach_for(const Reconstruction& reconstruction, const std::vector<UncoveredPlace>& places,
                         BallSolver& solver) {
  return reach_open_places(surface_, complex_, solver, reconstruction, places, left_open() / kOpen, border_options(),
                           split_options());
}

// Again as long as pieces go that may have covered something alone; flakes that come again at last stay.
void Refiner::reach() {
  const double spacing = border_options().spacing, limit = left_open();
  UncoveredSearch open(surface_, limit, kResolution * spacing, kDetail * limit);
  DentsBelow dents(surface_, limit, kDentWidth * limit);
  std::vector<Sphere> around;
  for (int pass = 0; pass < kReachPasses; ++pass) {
    reach(open, dents);
    around.clear();
    if (!drop_degenerate_cells(pass + 1 < kReachPasses, around)) break;
    open.look_again(around);
    dents.look_again(around);
  }
}

// Where balls leave the surface open by more than borders may, then where dents between them are deeper; what is added
// is divided, too.
void Refiner::reach(UncoveredSearch& open, DentsBelow& dents) {
  const BorderOptions border = border_options();
  const double apart = kApart * border.spacing;
  BallSolver solver = this->solver();
  Reconstruction reconstruction(complex_.mesh());
  int dent_rounds = 0;
  for (int round = 0; round < options_.reach_rounds; ++round) {
    if (round > 0) reconstruction.change(complex_.mesh());
    Index reached = reach_for(reconstruction, open.find(reconstruction, apart), solver);
    if (reached == 0 && dent_rounds++ < kDentRounds)
      reached = reach_for(reconstruction, dents.find(reconstruction, apart), solver);
    if (reached == 0) break;
    report_.reached_places += reached;
    report_.notches += fill_notches(surface_, complex_, solver, border, split_options(), kNotches);
    report_.notches += fill_along_edges(surface_, complex_, border);
    report_.edge_vertices += follow_edges(surface_, complex_, border);
    divide();
  }
}

RefinedAxis Refiner::result() {
  RefinedAxis refined;
  refined.axis = axis_of_balls(surface_, complex_);
  refined.axis.stems = axis_.stems;
  refined.axis.bridges = axis_.bridges;
  refined.axis.left_out = axis_.left_out;
  report_.vertices = refined.axis.size();
  report_.inexact = static_cast<Index>(
      std::count_if(complex_.balls.begin(), complex_.balls.end(), [](const ExactBall& ball) { return !ball.exact; }));
  report_.border_length = border_length(medial_mesh(refined.axis)) / diagonal_;
  refined.report = report_;
  return refined;
}

}  // namespace orchard::detail
