#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <vector>

#include "certificate/certificate.h"
#include "certificate/certificate_four.h"
#include "predicates/four_tetrahedra.h"
#include "workspace/forming_points.h"

namespace orchard::detail {

// The proof that certify() speaks of: of the vertices' own spheres in certificate_spheres.cpp, of the facets between
// them and of the hull's edges in certificate_facets.cpp, and of all together, with what is mended, in certificate.cpp.
class Certifier {
 public:
  Certifier(Workspace& workspace, FormingPoints& forming, Index first_new, Repairer* mender,
            const std::function<void(double)>& report);
  // `points`: how many form vertices if none was lost.
  Certificate run(std::size_t points);

 private:
  // The part of the intrusion that a single facet may take up. What takes more is wrong, not rounded.
  static constexpr double kFacet = 1.0 / 64;
  // The part of the intrusion that may lie between the sphere that a vertex was given and its own.
  static constexpr double kGiven = 1.0 / 4;
  // Vertices that are held against all points; where there are more, exact signs are cheaper.
  static constexpr std::size_t kMaxSuspects = 4096, kOfReflexEdge = 4;

  // The edge of the hull between the facets of a vertex at infinity and of its neighbour `slot`.
  struct HullEdge {
    Index v, u;
    unsigned slot;
    friend bool operator==(const HullEdge&, const HullEdge&) = default;
    friend bool operator<(const HullEdge& a, const HullEdge& b) { return a.v != b.v ? a.v < b.v : a.slot < b.slot; }
  };

  // What is seen of a finite vertex before anything follows from it: its orientation, and how far the sphere that it
  // was given is from its own, at most, with its own centre, relative to its first point, where that had to be found.
  struct Look {
    Determinant negative;  // of six times its volume, the other way around
    double apart = 0;
    bool has_center = false;
    Vector center;
  };

  // What the facet of three points takes off, where that is more than its share.
  struct Loss {
    double intrusion;
    std::array<Index, 3> facet;
  };

  // What is found at some vertices, to be put together in their order, whichever thread looked at which.
  struct Findings {
    bool good = true;
    double intrusion = 0, lost = 0, given = 0, max_volume = 0;
    Index fattest = kNone;
    std::vector<Loss> losses;
    std::vector<Index> suspects;
    std::vector<Index> hull;   // vertices at infinity
    std::vector<Index> lossy;  // that share a sphere farther from their own than a facet's share
    std::vector<Doubt> doubts;

    void add(const Findings& next) {
      good = good && next.good;
      intrusion += next.intrusion;
      lost += next.lost;
      given = std::max(given, next.given);
      if (next.max_volume > max_volume) max_volume = next.max_volume, fattest = next.fattest;
      losses.insert(losses.end(), next.losses.begin(), next.losses.end());
      suspects.insert(suspects.end(), next.suspects.begin(), next.suspects.end());
      hull.insert(hull.end(), next.hull.begin(), next.hull.end());
      lossy.insert(lossy.end(), next.lossy.begin(), next.lossy.end());
      doubts.insert(doubts.end(), next.doubts.begin(), next.doubts.end());
    }
  };

  // For a part of the vertices of the whole, found by a thread of its own.
  struct Part {};
  Certifier(const Certifier& whole, Part);

  const Point& corner(Index v, unsigned i) const { return workspace_.points[workspace_.vertices[v].forming_points[i]]; }
  unsigned slot_of(Index v, Index neighbor) const {
    return static_cast<unsigned>(index_of(workspace_.vertices[v].neighbors, neighbor));
  }
  bool is_tetrahedron(Index v) const { return v != kNone && !workspace_.is_free(v) && !workspace_.at_infinity(v); }
  bool is_new(Index v) const {
    const auto& p = workspace_.vertices[v].forming_points;
    const auto from = [this](Index point) { return point >= first_new_ && point != kInfinitePoint; };
    return first_new_ == 0 || from(p[0]) || from(p[1]) || from(p[2]) || from(p[3]);
  }
  // After mending: a lost point would lie in a sphere that no facet tells of.
  bool has_all_points() const { return count_forming(workspace_) == points_; }
  bool has_changed(Index v) const { return std::binary_search(changed_.begin(), changed_.end(), v); }
  Determinant six_volumes(Index v) const {
    const Point& last = corner(v, 3);
    return volume(corner(v, 0) - last, corner(v, 1) - last, corner(v, 2) - last);
  }
  void note_volume(Index v, double negative) {
    if (-negative > found_.max_volume) found_.max_volume = -negative, found_.fattest = v;
  }
  bool doubt(Index v, Index u) {
    if (mender_) found_.doubts.push_back({v, u});
    return mender_ != nullptr;
  }
  // How far the sphere that a vertex was given is from its own, at most, as far as its error bound tells.
  double from_told_sphere(Index v) const { return from_told_sphere(v, std::sqrt(workspace_.vertices[v].radius)); }
  double from_told_sphere(Index v, double radius) const {
    if (workspace_.exact()) return 0;
    if (workspace_.shares_sphere(v)) return diameter_;
    return workspace_.power_bound(v) / radius;
  }
  bool add(double intrusion) {
    if (!(intrusion <= kFacet * max_)) return false;
    found_.intrusion += intrusion;
    return true;
  }
  bool are_own_spheres(Index v, Index u) const { return !workspace_.shares_sphere(v) && !workspace_.shares_sphere(u); }
  bool is_same_sphere(Index v, Index u) const { return workspace_.vertices[v].center == workspace_.vertices[u].center; }

  // Of all together: certificate.cpp.
  bool look_at_all();
  bool mend_doubts();
  bool look_at_mended(const std::vector<Index>& changed);
  bool patch(const std::vector<Index>& wrong);
  bool look_at_each_oriented();
  bool look_at_each_facet();
  bool look_at_edges(const std::vector<Index>& hull);
  template <class Good>
  bool look_in_blocks(Index count, Index block, const Good& good);
  double share_done(double looked_at) const;
  bool look_at_changed(const std::vector<Index>& changed);
  bool look_at_hull();
  void forget_changed_suspects();
  std::vector<HullEdge> changed_edges() const;
  bool look_closer();
  double max_lost_on_line() const;
  void find_fattest();
  std::vector<Index> guilty_suspects();
  void add_vertex_of_each(std::vector<Index>& points, std::vector<Index>& vertices) const;
  void note_hull_points();
  std::vector<Index> hull_vertices();
  std::vector<Index> all_hull_vertices() const;

  // Of the vertices and their own spheres: certificate_spheres.cpp.
  bool is_oriented(Index v);
  bool is_hull_facet(Index v);
  Look look(Index v);
  bool is_oriented(Index v, const Look& seen);
  bool are_all_oriented(Index begin, Index end);
  static void take_volumes(const FourVolumes& six, std::size_t first, BatchLooks& seen);
  FourTetrahedra tetrahedra(const std::array<Index, 4>& four) const;
  void see_four_spheres(const BatchList& list, BatchLooks& seen);
  template <class See>
  void see_far(const BatchList& list, const BatchLooks& seen, double hopeless, const See& see);
  bool note_four(const std::array<Index, 4>& v, const std::array<Index, 4>& at, const FourSeen& found,
                 BatchLooks& seen);
  bool are_listed_oriented(const BatchList& list, const BatchLooks& seen);
  static bool is_triangle(const Point& a, const Point& b, const Point& c);
  double from_own_sphere(Index v) const;
  double from_seen_sphere(Index v);
  double note_off(Index v, const OffCenter& seen);
  double from_moved_sphere(Index v);
  double apart_by(double off, double radius) const;
  bool own_center(Index v, Vector& center) const;
  double from_sphere(Index v, const Vector& center) const;

  // Of facets and of the hull's edges: certificate_facets.cpp.
  bool are_facets_good(Index v);
  bool is_facet_good(Index v, unsigned i, Index u);
  bool are_all_facets_good(Index begin, Index end);
  std::array<double, 4> added_across(const Facet* facets);
  void note_loss(double intrusion, Index v, unsigned i);
  bool do_spheres_agree(Index v, unsigned i, Index u);
  bool are_apart(Index v, unsigned i, Index u, const Point& across) const;
  static double normal(const Point& a, const Point& b, const Point& c, Vector& result);
  double near_power(Index v, const Point& q) const;
  double intrusion_added(Index v, Index u, const Point& origin, const Vector& normal, double blur, const Vector& up,
                         double height) const;
  bool is_hull_convex(Index v, unsigned i);
  bool is_reflex_edge_shallow(Index v, unsigned i, const Point& p, const Point& b, const Point& c);

  Workspace& workspace_;
  FormingPoints& forming_;
  Box box_;
  Index first_new_;
  double diameter_ = 0, max_ = 0, max_sum_ = 0, share_ = 0, small_share_ = 0;
  Findings found_;
  std::size_t points_ = 0;
  std::vector<Index> hull_points_;
  std::vector<Index> changed_;  // by mending, since the hull was looked at
  Repairer* mender_;
  std::size_t doubtful_ = 0;
  bool looks_at_changed_ = false, mended_ = false;
  const std::function<void(double)>& report_;
  std::atomic<std::size_t> looked_at_ = 0;
};

}  // namespace orchard::detail
