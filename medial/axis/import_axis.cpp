#include "orchard/medial/import_axis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ball_tree.h"
#include "orchard/geometry/angle.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"
#include "point_normals.h"

namespace orchard {
namespace {

template <class Row>
void append(Rows& rows, const Row& row) {
  rows.items.insert(rows.items.end(), row.begin(), row.end());
  rows.close_row();
}

class Importer {
 public:
  Importer(const Surface& surface, const MedialMesh& mesh, SurfaceSampling sampling, const Progress& progress)
      : surface_(surface), mesh_(mesh), samples_(sampling.size()), progress_(progress), axis_(result_.axis) {
    result_.sampling = std::move(sampling);
  }

  ImportedAxis run() {
    add_balls();
    detail::add_points(surface_, result_.sampling, axis_);
    if (axis_.size() == 0)
      throw InputError(
          "no ball of the medial mesh has its centre inside the solid; is it the axis of this mesh, in the same "
          "frame?");
    share_samples_out();
    find_angles();
    add_edges();
    add_faces();
    report_progress(progress_, "importing the axis", 1);
    return std::move(result_);
  }

 private:
  // Adds the balls, each with its first contact: the surface's point nearest to its centre.
  void add_balls() {
    number_.assign(mesh_.size(), kNone);
    for (Index i = 0; i < mesh_.size(); ++i) {
      ClosestPoint nearest;
      if (!(surface_.signed_distance(mesh_.centers[i], nearest) < 0)) {
        ++result_.refused;
        continue;
      }
      number_[i] = axis_.size();
      const double off = std::abs(mesh_.radii[i] - nearest.distance);
      if (off > tolerance::kSameRadius * surface_.bounding_radius()) {
        ++result_.adjusted;
        result_.adjustment = std::max(result_.adjustment, off);
      }
      contacts_.push_back({contact_of(axis_.size())});
      axis_.centers.push_back(mesh_.centers[i]);
      axis_.radii.push_back(nearest.distance);
      add_contact(nearest);
    }
  }

  void add_contact(const ClosestPoint& place) {
    SurfaceSampling& sampling = result_.sampling;
    sampling.points.push_back(place.position);
    sampling.triangles.push_back(place.triangle);
    sampling.features.push_back(place.feature);
    sampling.origins.push_back(PointOrigin::repair);
  }

  // Makes each sample a contact of the ball whose surface is nearest to it; of equals, the first.
  void share_samples_out() {
    std::vector<Box> boxes;
    for (const Point& center : axis_.centers) boxes.emplace_back(center, center);
    const detail::BallTree tree(std::move(boxes), axis_.radii);
    const Index step = std::max<Index>(samples_ / 64, 1);
    for (Index p = 0; p < samples_; ++p) {
      const Point& point = axis_.points[p];
      const auto gap = [&](Index v) { return (point - axis_.centers[v]).norm() - axis_.radii[v]; };
      Index nearest = kNone;
      double min = std::numeric_limits<double>::infinity();
      tree.min(point, min, [&](Index v) {
        const double g = gap(v);
        if (g < min || (g == min && v < nearest)) min = g, nearest = v;
        return g;
      });
      contacts_[nearest].push_back(p);
      if (p % step == 0) report_progress(progress_, "importing the axis", static_cast<double>(p) / samples_);
    }
  }

  double angle_at(Index v, Index p, Index q) const {
    return angle_between(axis_.points[p] - axis_.centers[v], axis_.points[q] - axis_.centers[v]);
  }

  // Stores for each ball the largest angle, seen from its centre, between its first contact and another, and its
  // contacts in ascending order.
  void find_angles() {
    for (Index v = 0; v < axis_.size(); ++v) {
      const Index first = contacts_[v].front();
      double widest = 0;
      for (const Index p : contacts_[v]) widest = std::max(widest, angle_at(v, first, p));
      axis_.angles.push_back(widest);
      std::sort(contacts_[v].begin(), contacts_[v].end());
      append(axis_.forming_points, contacts_[v]);
    }
  }

  void add_edges() {
    std::vector<std::vector<Index>> neighbors(axis_.size());
    for (const auto& [a, b] : mesh_.edges) {
      if (number_[a] == kNone || number_[b] == kNone) continue;
      neighbors[number_[a]].push_back(number_[b]);
      neighbors[number_[b]].push_back(number_[a]);
    }
    for (auto& row : neighbors) {
      std::sort(row.begin(), row.end());
      append(axis_.neighbors, row);
    }
  }

  // Of the first contacts of a face's three corners, the two that are farthest apart.
  std::array<Index, 2> points_of(const std::array<Index, 3>& corners) const {
    std::array<Index, 3> first;
    for (std::size_t i = 0; i < 3; ++i) first[i] = contact_of(corners[i]);
    std::array<Index, 2> best{first[0], first[1]};
    const auto apart = [&](Index p, Index q) { return (axis_.points[p] - axis_.points[q]).squaredNorm(); };
    if (apart(first[0], first[2]) > apart(best[0], best[1])) best = {first[0], first[2]};
    if (apart(first[1], first[2]) > apart(best[0], best[1])) best = {first[1], first[2]};
    return {std::min(best[0], best[1]), std::max(best[0], best[1])};
  }
  Index contact_of(Index v) const { return samples_ + v; }

  void add_faces() {
    for (const auto& triangle : mesh_.triangles) {
      std::array<Index, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) corners[i] = number_[triangle[i]];
      if (std::find(corners.begin(), corners.end(), kNone) != corners.end()) continue;
      append(axis_.faces, corners);
      axis_.face_points.push_back(points_of(corners));
    }
  }

  const Surface& surface_;
  const MedialMesh& mesh_;
  const Index samples_;  // before the contacts
  const Progress& progress_;
  ImportedAxis result_;
  MedialAxis& axis_;
  std::vector<Index> number_;                 // of each ball: its vertex
  std::vector<std::vector<Index>> contacts_;  // of each vertex: points
};

}  // namespace

ImportedAxis import_axis(const Surface& surface, const MedialMesh& mesh, SurfaceSampling sampling,
                         const Progress& progress) {
  if (!surface.solid())
    throw InputError("the medial axis needs a solid: " + surface.report().faults() + "; repair the mesh first");
  validate(mesh);
  return Importer(surface, mesh, std::move(sampling), progress).run();
}

}  // namespace orchard
