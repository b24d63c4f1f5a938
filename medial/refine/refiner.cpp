#include "refiner.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "../axis_triangles.h"
#include "../balls/axis_of_balls.h"
#include "../extend/extend_sheets.h"
#include "../reach/dents_below.h"
#include "../reach/reach_open_places.h"
#include "../remesh/remesh.h"
#include "cut_at_level.h"
#include "drop_degenerate.h"
#include "orchard/geometry/angle.h"
#include "orchard/geometry/error.h"
#include "orchard/medial/quality.h"
#include "small_pieces.h"

namespace orchard::detail {
namespace {

constexpr const char* kRefiningStage = "refining the axis";
// Contacts are merged if the ball between them loses less than this share of what a border may lose. The share is so
// small that each vertex is clearly on one side of the level.
constexpr double kMerging = 0.25;
constexpr int kBorderPasses = 3;  // rounds of extending sheets to edges and corners; the last ones add hardly anything
constexpr double kMinLength = 1e-3;    // in diagonals: shorter edges are not divided
constexpr std::size_t kMaxSeeds = 24;  // starting points of a vertex; merged vertices have hundreds of them
constexpr double kOpenLoss = 1.65;     // of the border loss: sheets are extended to places that are open by more
constexpr double kResolution = 0.1;    // in spacings: the resolution of the search for such places
constexpr double kDetail = 0.15;       // of the open distance: places that are open by this much more are never missed
constexpr double kDentWidth = 0.5;     // of the open distance: narrower dents are missed
constexpr int kReachPasses = 3;        // rounds of reaching open places and remeshing
// Rounds for dents after all places have been reached; some dents stay because no ball fits into them.
constexpr int kDentRounds = 3;
constexpr double kApart = 0.5;     // in spacings: the smallest distance of two places that are reached in one round
constexpr double kMinAim = 0.125;  // of the edge length asked for: the shortest edge length that remeshing aims at
constexpr int kEvenRounds = 6;
// Vertices of the mesh for each surface point: in finer meshes, surface points replace the vertices.
constexpr std::size_t kFineMesh = 2;
constexpr double kDegree = std::numbers::pi / 180;
// Limits for notches, both in the borders that the diagram leaves and while sheets are extended.
constexpr NotchLimits kNotches{
    .max_angle = 150 * kDegree, .max_bend = 180 * kDegree, .max_length = 4, .min_loss = 0.5, .on_trial = false};
constexpr double kCoincident = 1e-6;  // in diagonals: vertices nearer than this are merged

void check(const RefineOptions& options) {
  if (!(options.border_loss >= 0 && std::isfinite(options.border_loss)))
    throw InputError("the border loss must be a finite number of diagonals, at least 0");
  if (!(options.tolerance > 0 && std::isfinite(options.tolerance)))
    throw InputError("the tolerance of refining must be a finite number of diagonals above 0");
  if (!(options.feature_loss > 0 && std::isfinite(options.feature_loss)))
    throw InputError("the loss of features must be a finite number of diagonals above 0");
  if (!(options.feature_length >= 0 && std::isfinite(options.feature_length)))
    throw InputError("the length of features must be a finite number of diagonals, at least 0");
  if (!(options.edge_length > 0 && std::isfinite(options.edge_length)))
    throw InputError("the length of edges must be a finite number of diagonals above 0");
  if (options.max_rounds < 0) throw InputError("the number of rounds of refining must be at least 0");
  if (!(options.reach_detail >= 0 && std::isfinite(options.reach_detail)))
    throw InputError("the detail that is reached for must be a finite number, at least 0");
  if (options.reach_rounds < 0) throw InputError("the number of rounds of reaching for open places must be at least 0");
}

// Returns how far places may be open because of the border loss, in diagonals.
double left_open_by_borders(const RefineOptions& options) {
  return kOpenLoss * std::max(options.border_loss, options.tolerance);
}

FeatureEdges features_of(const Surface& surface, const RefineOptions& options, double diagonal) {
  if (!options.features.empty()) return {surface, options.features};
  return {surface, {.min_loss = options.feature_loss * diagonal, .min_length = options.feature_length * diagonal}};
}

}  // namespace

double left_open(const Surface& surface, const RefineOptions& options, Index points) {
  const double squared_spacing = surface.report().area / points / surface.bounding_box().diagonal().squaredNorm();
  return std::max(left_open_by_borders(options), options.reach_detail * squared_spacing);
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
      guard_(sampling.points, left_open()),
      features_(features_of(surface, options, diagonal_)) {
  check(options);
}

void Refiner::refine(FoundBalls* found) {
  report_.vertices_before = axis_.size();
  make_complex();
  find_balls(found);
  report_progress(progress_, kRefiningStage, 0.1);
  drop_single_contact_faces();
  report_.border_cuts = cut_at_level(surface_, complex_, level_, kMerging * level_);
  report_.small_pieces = drop_small_pieces(complex_, &guard_);
  report_.degenerate = drop_degenerate(complex_, kCoincident * diagonal_);
  report_progress(progress_, kRefiningStage, 0.2);
  reach_edges();
  report_.small_pieces += drop_small_pieces(complex_, &guard_);
  report_.degenerate += drop_degenerate(complex_, kCoincident * diagonal_);
  report_progress(progress_, kRefiningStage, 0.3);
}

RefinedAxis Refiner::finish() {
  places_ = sampling_.points;
  const std::vector<Point>& vertices = surface_.mesh().vertices;
  if (vertices.size() < kFineMesh * places_.size()) places_.insert(places_.end(), vertices.begin(), vertices.end());
  even_out();
  for (int pass = 0; reach() && pass < kReachPasses; ++pass) even_out();
  divide();
  report_.degenerate += drop_degenerate(complex_, kCoincident * diagonal_);
  report_progress(progress_, kRefiningStage, 1);
  return result();
}

// Remeshes what has changed since the last time, and its surroundings.
void Refiner::even_out() {
  const auto key = [](const ExactBall& ball) { return std::array{ball.center.x(), ball.center.y(), ball.center.z()}; };
  std::vector<std::uint8_t> where(complex_.size());
  for (Index v = 0; v < complex_.size(); ++v)
    where[v] = std::binary_search(evened_.begin(), evened_.end(), key(complex_.balls[v])) ? 0 : 1;
  const double length = options_.edge_length * diagonal_;
  const RemeshOptions options{.max_length = length,
                              .min_length = kMinAim * length,
                              .tolerance = options_.tolerance * diagonal_,
                              .limit = left_open_by_borders(options_) * diagonal_,
                              .merging = kMerging * level_,
                              .features = &features_,
                              .rounds = kEvenRounds};
  report_.vertices_moved += remesh(surface_, places_, complex_, where, options, progress_);
  split_errors_ = {};  // the vertices have been renumbered
  evened_.clear();
  for (const ExactBall& ball : complex_.balls) evened_.push_back(key(ball));
  std::sort(evened_.begin(), evened_.end());
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

// Collects the places where the ball of a vertex is searched: its forming points, or for the middle of a face, its two
// points.
void Refiner::seeds_of(Index vertex, const std::vector<Index>& face_of_middle, std::vector<ClosestPoint>& seeds) const {
  seeds.clear();
  const auto add = [&](Index point) { seeds.push_back(place(point)); };
  if (vertex < axis_.size()) {
    const std::span<const Index> points = axis_.forming_points[vertex];
    std::for_each_n(points.begin(), std::min(kMaxSeeds, points.size()), add);
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
  return face < axis_.faces.size() ? axis_.face_points[face] : axis_.topology_face_points[face - axis_.faces.size()];
}

std::span<const Index> Refiner::corners_of(Index face) const {
  return face < axis_.faces.size() ? axis_.faces[face] : axis_.topology_faces[face - axis_.faces.size()];
}

// Whether the two points of a face have, seen from its middle, contacts between which nothing is lost: such a face
// lies on its sheet a second time, or stands on the surface.
bool Refiner::has_single_contact(Index face, BallSolver& solver) const {
  Point middle = Point::Zero();
  for (const Index v : corners_of(face)) middle += axis_.centers[v];
  middle /= static_cast<double>(corners_of(face).size());
  const auto& [p, q] = points_of(face);
  const ClosestPoint a = solver.descend(middle, place(p)), b = solver.descend(middle, place(q));
  const double angle = angle_between(a.position - middle, b.position - middle);
  return BallSolver::loss(std::min(a.distance, b.distance), angle) < level_;
}

void Refiner::drop_single_contact_faces() {
  std::vector<std::uint8_t> single_contact(axis_.faces.size() + axis_.topology_faces.size(), 0);
  tbb::parallel_for(tbb::blocked_range<Index>(0, static_cast<Index>(single_contact.size()), 128),
                    [&](const auto& range) {
                      BallSolver solver = this->solver();
                      for (Index face = range.begin(); face != range.end(); ++face)
                        single_contact[face] = has_single_contact(face, solver) ? 1 : 0;
                    });
  // An edge is removed if all of its triangles are removed, and a vertex if all of its edges are. Edges and vertices
  // that had none stay.
  std::vector<std::uint8_t> has(complex_.edges.size(), 0);
  Doomed doomed(complex_);
  std::fill(doomed.edges.begin(), doomed.edges.end(), std::uint8_t{1});
  std::fill(doomed.vertices.begin(), doomed.vertices.end(), std::uint8_t{1});
  const EdgeNumbers edge = complex_.edge_numbers();
  for (Index t = 0; t < complex_.triangles.size(); ++t) {
    const auto& [a, b, c] = complex_.triangles[t];
    for (const Index e : {edge(a, b), edge(a, c), edge(b, c)}) {
      has[e] = 1;
      if (!single_contact[face_of_triangle_[t]]) doomed.edges[e] = 0;
    }
  }
  for (Index e = 0; e < complex_.edges.size(); ++e) {
    if (!has[e]) doomed.edges[e] = 0;
    if (doomed.edges[e]) continue;
    for (const Index v : complex_.edges[e]) doomed.vertices[v] = 0;
  }
  const std::size_t before = complex_.triangles.size();
  collapse(complex_, doomed, std::vector<double>(complex_.size(), 0));
  complex_.complete();  // the triangles are in the order of the faces of the axis
  report_.single_contact_triangles = static_cast<Index>(before - complex_.triangles.size());
}

BorderOptions Refiner::border_options() const {
  return {.level = level_,
          .tolerance = options_.tolerance * diagonal_,
          .spacing = std::sqrt(surface_.report().area / sampling_.size()),
          .merging = kMerging * level_,
          .features = &features_};
}

void Refiner::reach_edges() {
  const BorderOptions border = border_options();
  for (int pass = 0; pass < kBorderPasses; ++pass) {
    const Index seams = extend_to_seams(surface_, complex_, border);
    Index reached = extend_to_edges(surface_, complex_, border);
    reached += divide_at_corners(surface_, complex_, border);
    report_.filling_triangles += seams + fill_along_edges(surface_, complex_, border);
    reached += extend_to_corners(surface_, complex_, border);
    if (seams == 0 && reached == 0) break;
  }
  BallSolver solver = this->solver();
  report_.filling_triangles += fill_notches(surface_, complex_, solver, border, split_options(), kNotches);
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
  return reach_open_places(surface_, complex_, solver, reconstruction, places, left_open() / kOpenLoss,
                           border_options(), split_options());
}

// Extends sheets to places that the balls leave open by more than borders may, then to deep dents between balls. Added
// cells are divided, too. Returns whether any were added.
bool Refiner::reach() {
  report_.degenerate += drop_degenerate(complex_, kCoincident * diagonal_);
  report_.small_pieces += drop_small_pieces(complex_, &guard_);
  split_errors_ = {};
  const BorderOptions border = border_options();
  const double spacing = border.spacing, limit = left_open(), apart = kApart * spacing;
  UncoveredSearch open(surface_, limit, kResolution * spacing, kDetail * limit);
  DentsBelow dents(surface_, limit, kDentWidth * limit);
  BallSolver solver = this->solver();
  Reconstruction reconstruction(complex_.mesh());
  const Index before = report_.reached_places;
  int dent_rounds = 0;
  for (int round = 0; round < options_.reach_rounds; ++round) {
    if (round > 0) reconstruction.change(complex_.mesh());
    const std::vector<UncoveredPlace> places = open.find(reconstruction, apart);
    for (const UncoveredPlace& place : places) places_.push_back(place.position);
    Index reached = reach_for(reconstruction, places, solver);
    if (reached == 0 && dent_rounds++ < kDentRounds)
      reached = reach_for(reconstruction, dents.find(reconstruction, apart), solver);
    if (reached == 0) break;
    report_.reached_places += reached;
    report_.filling_triangles += fill_notches(surface_, complex_, solver, border, split_options(), kNotches);
    divide();
  }
  return report_.reached_places > before;
}

RefinedAxis Refiner::result() {
  RefinedAxis refined;
  refined.axis = axis_of_balls(surface_, complex_);
  refined.axis.stems = axis_.stems;
  refined.axis.bridges = axis_.bridges;
  refined.axis.left_out = axis_.left_out;
  refined.features = features_.edges();
  report_.edge_vertices = static_cast<Index>(std::count_if(complex_.balls.begin(), complex_.balls.end(),
                                                           [](const ExactBall& ball) { return ball.radius == 0; }));
  report_.vertices = refined.axis.size();
  report_.inexact = static_cast<Index>(
      std::count_if(complex_.balls.begin(), complex_.balls.end(), [](const ExactBall& ball) { return !ball.exact; }));
  report_.border_length = border_length(medial_mesh(refined.axis)) / diagonal_;
  refined.report = report_;
  return refined;
}

}  // namespace orchard::detail
