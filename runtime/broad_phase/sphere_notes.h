#pragma once
#include "broad_phase/body_pool.h"
#include "broad_phase/quantized_grid.h"

namespace orchard::runtime::detail {

// The spheres of bodies at the last update of all windows. They are kept in worlds in which many pairs are near: most
// of these pairs need no other test.
class SphereNotes {
 public:
  explicit SphereNotes(double position_slack) noexcept : slack_(position_slack) {}

  void begin(bool wanted, std::size_t slots);  // before an update of all windows; earlier notes become void
  void release() noexcept { give_back(spheres_); }
  void make_room(std::size_t slots) {
    if (any()) grow(spheres_, slots);
  }
  bool any() const noexcept { return !spheres_.empty(); }
  // Stores the sphere of a body, relative to the quantized grid. `duration` is how long its window lasts, in seconds.
  void note(BodyIndex body, const Motion& motion, const QuantizedGrid& quantized_grid, double duration) noexcept;

  enum class Answer : std::uint8_t { unknown, apart, touching };
  // Returns whether two bodies certainly touch, or certainly do not, from now until the first of their windows ends;
  // with `now_only`, whether they do at this step. Precondition: both have been noted.
  Answer compare(const BodyPair& pair, bool now_only) const noexcept;
  std::size_t memory_bytes() const noexcept { return bytes_of(spheres_); }

 private:
  struct Sphere {                 // in floats, in a third of the memory that a motion takes for this
    std::array<float, 3> center;  // relative to the origin of the quantized grid
    float radius, reach;          // reach: how far the centre may move until the body's window ends, and all slack
  };
  double slack_;
  std::vector<Sphere> spheres_;  // by body; empty unless many pairs are near
};

}  // namespace orchard::runtime::detail
