#pragma once
#include "broad_phase/body_pool.h"
#include "broad_phase/quantized_grid.h"

namespace orchard::runtime::detail {

// The spheres of bodies at the last update of all windows, for worlds in which many pairs are near: most of them need
// no other test.
class SphereNotes {
 public:
  explicit SphereNotes(double position_slack) noexcept : slack_(position_slack) {}

  void begin(bool wanted, std::size_t slots);  // all windows are updated; notes of before are void
  void release() noexcept { give_back(spheres_); }
  void make_room(std::size_t slots) {
    if (any()) grow(spheres_, slots);
  }
  bool any() const noexcept { return !spheres_.empty(); }
  // Relative to the quantized grid, like that of every other body; `duration`: of its window.
  void note(BodyIndex body, const Motion& motion, const QuantizedGrid& quantized_grid, double duration) noexcept;

  enum class Answer : std::uint8_t { unknown, apart, touching };
  // Of two bodies noted: whether they surely touch, or surely do not, until their windows end, or `now_only`.
  Answer compare(const BodyPair& pair, bool now_only) const noexcept;
  std::size_t memory_bytes() const noexcept { return bytes_of(spheres_); }

 private:
  struct Sphere {                 // in a third of the memory of a motion's part, and off by its rounding
    std::array<float, 3> center;  // from the quantized grid's origin
    float radius, reach;          // reach: as far as the centre may get until the body's window ends, and all slack
  };
  double slack_;
  std::vector<Sphere> spheres_;  // by body; empty unless many pairs are near
};

}  // namespace orchard::runtime::detail
