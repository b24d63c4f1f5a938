#pragma once
#include "scene.h"

namespace orchard::bench {

// An octree of many moving bodies (2.3.2): each lies in all leaves that its box meets; a leaf with more than a few
// bodies is divided, down to cells of about a body's size. It is built again at each step (Moore and Wilhelms 1988), or
// those bodies are moved that left their cells (Shaffer and Herb 1992), and cells that became empty are joined. Of
// spheres, or of isothetic cubes with the radius as half the edge (7.1).
class MovingOctree final : public Rival {
 public:
  enum class Upkeep { rebuilt, updated };
  struct Options {
    Upkeep upkeep = Upkeep::updated;
    bool cubes = false;
  };
  MovingOctree(const std::vector<Vec3>& positions, const std::vector<double>& radii, const Options& options);

  void find(std::vector<BodyPair>& pairs) override;
  std::size_t memory_bytes() const override;

 private:
  struct Range {  // of the smallest cells, all of them inclusive
    std::array<std::uint32_t, 3> first, last;
    bool operator==(const Range&) const = default;
  };
  struct Cell {
    std::uint32_t node;
    std::array<std::uint32_t, 3> corner;
    std::uint32_t edge;  // in smallest cells
  };
  struct Node {
    std::uint32_t children = 0;  // the first of eight; 0: a leaf
    std::vector<BodyIndex> bodies;
  };
  void rebuild();
  bool range_of(BodyIndex body, Range& range) const;  // false: it lies outside of the root
  static bool meets(const Cell& cell, const Range& range);
  Cell child(const Cell& cell, std::uint32_t part) const;
  std::uint32_t eight_nodes();
  void insert(const Cell& cell, BodyIndex body);
  void divide(const Cell& cell);
  void remove(const Cell& cell, BodyIndex body, const Range& range);
  void join(std::uint32_t node);
  void compare(const Cell& cell, std::vector<BodyPair>& pairs) const;
  bool meet(BodyIndex a, BodyIndex b) const;
  Cell root() const { return {0, {0, 0, 0}, 1u << levels_}; }

  const std::vector<Vec3>& positions_;
  const std::vector<double>& radii_;
  const Options options_;
  Vec3 origin_{};
  double per_length_ = 1;
  std::uint32_t levels_ = 0;
  std::vector<Node> nodes_;
  std::size_t used_ = 0;  // nodes
  std::vector<std::uint32_t> free_;
  std::vector<Range> ranges_;
};

}  // namespace orchard::bench
