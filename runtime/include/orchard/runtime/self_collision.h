#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "orchard/runtime/collide.h"

// Finds whether a robot touches itself or its surroundings.
namespace orchard::runtime {

// Tests all pairs of parts that must not touch. Each part has a number and a tree.
class SelfCollision {
 public:
  // The trees must outlive this object. Throws std::bad_alloc only.
  explicit SelfCollision(std::span<const PreparedTree> parts)
      : parts_(parts), allowed_(parts.size() * parts.size(), false) {}

  // Sets whether two parts may touch. Allowed pairs are not tested; at first, there are none.
  void allow(std::size_t a, std::size_t b, bool allowed = true) noexcept {
    allowed_[a * parts_.size() + b] = allowed_[b * parts_.size() + a] = allowed;
  }
  bool allows(std::size_t a, std::size_t b) const noexcept { return allowed_[a * parts_.size() + b]; }
  // Allows all pairs that touch or might touch at the given poses, which are those that always touch at rest.
  void allow_touching(Workspace& workspace, std::span<const Pose> poses) noexcept;

  // The contact of two parts.
  struct Touch {
    // yes: these parts touch. maybe: some pair is undecided, and no other one touches.
    Answer answer = Answer::no;
    std::size_t part_a = 0, part_b = 0;
    Contact contact;
  };
  // Returns the first pair of parts, in order, that touches without being allowed to. There must be a pose for each
  // part.
  Touch first(Workspace& workspace, std::span<const Pose> poses) const noexcept;
  // Calls found(touch) for all of these pairs, until it returns false. `Found` is a callable that throws nothing.
  template <typename Found>
  void each(Workspace& workspace, std::span<const Pose> poses, Found&& found) const noexcept {
    for (std::size_t a = 0; a < parts_.size(); ++a) {
      for (std::size_t b = a + 1; b < parts_.size(); ++b) {
        if (allows(a, b)) continue;
        const Verdict verdict = collide(workspace, TreePair(parts_[a], parts_[b]), poses[a], poses[b]);
        if (verdict.answer != Answer::no && !found(Touch{verdict.answer, a, b, verdict.contact})) return;
      }
    }
  }

 private:
  std::span<const PreparedTree> parts_;
  std::vector<bool> allowed_;
};

}  // namespace orchard::runtime
