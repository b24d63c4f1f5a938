#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "orchard/runtime/collide.h"

// Does a robot touch itself, or what stands around it? Numbered parts, a tree each; pairs that may touch are not asked
// about.
namespace orchard::runtime {

// Which pairs of parts 0 .. parts - 1 may touch: none at first, and every part itself.
class AllowedPairs {
 public:
  explicit AllowedPairs(std::size_t parts = 0) : parts_(parts), allowed_(parts * parts, false) {}  // throws bad_alloc

  std::size_t parts() const noexcept { return parts_; }
  void allow(std::size_t a, std::size_t b, bool allowed = true) noexcept {
    allowed_[a * parts_ + b] = allowed_[b * parts_ + a] = allowed;
  }
  void allow_all_of(std::size_t part) noexcept {
    for (std::size_t other = 0; other < parts_; ++other) allow(part, other);
  }
  bool allowed(std::size_t a, std::size_t b) const noexcept { return a == b || allowed_[a * parts_ + b]; }

 private:
  std::size_t parts_;
  std::vector<bool> allowed_;
};

class SelfCollision {
 public:
  // The trees outlive this object. Throws std::bad_alloc only.
  explicit SelfCollision(std::span<const PreparedTree> parts) : allowed(parts.size()), parts_(parts) {}

  AllowedPairs allowed;

  // Allows the pairs that touch, or might, where the parts are now: those that always do at rest.
  void allow_touching(Workspace& workspace, std::span<const Pose> poses) noexcept;

  struct Touch {
    Answer answer = Answer::no;  // yes: these parts touch; maybe: nothing is known of some pair, and no other touches
    std::size_t part_a = 0, part_b = 0;
    Contact contact;
  };
  // The first pair of parts, in order, that touch though they are not allowed to. poses.size(): a pose for every part.
  Touch first(Workspace& workspace, std::span<const Pose> poses) const noexcept;
  // All of them: found(touch) for each, until it returns false. `Found`: a callable that throws nothing.
  template <typename Found>
  void each(Workspace& workspace, std::span<const Pose> poses, Found&& found) const noexcept {
    for (std::size_t a = 0; a < parts_.size(); ++a) {
      for (std::size_t b = a + 1; b < parts_.size(); ++b) {
        if (allowed.allowed(a, b)) continue;
        const Verdict verdict = collide(workspace, TreePair(parts_[a], parts_[b]), poses[a], poses[b]);
        if (verdict.answer != Answer::no && !found(Touch{verdict.answer, a, b, verdict.contact})) return;
      }
    }
  }

 private:
  std::span<const PreparedTree> parts_;
};

}  // namespace orchard::runtime
