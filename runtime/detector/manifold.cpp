#include "collision/solid_contacts.h"
#include "detector/detector_state.h"

namespace orchard::runtime {

using detail::PartPair;

namespace {

// Returns the contacts of two shapes with trees. Boxes are solid, as they are for answers, and as large as their trees
// store them, which is rounded up to floats. If the solid were smaller, a corner of the other shape could be outside of
// it and not yet meet a triangle of the box. A shape that is wholly inside a box is in contact with it.
Manifold tree_contacts(Workspace& workspace, const PartPair& pair, const ContactOptions& with) noexcept {
  const detail::Shape &a = *pair.a.shape, &b = *pair.b.shape;
  std::array<detail::SolidBox, 2> boxes{};
  std::size_t count = 0;
  if (a.kind == detail::ShapeKind::box) boxes[count++] = {true, a.box_high, b.pieces};
  if (b.kind == detail::ShapeKind::box) boxes[count++] = {false, b.box_high, a.pieces};
  return detail::contacts_of_solids(workspace, TreePair(a.prepared, b.prepared), pair.a.pose(), pair.b.pose(), with,
                                    std::span(boxes.data(), count));
}

}  // namespace

// Uses the poses of the last step, which are still known.
Manifold Detector::State::manifold(const PairEvent& event, const ContactOptions& with) noexcept {
  Manifold result;
  if (event.verdict.answer != Answer::yes || !contains(event.a) || !contains(event.b) ||
      scheduler.workspace() == nullptr) {
    return result;
  }
  const detail::ShapePlacements& places = world.places;
  if (event.part_a >= places.parts(event.a.index) || event.part_b >= places.parts(event.b.index)) return result;
  PartPair pair;
  places.place(event.a.index, event.part_a, pair.a);
  places.place(event.b.index, event.part_b, pair.b);
  const bool half = pair.with_half_space();
  Workspace& workspace = *scheduler.workspace();
  if (!pair.simple()) {
    result = tree_contacts(workspace, pair, with);
    if (result.answer == Answer::yes) return result;
  }
  std::uint64_t work = 0;
  const Verdict verdict = detail::answer_exactly(query_of(workspace.narrow), pair, work);
  result.answer = verdict.answer;
  if (verdict.answer != Answer::yes) return result;
  result.count = 1;
  result.points[0] = {verdict.contact.center, verdict.contact.triangle_a, verdict.contact.triangle_b, 0};
  result.normal = verdict.contact.normal;
  if (half) {
    detail::half_space_contact(*pair.a.shape, pair.a.pose(), pair.b.shape->half, result);
  } else if (pair.simple()) {
    result.depth = detail::simple_depth(*pair.a.shape, pair.a.pose(), *pair.b.shape, pair.b.pose(), result.normal);
  } else {  // there is not enough memory for the contacts
    result.complete = false;
  }
  if (!half) result.points[0].depth = result.depth;
  return result;
}

Manifold Detector::manifold(const PairEvent& event, const ContactOptions& options) noexcept {
  return state_->stepping ? Manifold{} : state_->manifold(event, options);
}

}  // namespace orchard::runtime
