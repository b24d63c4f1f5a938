// The builder makes one pass down the tree, and orders the triangles as it divides them. Everything that it measures
// (extents, moments, balls, ball slabs) refers to ranges of this order.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "orchard/runtime/packed_tree.h"
#include "tree/box_fitter.h"
#include "tree/tree_nodes.h"

// The triangle BVH. Triangles are divided in two across a principal direction; nodes have up to eight children, and
// leaves have up to eight triangles. If all leaves fit in one block (a box, a wall, a simple hull), the triangles are
// few, and large compared with what comes near them. Leaves then hold triangles that are flat together; see divide().
namespace orchard::runtime {
namespace {

using detail::as_doubles, detail::cross, detail::minus, detail::stored_above;
using detail::ObbNode, detail::BoxFitter, detail::Extent, detail::Part, detail::Range, detail::Triangle;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const std::array<Vec3, 3> kAxes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

// Below this level, parts are halved by the number of their triangles: 31 more levels are enough for every number, and
// kTriangleTreeDepthLimit is 64.
constexpr std::uint32_t kCostlyDepth = 32;

// A tree of at most so many triangles has room for all of its leaves in one block.
constexpr std::size_t kFew = std::size_t{kBlockWidth} * kBlockWidth;
// If triangles are few, a cut is worth a leaf if the areas of the boxes of both parts, times the numbers of their
// triangles, are less than this fraction of the same for the whole part. With a smaller fraction, cutting would end too
// soon: of the four sides of a box, no single one is worth it.
constexpr double kWorthCutting = 1 - 1e-3;

enum class Cuts {
  principal,  // across principal directions, such that leaves are full
  aligned     // across the coordinates' axes, wherever boxes along them are smallest
};

class Builder {
 public:
  Builder(PackedSphereTree& tree, Cuts cuts) : tree_(tree), cuts_(cuts) {
    order_.resize(tree.triangles.size());
    centroids_.resize(order_.size());
    for (std::size_t t = 0; t < order_.size(); ++t) {
      order_[t].number = static_cast<std::uint32_t>(t);
      Vec3& sum = centroids_[t];
      for (std::size_t k = 0; k < 3; ++k) {
        order_[t].corners[k] = tree.vertices[tree.triangles[t][k]];
        for (std::size_t i = 0; i < 3; ++i) sum[i] += double{order_[t].corners[k][i]} / 3;
      }
    }
    if (is_few()) find_frames();
  }

  void build() {
    tree_.obb_nodes.clear();
    tree_.triangle_blocks.clear();
    tree_.triangle_tree_depth = 0;
    if (order_.empty()) return;
    std::vector<Pending> level = {{fitter_.measured({0, order_.size()}), 0, 0}}, next;
    add_block();
    place(level[0]);
    for (; !level.empty(); ++tree_.triangle_tree_depth) {
      next.clear();
      for (const Pending& node : level) expand(node, next);
      level.swap(next);
    }
    --tree_.triangle_tree_depth;
  }

 private:
  // A node that has no children yet.
  struct Pending {
    Part part;
    std::size_t block;
    std::uint32_t lane;
  };
  // The place of a triangle of a part along an axis. Equal places are ordered by the numbers of their triangles.
  struct PlaceAlong {
    double at;
    std::uint32_t number, from;
    bool operator<(const PlaceAlong& other) const {
      return at < other.at || (!(other.at < at) && number < other.number);
    }
  };
  // A cut of a part. The cheapest cut comes first; among equally cheap ones, the most even one.
  struct Cut {
    double cost = kInfinity;
    std::size_t unevenness = 0, frame = 0, axis = 0, at = 0;
    bool operator<(const Cut& other) const {
      return std::tie(cost, unevenness, frame, axis, at) <
             std::tie(other.cost, other.unevenness, other.frame, other.axis, other.at);
    }
  };
  // A part, and what a cut of it gains; minus infinity if it stays whole.
  struct Piece : Part {
    double worth = -kInfinity;
    Cut cut{};  // if triangles are few
  };

  void add_block() { tree_.obb_nodes.emplace_back().radius.fill(-1); }

  void expand(const Pending& node, std::vector<Pending>& next) {
    const bool divided = node.part.size() > kBlockWidth || (is_few() && tree_.triangle_tree_depth == 0);
    const std::vector<Piece> pieces = divided ? divide(node.part) : std::vector<Piece>();
    std::uint32_t& child = tree_.obb_nodes[node.block].child[node.lane];
    if (pieces.size() <= 1) {
      child = kLeafBit | static_cast<std::uint32_t>(tree_.triangle_blocks.size());
      add_triangles(node.part);
      return;
    }
    const std::size_t block = tree_.obb_nodes.size();
    child = static_cast<std::uint32_t>(block);
    add_block();
    for (std::uint32_t lane = 0; lane < pieces.size(); ++lane) {
      next.push_back({pieces[lane], block, lane});
      place(next.back());
    }
  }

  void add_triangles(const Range& leaf) {
    TriangleBlock& block = tree_.triangle_blocks.emplace_back();
    for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
      const bool used = lane < leaf.size();
      const Triangle& t = order_[leaf.begin + (used ? lane : 0)];
      block.triangle[lane] = used ? t.number : kNoTriangle;
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) block.corner[k][i][lane] = t.corners[k][i];
      }
    }
  }

  // Cuts the piece that is most worth it, until there are eight pieces or none is worth it. If triangles are many, this
  // is the widest piece, and pieces that fit in a leaf stay whole. If they are few, it is the piece whose cut gains
  // most, and leaves need not be full, because all of them fit in the block.
  std::vector<Piece> divide(const Part& node) {
    std::vector<Piece> pieces = {piece_of(node)};
    while (pieces.size() < kBlockWidth) {
      const auto best = std::max_element(pieces.begin(), pieces.end(),
                                         [](const Piece& p, const Piece& q) { return p.worth < q.worth; });
      if (best->worth == -kInfinity) break;
      const std::size_t end = best->end, middle = is_few() ? cut_few(*best) : halve(*best);
      *best = piece_of(fitter_.measured({best->begin, middle}));
      pieces.insert(best + 1, piece_of(fitter_.measured({middle, end})));
    }
    return pieces;
  }

  Piece piece_of(const Part& part) {
    Piece piece{part};
    if (is_few()) {
      find_cut_of_few(piece);
    } else if (part.size() > kBlockWidth) {
      piece.worth = part.radius;
    }
    return piece;
  }

  static std::size_t multiple_of_width(std::size_t count) {
    return (count + kBlockWidth - 1) / kBlockWidth * kBlockWidth;
  }

  // Cuts a part across one of three axes and returns the end of the first half. The place is the one at which the areas
  // of the boxes of both halves, times the numbers of their triangles, are smallest (MacDonald and Booth 1990); among
  // equal places, the most even one. Far down in the tree, parts are halved by number, which limits the depth. Cuts
  // across principal axes are at multiples of eight triangles, so that leaves are full.
  std::size_t halve(const Part& part) {
    const bool aligned = cuts_ == Cuts::aligned;
    const std::size_t half = aligned ? part.size() / 2 : multiple_of_width(part.size() / 2);
    if (tree_.triangle_tree_depth >= kCostlyDepth) {
      find_places(part, part.axes[0], 0);
      put_in_order(places_[0], part);
      return part.begin + half;
    }
    Cut best = {.at = half};
    find_cut(part, aligned ? kAxes : part.axes, 0, half, aligned ? 1 : kBlockWidth, best);
    put_in_order(places_[best.axis], part);
    return part.begin + best.at;
  }

  // Sets `best` to the cheapest cut across any of three axes at a multiple of `step` triangles, if that is better.
  void find_cut(const Part& part, const std::array<Vec3, 3>& axes, std::size_t frame, std::size_t half,
                std::size_t step, Cut& best) {
    const std::size_t size = part.size();
    extents_.resize(size);
    for (std::size_t i = 0; i < size; ++i) extents_[i] = Extent::of(order_[part.begin + i], axes);
    behind_.resize(size);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      find_places(part, axes[axis], axis);
      const std::vector<PlaceAlong>& places = places_[axis];
      Extent extent;
      for (std::size_t i = size; i-- > 0;) {
        extent.add(extents_[places[i].from]);
        if (i % step == 0) behind_[i] = extent.area() * static_cast<double>(size - i);
      }
      extent = {};
      for (std::size_t i = 0; i < size; ++i) {
        if (i > 0 && i % step == 0) {
          const double cost = extent.area() * static_cast<double>(i) + behind_[i];
          best = std::min(best, Cut{cost, i > half ? i - half : half - i, frame, axis, i});
        }
        extent.add(extents_[places[i].from]);
      }
    }
  }

  // Finds the places of the centroids along an axis, and sorts them.
  void find_places(const Part& part, const Vec3& along, std::size_t axis) {
    std::vector<PlaceAlong>& places = places_[axis];
    places.resize(part.size());
    for (std::size_t i = 0; i < part.size(); ++i) {
      const std::uint32_t number = order_[part.begin + i].number;
      places[i] = {dot(along, centroids_[number]), number, static_cast<std::uint32_t>(i)};
    }
    std::sort(places.begin(), places.end());
  }
  void put_in_order(const std::vector<PlaceAlong>& places, const Range& part) {
    before_.assign(order_.begin() + static_cast<std::ptrdiff_t>(part.begin),
                   order_.begin() + static_cast<std::ptrdiff_t>(part.end));
    for (std::size_t i = 0; i < places.size(); ++i) order_[part.begin + i] = before_[places[i].from];
  }

  bool is_few() const { return order_.size() <= kFew; }

  // Finds the axes that boxes may have if triangles are few: those of the coordinates, and, for the largest triangles
  // that differ in them, the normal and the shortest edge. Principal axes of few corners are tilted against all faces.
  void find_frames() {
    constexpr std::size_t kMaxFrames = 8;
    frames_ = {kAxes};
    std::vector<std::pair<double, std::array<Vec3, 3>>> faces;
    for (const Triangle& t : order_) {
      std::array<Vec3, 3> edges{};
      for (std::size_t k = 0; k < 3; ++k)
        edges[k] = minus(as_doubles(t.corners[(k + 1) % 3]), as_doubles(t.corners[k]));
      const Vec3 across = cross(edges[0], edges[1]);
      const Vec3 shortest = *std::min_element(edges.begin(), edges.end(),
                                              [](const Vec3& p, const Vec3& q) { return dot(p, p) < dot(q, q); });
      if (!(dot(across, across) > 0)) continue;
      const Vec3 n = unit(across), e = unit(shortest);
      faces.push_back({-dot(across, across), {n, e, cross(n, e)}});
    }
    std::stable_sort(faces.begin(), faces.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
    for (const auto& face : faces) {
      if (frames_.size() == kMaxFrames) break;
      const auto same = [&](const std::array<Vec3, 3>& frame) { return are_same(frame, face.second); };
      if (std::none_of(frames_.begin(), frames_.end(), same)) frames_.push_back(face.second);
    }
  }

  static Vec3 unit(const Vec3& v) {
    const double length = std::sqrt(dot(v, v));
    return {v[0] / length, v[1] / length, v[2] / length};
  }

  // Returns whether each axis of one frame is nearly an axis of the other one, in any order and with any signs.
  static bool are_same(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& q) {
    constexpr double kNearlyOne = 1 - 1e-12;
    return std::all_of(p.begin(), p.end(), [&](const Vec3& u) {
      return std::any_of(q.begin(), q.end(), [&](const Vec3& v) { return std::fabs(dot(u, v)) > kNearlyOne; });
    });
  }

  void find_cut_of_few(Piece& piece) {
    double area = kInfinity;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      area = std::min(area, fitter_.extent_of(piece, frames_[f]).area());
      find_cut(piece, frames_[f], f, piece.size() / 2, 1, piece.cut);
    }
    const double whole = area * static_cast<double>(piece.size());
    if (piece.size() > kBlockWidth || piece.cut.cost < kWorthCutting * whole) piece.worth = whole - piece.cut.cost;
  }

  std::size_t cut_few(const Piece& piece) {
    find_places(piece, frames_[piece.cut.frame][piece.cut.axis], 0);
    put_in_order(places_[0], piece);
    return piece.begin + piece.cut.at;
  }

  void place(const Pending& node) {
    const ObbNode slab = fitter_.obb_node_of(node.part);
    ObbNodeBlock& block = tree_.obb_nodes[node.block];
    const std::uint32_t lane = node.lane;
    const auto put = [lane](const Vec3& v, auto& x, auto& y, auto& z) {
      x[lane] = static_cast<float>(v[0]), y[lane] = static_cast<float>(v[1]), z[lane] = static_cast<float>(v[2]);
    };
    put(slab.center, block.x, block.y, block.z);
    put(slab.normal, block.nx, block.ny, block.nz);
    put(slab.second, block.mx, block.my, block.mz);
    block.radius[lane] = stored_above(slab.radius);
    // The numbers that cancel in a height are as large as distances from the centre.
    block.height[lane] = stored_above(slab.height + 1e-15 * slab.radius);
    block.width[lane] = stored_above(slab.width + 1e-15 * slab.radius);
    block.length[lane] = stored_above(slab.length + 1e-15 * slab.radius);
  }

  PackedSphereTree& tree_;
  Cuts cuts_;
  std::vector<Triangle> order_;
  BoxFitter fitter_{order_, frames_};
  std::vector<Vec3> centroids_;  // by the triangles' numbers
  // These are used while a part is cut:
  std::vector<Triangle> before_;  // its triangles in the order before
  std::vector<Extent> extents_;   // of its triangles
  std::vector<double> behind_;    // the costs of the triangles behind each place
  std::array<std::vector<PlaceAlong>, 3> places_;
  std::vector<std::array<Vec3, 3>> frames_;  // if triangles are few: see find_frames()
};

}  // namespace

void detail::index_for_rays(PackedSphereTree& tree) { Builder(tree, Cuts::aligned).build(); }

void index_triangles(PackedSphereTree& tree) {
  Builder(tree, Cuts::principal).build();
  tree.supports.clear();
  if (tree.triangles.empty()) return;
  std::vector<bool> used(tree.vertices.size());
  for (const auto& triangle : tree.triangles) {
    for (const std::uint32_t vertex : triangle) used[vertex] = true;
  }
  std::array<double, kSupportCount> most;
  most.fill(-std::numeric_limits<double>::infinity());
  std::array<Vec3, kSupportCount> directions;
  for (std::uint32_t i = 0; i < kSupportCount; ++i) directions[i] = support_direction(i);
  double largest = 0;
  for (std::size_t v = 0; v < tree.vertices.size(); ++v) {
    if (!used[v]) continue;
    const Vec3 p = as_doubles(tree.vertices[v]);
    largest = std::max(largest, detail::max_abs(p));
    for (std::size_t i = 0; i < kSupportCount; ++i) most[i] = std::max(most[i], dot(directions[i], p));
  }
  for (const double reach : most) {
    const double above_all = reach + 1e-15 * 3 * largest;  // covers the rounding of the sum
    tree.supports.push_back(detail::next_float(above_all));
  }
}

}  // namespace orchard::runtime
