#include "cell_patches.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace orchard::detail {
namespace {

class PatchFinder {
 public:
  PatchFinder(const Surface& surface, const SurfaceSampling& sampling, const RestrictedVoronoi& restricted)
      : surface_(surface), sampling_(sampling), restricted_(restricted) {
    Index count = 0;
    const Index triangles = static_cast<Index>(surface.mesh().triangles.size());
    for (Index triangle = 0; triangle < triangles; ++triangle) {
      first_.push_back(count);
      count += static_cast<Index>(restricted.pieces(triangle).size());
    }
    first_.push_back(count);
    parents_.resize(count);
    for (Index piece = 0; piece < count; ++piece) parents_[piece] = piece;
    joints_.assign(count, 0);
    joined_.assign(count, 0);
    inner_vertices_.assign(count, 0);
  }

  std::vector<CellPatch> run() {
    join_across_edges();
    count_inner_vertices();
    return gather();
  }

 private:
  Index root(Index piece) {
    while (parents_[piece] != piece) piece = parents_[piece] = parents_[parents_[piece]];
    return piece;
  }
  Index id_of(Index triangle, const CellPiece* piece) const {
    return first_[triangle] + static_cast<Index>(piece - restricted_.pieces(triangle).data());
  }
  // Joints are counted at the piece with the lower triangle.
  void join_across_edges() {
    for (Index triangle = 0; triangle + 1 < first_.size(); ++triangle) {
      for (unsigned edge = 0; edge < 3; ++edge) {
        const Index next = surface_.neighbors(triangle)[edge];
        if (next == kNone || next < triangle) continue;
        const std::uint8_t back = edge_mask_towards(next, triangle);
        for (const CellPiece& piece : restricted_.pieces(triangle)) {
          const CellPiece* other = restricted_.piece(next, piece.cell);
          if (other == nullptr || !((piece.edges >> edge & 1u) || (other->edges & back))) continue;
          const Index a = id_of(triangle, &piece), b = id_of(next, other);
          joined_[a] |= static_cast<std::uint8_t>(1u << edge);
          joined_[b] |= back;
          ++joints_[a];
          const Index low = std::min(root(a), root(b)), high = std::max(root(a), root(b));
          parents_[high] = low;
        }
      }
    }
  }
  std::uint8_t edge_mask_towards(Index triangle, Index neighbor) const {
    std::uint8_t mask = 0;
    for (unsigned edge = 0; edge < 3; ++edge) {
      if (surface_.neighbors(triangle)[edge] == neighbor) mask |= static_cast<std::uint8_t>(1u << edge);
    }
    return mask;
  }
  // A vertex is inside a cell's patch if the pieces around it are joined all the way round. Counted at the first piece.
  void count_inner_vertices() {
    for (Index vertex = 0; vertex < surface_.mesh().vertices.size(); ++vertex) {
      const auto around = surface_.triangles_around(vertex);
      if (around.empty()) continue;
      for (const CellPiece& piece : restricted_.pieces(around[0])) {
        const bool inner = std::all_of(around.begin(), around.end(), [&](Index triangle) {
          const CellPiece* other = restricted_.piece(triangle, piece.cell);
          if (other == nullptr) return false;
          const std::uint8_t spokes = edges_at(triangle, vertex);
          return (joined_[id_of(triangle, other)] & spokes) == spokes;
        });
        if (inner) ++inner_vertices_[id_of(around[0], &piece)];
      }
    }
  }
  std::uint8_t edges_at(Index triangle, Index vertex) const {
    const auto& corners = surface_.mesh().triangles[triangle];
    return corners[0] == vertex ? 0b101 : corners[1] == vertex ? 0b011 : 0b110;
  }

  std::vector<CellPatch> gather() {
    struct Entry {
      Index cell, root, triangle, piece;
      auto operator<=>(const Entry&) const = default;
    };
    std::vector<Entry> entries;
    entries.reserve(parents_.size());
    for (Index triangle = 0; triangle + 1 < first_.size(); ++triangle) {
      for (const CellPiece& piece : restricted_.pieces(triangle)) {
        const Index id = id_of(triangle, &piece);
        entries.push_back({piece.cell, root(id), triangle, id});
      }
    }
    std::sort(entries.begin(), entries.end());
    std::vector<CellPatch> patches;
    Index last_root = kNone;
    for (const Entry& entry : entries) {
      if (patches.empty() || entry.root != last_root || entry.cell != patches.back().cell) {
        patches.emplace_back();
        patches.back().cell = entry.cell;
        last_root = entry.root;
      }
      CellPatch& patch = patches.back();
      patch.triangles.push_back(entry.triangle);
      patch.euler_characteristic += 1 - joints_[entry.piece] + inner_vertices_[entry.piece];
    }
    mark_homes(patches);
    return patches;
  }
  void mark_homes(std::vector<CellPatch>& patches) const {
    std::vector<Index> around;
    Index cell = kNone;
    for (CellPatch& patch : patches) {
      if (patch.cell != cell) {
        cell = patch.cell;
        surface_.triangles_at(sampling_.triangles[cell], sampling_.features[cell], around);
      }
      patch.home = std::any_of(around.begin(), around.end(), [&](Index triangle) {
        return std::binary_search(patch.triangles.begin(), patch.triangles.end(), triangle);
      });
    }
  }

  const Surface& surface_;
  const SurfaceSampling& sampling_;
  const RestrictedVoronoi& restricted_;
  std::vector<Index> first_;                  // piece of each triangle; pieces are numbered triangle by triangle
  std::vector<Index> parents_;                // of each piece
  std::vector<std::uint8_t> joined_;          // bit i: to a piece across the triangle's edge i
  std::vector<int> joints_, inner_vertices_;  // each counted at one piece
};

}  // namespace

std::vector<CellPatch> find_cell_patches(const Surface& surface, const SurfaceSampling& sampling,
                                         const RestrictedVoronoi& restricted) {
  return PatchFinder(surface, sampling, restricted).run();
}

}  // namespace orchard::detail
