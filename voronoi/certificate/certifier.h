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

// Computes the certificate of certify(). The spheres of vertices are treated in certificate_spheres.cpp, the facets
// between them and the edges of the hull in certificate_facets.cpp, and the whole diagram, with repairs, in
// certificate.cpp.
class Certifier {
 public:
  Certifier(Workspace& workspace, FormingPoints& forming, Index first_new, Repairer* mender,
            const std::function<void(double)>& report);
  // `points` is the number of points that form vertices if none has been lost.
  Certificate run(std::size_t points);

 private:
  // The share of the intrusion that a single facet may take off. A facet that takes off more is wrong, not just
  // rounded.
  static constexpr double kFacet = 1.0 / 64;
  // The share of the intrusion by which the sphere that a vertex was given may differ from its own.
  static constexpr double kGiven = 1.0 / 4;
  // the number of vertices that are compared with all points; for more of them, exact signs are cheaper
  static constexpr std::size_t kMaxSuspects = 4096, kOfReflexEdge = 4;

  // The edge of the hull between the facets of a vertex at infinity and of its neighbour `slot`.
  struct HullEdge {
    Index v, u;
    unsigned slot;
    friend bool operator==(const HullEdge&, const HullEdge&) = default;
    friend bool operator<(const HullEdge& a, const HullEdge& b) { return a.v != b.v ? a.v < b.v : a.slot < b.slot; }
  };

  // What a test shows about a finite vertex before any conclusion is drawn: its orientation, and an upper bound on the
  // distance between the sphere that it was given and its own. The centre of its own sphere, relative to its first
  // point, is set if it had to be computed.
  struct Look {
    Determinant negative;  // of six times the volume, with the opposite sign
    double apart = 0;
    bool has_center = false;
    Vector center;
  };

  // The amount that the facet of three points takes off, if it is more than its share.
  struct Loss {
    double intrusion;
    std::array<Index, 3> facet;
  };

  // What is found at some vertices. Findings are merged in the order of the vertices, whichever thread made them.
  struct Findings {
    bool good = true;
    double intrusion = 0, lost = 0, given = 0, max_volume = 0;
    Index fattest = kNone;
    std::vector<Loss> losses;
    std::vector<Index> suspects;
    std::vector<Index> hull;   // vertices at infinity
    std::vector<Index> lossy;  // vertices with a shared sphere that is farther from their own than the share of a facet
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

  // The work on a part of the vertices, done by one thread.
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
  // To be checked after a repair, because no facet shows that a point has been lost.
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
  // Returns the bound that the stored error class gives for the distance between the sphere that the vertex was given
  // and its own.
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
  std::vector<Index> changed_;  // by repairs since the hull was last examined
  Repairer* mender_;
  std::size_t doubtful_ = 0;
  bool looks_at_changed_ = false, mended_ = false;
  const std::function<void(double)>& report_;
  std::atomic<std::size_t> looked_at_ = 0;
};

}  // namespace orchard::detail
