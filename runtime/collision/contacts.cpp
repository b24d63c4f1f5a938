#include "orchard/runtime/contacts.h"

#include <algorithm>
#include <cmath>

#include "collision/minimum_translation.h"
#include "collision/outermost_points.h"
#include "collision/pair_query.h"
#include "collision/solid_contacts.h"
#include "collision/triangle_cut.h"
#include "collision/workspace_scratch.h"
#include "math/vector_functions.h"
#include "tree/principal_axes.h"

namespace orchard::runtime {

using detail::along;
using detail::cross;
using detail::kSameLine;
using detail::MinimumTranslation;
using detail::MinimumTranslationSearch;
using detail::minus;
using detail::PlacedPair;
using detail::SolidBox;
using detail::unit_or_zero;

namespace {

using Cut = Workspace::Scratch::Cut;

struct PosePair {
  Pose a, b;
};

// Finds all pairs of triangles that meet, and stores the first kCuts of them in scratch.cuts. Returns the number of
// all.
std::size_t find_cuts(const PlacedPair& pair, Workspace::Scratch& scratch) noexcept {
  std::size_t found = 0;
  detail::walk_candidates(
      pair, scratch.walk,
      [&](const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows, std::uint32_t row) {
        const detail::TrianglePoints a = detail::points_of(lanes, lane),
                                     b = detail::moved_points_of(rows, row, pair.relative);
        Vec3 witness{};
        if (!detail::triangles_intersect(a, b, &witness)) return false;
        ++found;
        if (found > Workspace::Scratch::kCuts) return false;
        const std::array<detail::ShiftPlanes, 2> faces = detail::face_planes(a, b);
        const detail::Segment3 common = detail::common_segment(a, b, faces, witness);
        scratch.cuts[found - 1] = {a, b, faces, common.p, common.q, lanes.triangle[lane], rows.triangle[row]};
        return false;
      });
  scratch.cut_count = std::min(found, Workspace::Scratch::kCuts);
  return found;
}

// Returns the direction in which, judging by the normals of the triangles that meet, the second body has to move to
// leave the first one: the mean of the first triangle's normal less the second one's. Each pair has the weight `least`
// plus the length of the common segment. Returns 0 if the normals cancel out up to rounding.
Vec3 facing(std::span<const Cut> cuts, double least) noexcept {
  constexpr double kLeastFacing = 1e-6;  // relative to the sum of the weights
  Vec3 sum{};
  double weights = 0;
  for (const Cut& cut : cuts) {
    const double weight = length(minus(cut.q, cut.p)) + least;
    sum = sum + weight * (cut.faces[0].normal - cut.faces[1].normal);
    weights += weight;
  }
  return length(sum) > kLeastFacing * weights ? unit_or_zero(sum) : Vec3{};
}

// Returns the normal of the plane near which the curves of contact lie: the direction in which they extend least.
// Returns 0 if they lie on a line.
Vec3 flattest(std::span<const Cut> cuts) noexcept {
  Vec3 mean{};
  double sum = 0;
  for (const Cut& cut : cuts) {
    const double weight = length(minus(cut.q, cut.p));
    mean = along(along(mean, cut.p, weight / 2), cut.q, weight / 2);
    sum += weight;
  }
  if (!(sum > 0)) return {};
  mean = along({0, 0, 0}, mean, 1 / sum);
  std::array<double, 6> m{};
  for (const Cut& cut : cuts) {
    const double weight = length(minus(cut.q, cut.p)) / sum;
    for (const Vec3& p : {cut.p, cut.q}) {
      const Vec3 d = minus(p, mean);
      m[0] += weight * d[0] * d[0], m[1] += weight * d[1] * d[1], m[2] += weight * d[2] * d[2];
      m[3] += weight * d[0] * d[1], m[4] += weight * d[0] * d[2], m[5] += weight * d[1] * d[2];
    }
  }
  const double largest = std::max({m[0], m[1], m[2]});
  if (!(largest > 0)) return {};
  for (double& entry : m) entry /= largest;
  const std::array<Vec3, 3> axes = detail::axes_of(m);
  const auto spread = [&m](const Vec3& u) {
    return m[0] * u[0] * u[0] + m[1] * u[1] * u[1] + m[2] * u[2] * u[2] +
           2 * (m[3] * u[0] * u[1] + m[4] * u[0] * u[2] + m[5] * u[1] * u[2]);
  };
  return spread(axes[1]) > kSameLine ? unit_or_zero(axes[2]) : Vec3{};
}

struct Directions {
  std::array<Vec3, 15> some{};
  std::size_t count = 0;
  void add(const Vec3& direction) noexcept { some[count++] = direction; }
  std::span<const Vec3> all() const noexcept { return {some.data(), count}; }
};

// Collects the directions from which the search starts. The first one is the best guess; it is the direction of the
// result if no depth is asked for.
void first_directions(const MinimumTranslationSearch& search, Directions& directions) noexcept {
  const std::span<const Cut> cuts = search.cuts;
  const Vec3 by_normals = facing(cuts, 1e-9 * search.size), by_plane = flattest(cuts);
  if (length(by_normals) > 0) directions.add(by_normals);
  if (length(by_plane) > 0) {
    const bool same_side = dot(by_plane, by_normals) >= 0;
    directions.add(same_side ? by_plane : -by_plane);
  }
  // If the normals cancel out, which those of open surfaces may, the shortest way may lead to either side.
  if (directions.count < 2 || std::fabs(dot(by_plane, by_normals)) < 0.3) {
    directions.add(directions.count > 0 ? -directions.some[directions.count - 1] : Vec3{0, 0, 1});
  }
  if (!cuts.empty()) return;
  for (const SolidBox& solid : search.solids) {  // the normals of the box's faces
    for (std::size_t i = 0; i < 6; ++i) {
      Vec3 face{};
      face[i / 2] = i % 2 == 0 ? 1 : -1;
      directions.add(solid.is_first ? face : rotate(search.pair.relative, face));
    }
  }
}

// Returns the nudge for the search: a fraction of the bodies' size, plus the rounding of poses that are converted to
// the first tree's frame and back.
double least_nudge(const PlacedTrees& trees, double size) noexcept {
  const double places =
      detail::one_norm(trees.first_pose().translation) + detail::one_norm(trees.second_pose().translation);
  return 1e-12 * size + 2e-15 * places / trees.first_pose().scale;
}

// If the surfaces do not meet: sets the only contact point to a point of one body that is inside the other one, a solid
// box. Returns false if there is no such point.
bool add_piece_inside(const MinimumTranslationSearch& search, const Pose& world, Manifold& manifold) noexcept {
  const PreparedTree &first = search.pair.first, &second = search.pair.second;
  for (const SolidBox& solid : search.solids) {
    const Vec3* const piece = detail::piece_inside(search, solid);
    if (piece == nullptr) continue;
    const Vec3 local =
        solid.is_first
            ? Vec3(along(transform(search.pair.relative, minus(*piece, second.tree.origin)), first.tree.origin, 1))
            : Vec3(*piece);
    manifold.count = 1;
    manifold.points[0].place = transform(world, local);
    return true;
  }
  return false;
}

// Adds up to four ends of common segments as contact points: the outermost ones, as seen along the normal.
void add_points(std::span<const Cut> cuts, const PlacedPair& pair, const Vec3& normal, const Pose& world,
                bool exchanged, Manifold& manifold) noexcept {
  const auto end = [&cuts](std::size_t i) { return i % 2 == 0 ? cuts[i / 2].p : cuts[i / 2].q; };
  std::array<std::size_t, kMaxContactPoints> chosen{};
  manifold.count = detail::outermost_points(
      [&, way = detail::Way(normal)](auto&& visit) {
        for (std::size_t i = 0; i < 2 * cuts.size(); ++i) {
          const Vec3 p = minus(end(i), cuts[0].p);
          visit({dot(way.e, p), dot(way.f, p)}, i);
        }
      },
      chosen);
  for (std::uint32_t i = 0; i < manifold.count; ++i) {
    const Cut& cut = cuts[chosen[i] / 2];
    manifold.points[i] = {transform(world, along(end(chosen[i]), pair.first.tree.origin, 1)),
                          exchanged ? cut.triangle_second : cut.triangle_first,
                          exchanged ? cut.triangle_first : cut.triangle_second, 0};
  }
}

// Sets the depth of each contact point: how far the second one of its two triangles has to move along the normal until
// they are apart, at most `most`. `normal` is in the first tree's frame; `scale` converts lengths of this frame to
// world units, in which depths and `most` are.
void add_depths(const PlacedPair& pair, const Vec3& normal, bool exchanged, double most, double scale,
                Manifold& manifold) noexcept {
  for (std::uint32_t i = 0; i < manifold.count; ++i) {
    ContactPoint& point = manifold.points[i];
    const std::uint32_t first = exchanged ? point.triangle_b : point.triangle_a;
    const std::uint32_t second = exchanged ? point.triangle_a : point.triangle_b;
    const detail::TrianglePoints of_first = detail::points_of(pair.first.tree, first),
                                 of_second = detail::points_of(pair.second.tree, second);
    double high = -std::numeric_limits<double>::infinity(), low = -high;
    for (std::size_t k = 0; k < 3; ++k) {
      high = std::max(high, dot(normal, of_first[k]));
      low = std::min(low, dot(normal, transform(pair.relative, of_second[k])));
    }
    point.depth = std::clamp(scale * (high - low), 0.0, most);
  }
}

// If the surfaces do not meet, but are nearer than `margin`: adds a contact point halfway between their nearest points.
// Its depth is the negative distance.
void add_point_before(Workspace& workspace, const TreePair& pair, const PosePair& poses, double margin,
                      Manifold& manifold) noexcept {
  const Closeness near = closer_with_points(workspace, pair, poses.a, poses.b, margin);
  const double apart = near.distance.upper;
  if (near.answer != Answer::yes || !(apart > 0)) return;
  const Vec3 way = minus(near.distance.points.on_b, near.distance.points.on_a);
  if (!(length(way) > 0)) return;  // the distance is below the rounding error
  manifold.count = 1;
  manifold.points[0] = {along(near.distance.points.on_a, way, 0.5), near.distance.points.triangle_a,
                        near.distance.points.triangle_b, -apart};
  manifold.normal = unit_or_zero(way);
  manifold.depth = -apart;
  manifold.error = apart - near.distance.lower;
}

// If the translation ends close to triangles, for example of faces that slide along each other, rounding may make them
// touch once the body is placed in the world. So the depth is increased until collide() no longer answers "yes" for the
// body moved by it.
void lengthen_until_free(Workspace& workspace, const TreePair& pair, const PosePair& poses, double step,
                         Manifold& manifold) noexcept {
  constexpr int kMaxSteps = 64;
  for (int i = 0; i < kMaxSteps; ++i) {
    Pose moved = poses.b;
    moved.translation = along(poses.b.translation, manifold.normal, manifold.depth);
    if (collide(workspace, pair, poses.a, moved).answer != Answer::yes) return;
    manifold.depth += step;
    step *= 2;
  }
}

// Returns the work that the search for the shortest translation may do: `effort` times the work `found` that it took to
// find the triangles that meet. An effort below 0, or one that is not a number, counts as 0.
std::uint64_t search_work(double effort, double found) noexcept {
  constexpr double kLeast = 400, kMost = 1e18;  // kLeast is for bodies of few triangles
  const double work = effort * std::max(found, 1.0);
  if (!(work > kLeast)) return static_cast<std::uint64_t>(kLeast);
  return static_cast<std::uint64_t>(std::min(work, kMost));
}

// Answers by the levels of spheres: for trees without triangles, for poses that are refused, and if there is no memory.
Manifold by_spheres(PairQuery& narrow) noexcept {
  while (!narrow.finished()) narrow.refine();
  Manifold result;
  result.answer = narrow.known().answer;
  if (result.answer == Answer::no || narrow.known().refused) return result;
  const Contact contact = narrow.contact();
  result.count = 1;
  result.points[0] = {contact.center, contact.triangle_a, contact.triangle_b, 0};
  result.normal = contact.normal;
  result.error = contact.radius;
  return result;
}

}  // namespace

namespace detail {

Manifold contacts_of_solids(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                            const ContactOptions& options, std::span<const SolidBox> boxes) noexcept {
  Manifold result;
  PairQuery& narrow = query_of(workspace.narrow);
  narrow.bind(pair.a(), pair.b());
  PlacedTrees& trees = narrow.trees();
  if (narrow.start(a, b) == Answer::no) {
    result.answer = Answer::no;
    return result;
  }
  Workspace::Scratch* const scratch = workspace.scratch();
  if (narrow.known().refused || !have_triangles(trees) || scratch == nullptr ||
      !scratch->walk.stack.reserve(pair.a().tree, pair.b().tree)) {
    return by_spheres(narrow);
  }
  trees.place();
  const PlacedPair both{trees.first(), trees.second(), trees.relative(), trees.placement()};
  const std::uint64_t before = scratch->walk.work;
  find_cuts(both, *scratch);
  const double found = static_cast<double>(scratch->walk.work - before);
  const std::span<const Cut> cuts(scratch->cuts.data(), scratch->cut_count);
  const Pose& world = trees.first_pose();
  const bool exchanged = trees.exchanged();
  std::array<SolidBox, 2> solids{};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    solids[i] = boxes[i];
    if (exchanged) solids[i].is_first = !solids[i].is_first;
  }
  const double size = both.first.extent + both.second.extent * both.relative.scale;
  const MinimumTranslationSearch search{both,
                                        scratch->walk,
                                        cuts,
                                        std::span(solids.data(), boxes.size()),
                                        size,
                                        least_nudge(trees, size),
                                        scratch->walk.work + search_work(options.effort, found)};
  if (cuts.empty() && !add_piece_inside(search, world, result)) {
    result.answer = Answer::no;
    return result;
  }
  result.answer = Answer::yes;
  Directions directions;
  first_directions(search, directions);
  MinimumTranslation out{directions.some[0], 0, directions.some[0], true};
  if (options.depth) out = minimum_translation(search, directions.all(), options.refinements);
  result.complete = out.ended;
  result.depth = out.way * world.scale;
  result.normal = rotate(world, exchanged ? -out.direction : out.direction);
  result.error = trees.exact_error();
  if (!cuts.empty()) add_points(cuts, both, out.direction, world, exchanged, result);
  if (options.depth && !out.clear) lengthen_until_free(workspace, pair, {a, b}, search.nudge * world.scale, result);
  if (!cuts.empty()) add_depths(both, out.direction, exchanged, result.depth, world.scale, result);
  return result;
}

}  // namespace detail

Manifold contacts(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                  const ContactOptions& options) noexcept {
  Manifold result = detail::contacts_of_solids(workspace, pair, a, b, options, {});
  if (result.answer == Answer::no && options.margin > 0) {
    add_point_before(workspace, pair, {a, b}, options.margin, result);
  }
  return result;
}

SignedDistance signed_distance(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                               double relative_tolerance) noexcept {
  SignedDistance result;
  const Distance apart = distance(workspace, pair, a, b, {.relative = relative_tolerance, .absolute = 0});
  if (apart.lower > 0 || apart.points.triangle_a == kNoTriangle) {
    result = {apart.lower, apart.upper, apart.points.on_a, apart.points.on_b, {}};
    result.normal = unit_or_zero(minus(result.on_b, result.on_a));
    return result;
  }
  const Manifold manifold = contacts(workspace, pair, a, b);
  if (manifold.answer != Answer::yes) {  // the distance is below the rounding error
    return {0, apart.upper, apart.points.on_a, apart.points.on_b,
            unit_or_zero(minus(apart.points.on_b, apart.points.on_a))};
  }
  result.lower = result.upper = -manifold.depth;
  result.on_a = result.on_b = manifold.points[0].place;
  result.normal = manifold.normal;
  return result;
}

}  // namespace orchard::runtime
