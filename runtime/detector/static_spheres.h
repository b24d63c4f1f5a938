#pragma once
#include "detector/bodies.h"

namespace orchard::runtime::detail {

// The spheres of static bodies' parts, for queries at each step: which of them does another sphere touch: groups of
// neighbours in boxes. What changes is added at the end, and all is sorted again once that is
// much.
class StaticSpheres {
 public:
  // Where the body is from now on; anywhere else it is no more.
  void put(BodyIndex body, std::span<const FloatSphere> spheres);
  void take_away(BodyIndex body) noexcept;
  // Before append_touching(), if anything has changed. O(n log n) once a part of n spheres is new or gone.
  void prepare();
  // The bodies of spheres that touch it; one may come up for each of its spheres. O(n / 32), and the groups in its
  // reach.
  void append_touching(const FloatSphere& sphere, std::vector<BodyIndex>& bodies) const;
  std::size_t size() const noexcept { return spheres_.size(); }  // and some that are gone
  std::size_t memory_bytes() const noexcept;

 private:
  static constexpr std::size_t kGroup = 32;
  struct Sphere {
    FloatSphere at;
    BodyIndex body;
    std::uint32_t version;
  };
  struct Place {  // of a body: only spheres of this version are its own
    std::uint32_t version = 0, spheres = 0;
  };
  struct Box {
    std::array<float, 3> low, high;
  };
  // Coordinate by coordinate, so that a group is compared by vectors. Lanes that hold nothing are not numbers, which
  // touch nothing.
  struct SphereGroup {
    std::array<std::array<float, kGroup>, 4> at;  // x, y, z, radius
    std::array<BodyIndex, kGroup> body;
    std::array<std::uint32_t, kGroup> version;
  };
  struct BoxGroup {
    std::array<std::array<float, kGroup>, 3> low, high;
  };
  static Box box_around(const FloatSphere& sphere) noexcept;
  static void split(std::span<Sphere> spheres);
  bool is_there(BodyIndex body, std::uint32_t version) const noexcept { return places_[body].version == version; }
  void sort();
  void enter(std::size_t place);
  // Lanes, as bits: whose boxes meet this one, whose spheres touch this one.
  static std::uint32_t meeting(const BoxGroup& boxes, const Box& box) noexcept;
  static std::uint32_t touching(const SphereGroup& spheres, const FloatSphere& sphere) noexcept;
  void append_all(const FloatSphere& sphere, std::vector<BodyIndex>& bodies) const;

  std::vector<Place> places_;                        // by body
  std::vector<Sphere> spheres_;                      // in the order of groups
  std::vector<SphereGroup> groups_;                  // of spheres_
  std::vector<BoxGroup> boxes_;                      // around groups_
  std::size_t gone_ = 0, sorted_ = 0, entered_ = 0;  // of spheres_
};

}  // namespace orchard::runtime::detail
