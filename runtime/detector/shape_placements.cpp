#include "detector/shape_placements.h"

#include "collision/pair_query.h"

namespace orchard::runtime::detail {

void ShapePlacements::place_at(const Pose& pose, bool rigid, const PartRecord& part,
                               PlacedPart& placed_part) const noexcept {
  placed_part.shape = &(*shapes_)[part.shape];
  placed_part.there = &pose;
  if (!part.at_origin && rigid) placed_part.move_to(placed(pose, part.local));
  placed_part.rigid = rigid;
}

void ShapePlacements::place(BodyIndex body, std::uint32_t part, PlacedPart& placed_part) const noexcept {
  const Body& of = this->body(body);
  if (is_half_space(body)) {
    placed_part.shape = &halves_->shape(body), placed_part.there = &of.state.pose;
    return;
  }
  const PartRecord& record = of.parts()[part];
  place_at(of.state.pose, of.valid, record, placed_part);
  placed_part.be_in(record.sphere);
}

void ShapePlacements::place_before(BodyIndex body, std::uint32_t part, Step now,
                                   PlacedPart& placed_part) const noexcept {
  if (is_half_space(body)) return place(body, part, placed_part);
  const Body& of = (*bodies_)[body];
  const bool moves = !of.is_static && of.steps.asked == now;  // also for a body that falls asleep at `now`
  const Pose& pose = moves ? of.before : of.state.pose;
  const PartRecord& record = of.parts()[part];
  const bool was_elsewhere = !of.parts_before.empty() && of.parts_before[part].until == now - 1;
  const PartRecord& place = was_elsewhere ? of.parts_before[part].place : record;
  place_at(pose, is_rigid(pose), place, placed_part);
  placed_part.be_in({transform(pose, place.center), place.reach * pose.scale});
}

double ShapePlacements::bounds_gap(BodyIndex body, std::uint32_t part, const BoundingSphere& sphere) const noexcept {
  const Body& of = (*bodies_)[body];
  const PartRecord& record = of.parts()[part];
  if (!of.valid) return 0;
  double scale = 1, size = sphere.size;
  Vec3 at = sphere.center;
  const auto enter = [&](const Pose& frame) {  // transforms `at` into its coordinates
    const Vec3 way = at - Vec3(frame.translation);
    const auto& r = frame.rotation;
    const double shrink = 1 / frame.scale;
    for (std::size_t i = 0; i < 3; ++i) {
      size += scale * std::fabs(frame.translation[i]);
      at[i] = shrink * (r[i] * way[0] + r[3 + i] * way[1] + r[6 + i] * way[2]);
    }
    scale *= frame.scale;
  };
  enter(of.state.pose);
  if (!record.at_origin) enter(record.local);
  const Shape& shape = (*shapes_)[record.shape];
  size += scale * (length(shape.center) + shape.reach);
  const double gap = scale * distance_to_bounds(shape, at) - sphere.reach - kPlaceRounding * size;
  return std::isfinite(gap) ? gap : 0;
}

double ShapePlacements::bounds_gap(const BodyPair& pair, std::uint32_t part_a, std::uint32_t part_b,
                                   const BoundingSphere& a, const BoundingSphere& b) const noexcept {
  const double gap = bounds_gap(pair.a, part_a, b);
  return gap > 0 ? gap : bounds_gap(pair.b, part_b, a);
}

Verdict unasked(const PartPair& pair) noexcept {
  const SphereGap gap = pair.with_half_space() ? sphere_gap(pair.a, pair.b.shape->half) : sphere_gap(pair.a, pair.b);
  Verdict verdict;
  verdict.answer = gap.least > 0 ? Answer::no : Answer::maybe;
  verdict.lower_bound = std::max(0.0, gap.least);
  verdict.separation_bound = gap.most;
  if (verdict.answer == Answer::no) return verdict;
  verdict.contact.center = pair.a.center;
  verdict.contact.radius = pair.a.reach;
  const Vec3 way = pair.with_half_space() ? -1.0 * pair.b.shape->half.normal : pair.b.center - pair.a.center;
  const double size = length(way);
  verdict.contact.normal = size > 0 ? (1 / size) * way : Vec3{0, 0, 1};
  return verdict;
}

void make_solid(Verdict& verdict, const PartPair& pair) noexcept {
  const bool solid = pair.a.shape->kind == ShapeKind::box || pair.b.shape->kind == ShapeKind::box;
  if (solid && verdict.answer == Answer::no &&
      inside_box(*pair.a.shape, pair.a.pose(), *pair.b.shape, pair.b.pose(), verdict.contact)) {
    verdict.answer = Answer::yes;
    verdict.separation_bound = verdict.lower_bound = 0;
  }
}

std::uint32_t nearest_triangle(const Verdict& verdict, const PartPair& pair) noexcept {
  if (verdict.answer != Answer::yes) return kNoTriangle;
  return pair.a.shape->has_tree() ? verdict.contact.triangle_a : verdict.contact.triangle_b;
}

Verdict answer_exactly(PairQuery& narrow, const PartPair& pair, std::uint64_t& work, std::uint64_t most,
                       std::uint32_t guess) noexcept {
  if (!pair.a.rigid || !pair.b.rigid) return unknown_verdict();
  if (pair.simple()) {
    work += kSimplePairWork;
    return test_simple(*pair.a.shape, pair.a.pose(), *pair.b.shape, pair.b.pose(), guess);
  }
  narrow.bind(pair.a.shape->prepared, pair.b.shape->prepared);
  narrow.start(pair.a.pose(), pair.b.pose());
  const bool limited = most != std::numeric_limits<std::uint64_t>::max();
  work += kPairWork;
  if (!limited) {
    while (!narrow.finished()) narrow.refine_exactly();
  } else if (work < most) {
    narrow.refine_exactly({.work = most - work});
  }
  work += narrow.known().work;
  Verdict verdict = narrow.verdict();
  make_solid(verdict, pair);
  return verdict;
}

bool decides(const Verdict& verdict, const Verdict& than) noexcept {
  if (verdict.answer != than.answer) return verdict.answer > than.answer;
  return verdict.separation_bound < than.separation_bound;
}

}  // namespace orchard::runtime::detail
