#pragma once
#include <utility>
#include <vector>

#include "sheet_mesh.h"

namespace orchard::detail {

// A change that replaces cells of a mesh by others. Unless keep() is called, the destructor restores everything,
// including the numbers of cells.
class MeshChange {
 public:
  // Removes the old cells.
  MeshChange(SheetMesh& mesh, std::vector<Index> old) : mesh_(mesh), old_(std::move(old)), first_(mesh.cells()) {
    for (const Index c : old_) gone_.push_back(mesh.corners(c));
    for (const Index c : old_) mesh.remove(c);
  }
  MeshChange(const MeshChange&) = delete;
  MeshChange& operator=(const MeshChange&) = delete;
  ~MeshChange() {
    if (kept_) return;
    mesh_.take_back(first_);
    if (moved_ != kNone) mesh_.set_ball(moved_, ball_before_);
    for (std::size_t i = 0; i < gone_.size(); ++i) mesh_.put_back(old_[i], gone_[i]);
  }

  // Changes the ball of a vertex. May be called only once.
  void set_ball(Index v, const ExactBall& ball) {
    ball_before_ = mesh_.ball(v);
    moved_ = v;
    mesh_.set_ball(v, ball);
  }
  const std::vector<Index>& old() const { return old_; }
  const std::vector<SheetMesh::Cell>& gone() const { return gone_; }  // the corners of the old cells
  Index first_made() const { return first_; }
  // The cells that were added since then and are still there.
  std::vector<Index> made() const {
    std::vector<Index> cells;
    for (Index c = first_; c < mesh_.cells(); ++c) {
      if (mesh_.alive(c)) cells.push_back(c);
    }
    return cells;
  }
  void keep() { kept_ = true; }

 private:
  SheetMesh& mesh_;
  std::vector<Index> old_;
  std::vector<SheetMesh::Cell> gone_;
  const Index first_;
  Index moved_ = kNone;
  ExactBall ball_before_;
  bool kept_ = false;
};

}  // namespace orchard::detail
