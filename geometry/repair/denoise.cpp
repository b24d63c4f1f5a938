#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "orchard/geometry/error.h"
#include "orchard/geometry/noise.h"
#include "repair/vertex_rings.h"

namespace orchard {
namespace {

constexpr int kMovesPerRound = 3;
constexpr double kFarthestMove = 3;  // in deviations; 0.3 % of normally distributed noise is farther
// Over the deviation: where rounds end. A smooth surface through noisy vertices keeps a part of their displacements: a
// fit with a tenth as many parameters as vertices keeps sqrt(1 - 1 / 10).
constexpr double kWholeMove = 0.95;

struct Facet {
  Vector normal = Vector::Zero();  // of length 1, or 0 for a triangle without area
  Point center = Point::Zero();
  double area = 0;
};

class Denoiser {
 public:
  Denoiser(const TriangleMesh& mesh, double deviation)
      : given_(mesh),
        mesh_(mesh),
        rings_(mesh),
        deviation_(deviation * diagonal_of(mesh)),
        facets_(mesh.triangles.size()) {
    measure_facets();
    find_neighbors();
    set_widths();
  }

  DenoisedMesh run(int max_rounds, const Progress& progress) {
    DenoisedMesh result;
    double moved = 0;
    while (result.rounds < max_rounds && moved < kWholeMove * deviation_) {
      report_progress(progress, "noise", std::min(1.0, moved / deviation_));
      filter_normals();
      for (int move = 0; move < kMovesPerRound; ++move) {
        move_vertices();
        measure_centers();
      }
      stay_near();
      measure_facets();
      ++result.rounds;
      moved = moved_along_normals();
    }
    const double diagonal = diagonal_of(given_);
    result.moved_rms = moved / diagonal;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v)
      result.moved_max = std::max(result.moved_max, (mesh_.vertices[v] - given_.vertices[v]).norm() / diagonal);
    result.mesh = std::move(mesh_);
    return result;
  }

 private:
  Point center_of(std::size_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return (mesh_.vertices[a] + mesh_.vertices[b] + mesh_.vertices[c]) / 3;
  }

  void measure_centers() {
    tbb::parallel_for(std::size_t{0}, facets_.size(), [&](std::size_t t) { facets_[t].center = center_of(t); });
  }

  void measure_facets() {
    tbb::parallel_for(std::size_t{0}, facets_.size(), [&](std::size_t t) {
      const auto& [a, b, c] = mesh_.triangles[t];
      const Vector across = (mesh_.vertices[b] - mesh_.vertices[a]).cross(mesh_.vertices[c] - mesh_.vertices[a]);
      const double length = across.norm();
      facets_[t] = {length > 0 ? Vector(across / length) : Vector::Zero(), center_of(t), length / 2};
    });
  }

  // Finds the triangles that share a corner with each triangle, in ascending order.
  void find_neighbors() {
    neighbors_.resize(facets_.size());
    tbb::parallel_for(std::size_t{0}, facets_.size(), [&](std::size_t t) {
      std::vector<Index>& around = neighbors_[t];
      for (const Index corner : mesh_.triangles[t]) {
        const std::span<const Index> at = rings_.triangles_at[corner];
        around.insert(around.end(), at.begin(), at.end());
      }
      std::sort(around.begin(), around.end());
      around.erase(std::unique(around.begin(), around.end()), around.end());
      std::erase(around, static_cast<Index>(t));
    });
  }

  // Sets the widths of the two Gaussians: the mean distance of neighbours, and the root mean square difference of their
  // normals, which is due to noise everywhere and to sharp edges in few places.
  void set_widths() {
    double distances = 0, differences = 0, count = 0;
    for (std::size_t t = 0; t < facets_.size(); ++t)
      for (const Index other : neighbors_[t]) {
        distances += (facets_[t].center - facets_[other].center).norm();
        differences += (facets_[t].normal - facets_[other].normal).squaredNorm();
        ++count;
      }
    // A width of 0 means that all neighbours are equal; a flat mesh has a single normal.
    if (distances > 0) per_distance_ = 1 / (2 * (distances / count) * (distances / count));
    if (differences > 0) per_difference_ = 1 / (2 * differences / count);
  }

  void filter_normals() {
    std::vector<Vector> filtered(facets_.size());
    tbb::parallel_for(std::size_t{0}, facets_.size(), [&](std::size_t t) {
      const Facet& facet = facets_[t];
      Vector sum = facet.area * facet.normal;
      for (const Index other : neighbors_[t]) {
        const Facet& near = facets_[other];
        const double apart = (facet.center - near.center).squaredNorm() * per_distance_;
        const double unlike = (facet.normal - near.normal).squaredNorm() * per_difference_;
        sum += near.area * std::exp(-apart - unlike) * near.normal;
      }
      const double length = sum.norm();
      filtered[t] = length > 0 ? Vector(sum / length) : facet.normal;
    });
    for (std::size_t t = 0; t < facets_.size(); ++t) facets_[t].normal = filtered[t];
  }

  // Moves each vertex by the mean of its distances from the planes of its triangles.
  void move_vertices() {
    std::vector<Point> moved(mesh_.vertices.size());
    tbb::parallel_for(std::size_t{0}, moved.size(), [&](std::size_t v) {
      const Point& vertex = mesh_.vertices[v];
      const std::span<const Index> at = rings_.triangles_at[static_cast<Index>(v)];
      Vector sum = Vector::Zero();
      for (const Index t : at) sum += facets_[t].normal.dot(facets_[t].center - vertex) * facets_[t].normal;
      moved[v] = at.empty() ? vertex : Point(vertex + sum / static_cast<double>(at.size()));
    });
    mesh_.vertices = std::move(moved);
  }

  // Limits the distance of vertices from their given places to what noise explains.
  void stay_near() {
    const double farthest = kFarthestMove * deviation_;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      const Vector way = mesh_.vertices[v] - given_.vertices[v];
      if (const double length = way.norm(); length > farthest)
        mesh_.vertices[v] = given_.vertices[v] + way * (farthest / length);
    }
  }

  double moved_along_normals() const {
    double sum = 0;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      Vector normal = Vector::Zero();
      for (const Index t : rings_.triangles_at[static_cast<Index>(v)]) normal += facets_[t].area * facets_[t].normal;
      const double length = normal.norm();
      if (!(length > 0)) continue;
      const double along = (mesh_.vertices[v] - given_.vertices[v]).dot(normal) / length;
      sum += along * along;
    }
    return std::sqrt(sum / static_cast<double>(mesh_.vertices.size()));
  }

  const TriangleMesh& given_;
  TriangleMesh mesh_;
  const VertexRings rings_;
  const double deviation_;  // in mesh units
  std::vector<Facet> facets_;
  std::vector<std::vector<Index>> neighbors_;
  double per_distance_ = 0, per_difference_ = 0;
};

}  // namespace

DenoisedMesh denoise(const TriangleMesh& mesh, const DenoiseOptions& options, const Progress& progress) {
  if (!(options.deviation >= 0 && options.deviation <= kMaxNoise))
    throw InputError("the deviation of the noise must lie between 0 and 0.05 of the diagonal");
  if (options.max_rounds < 0) throw InputError("the number of rounds must be at least 0");
  if (options.deviation == 0) return {.mesh = mesh};
  return Denoiser(mesh, options.deviation).run(options.max_rounds, progress);
}

}  // namespace orchard
