#pragma once
#include "body_pool.h"
#include "box_lattice.h"

namespace orchard::runtime::detail {

// The boxes of a few bodies in a list: each is compared with all others, sixteen at once. Up to a hundred bodies or two
// that takes less time than finding cells.
class BoxList {
 public:
  static constexpr std::size_t kMaxBodies = 192;

  void reset(std::size_t slots);  // empties the list; bodies are below
  void grow(std::size_t slots);   // keeps what is in it
  void release() { give_back(groups_); }
  // Adds bodies[i] with block's box i and appends the pairs whose boxes meet, of each of them and everything in before.
  void insert(std::span<const BodyIndex> bodies, const BoxBlock& block, bool vectors, std::vector<BodyPair>& pairs);
  void append_meeting(const QuantumBox& box, std::vector<BodyIndex>& bodies) const;  // those whose boxes meet it
  void remove(BodyIndex body) noexcept { set(body, kNowhere); }
  std::size_t slots() const noexcept { return kGroup * groups_.size(); }
  std::size_t memory_bytes() const noexcept { return bytes_of(groups_); }

 private:
  static constexpr std::size_t kGroup = 16;
  // Meets nothing: its lower ends lie above, and its upper ends below, all others.
  static constexpr QuantumBox kNowhere = {{kLastQuantum, kLastQuantum, kLastQuantum}, {~0u, ~0u, ~0u}};
  struct Group {
    std::array<std::array<std::uint32_t, kGroup>, 3> lower, upper;
  };
  struct PlainLanes;
  struct HalvesLanes;
  struct VectorLanes;

  void set(BodyIndex body, const QuantumBox& box) noexcept;
  template <typename Lanes>
  void insert_all(std::span<const BodyIndex> bodies, const BoxBlock& block, std::vector<BodyPair>& pairs);
  void insert_plain(std::span<const BodyIndex> bodies, const BoxBlock& block, std::vector<BodyPair>& pairs);
  void insert_vectors(std::span<const BodyIndex> bodies, const BoxBlock& block, std::vector<BodyPair>& pairs);

  std::vector<Group> groups_;
  std::size_t filled_ = 0;  // bodies are below
};

}  // namespace orchard::runtime::detail
