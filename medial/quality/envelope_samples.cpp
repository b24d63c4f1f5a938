#include "envelope_samples.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "orchard/geometry/random.h"

namespace orchard::detail {
namespace {

constexpr std::uint64_t kEnvelopeStage = 0x656e76;
constexpr int kTries = 100;  // the maximum number of random places for each sample that is wanted
// Of the largest radius: a place counts as outside the ball that it was made on, despite rounding.
constexpr double kOwnBall = 1e-9;

struct Piece {
  enum class Kind : std::uint8_t { sphere, cone, face } kind = Kind::sphere;
  std::array<Index, 3> corners{};
  Vector normal = Vector::Zero();  // of a face, the normal of its plane; of a cone, its slope along its axis
  double lean = 0;
};

class Sampler {
 public:
  Sampler(const MedialMesh& mesh, const Reconstruction& reconstruction) : mesh_(mesh), reconstruction_(reconstruction) {
    for (Index v = 0; v < mesh.size(); ++v) {
      add({Piece::Kind::sphere, {v, v, v}}, 4 * std::numbers::pi * mesh.radii[v] * mesh.radii[v]);
      largest_ = std::max(largest_, mesh.radii[v]);
    }
    for (const auto& [a, b] : mesh.edges) add_cone(a, b);
    for (const auto& triangle : mesh.triangles) add_faces(triangle);
  }

  std::vector<Point> run(Index count, std::uint64_t seed) const {
    std::vector<Point> samples;
    if (areas_.empty() || !(areas_.back() > 0)) return samples;
    const std::uint64_t tries = std::uint64_t{count} * kTries;
    for (std::uint64_t i = 0; i < tries && samples.size() < count; ++i) {
      Random random(seed, kEnvelopeStage, i);
      const double place = areas_.back() * random.uniform();
      const auto found = std::upper_bound(areas_.begin(), areas_.end() - 1, place);
      const Point point = point_on(pieces_[static_cast<std::size_t>(found - areas_.begin())], random);
      Sphere unused{Point::Zero(), 0};
      const double bound = -kOwnBall * largest_;
      if (!(reconstruction_.distance_between(bound, 0, point, unused) < bound)) samples.push_back(point);
    }
    return samples;
  }

 private:
  void add(const Piece& piece, double area) {
    if (!(area > 0)) return;
    pieces_.push_back(piece);
    areas_.push_back((areas_.empty() ? 0 : areas_.back()) + area);
  }
  void add_cone(Index a, Index b) {
    const Vector line = mesh_.centers[b] - mesh_.centers[a];
    const double length = line.norm(), lean = (mesh_.radii[a] - mesh_.radii[b]) / length;
    if (!(length > 0) || !(std::abs(lean) < 1)) return;
    const double across = std::sqrt(1 - lean * lean);
    add({Piece::Kind::cone, {a, b, b}, line / length, lean},
        std::numbers::pi * (mesh_.radii[a] + mesh_.radii[b]) * length * across);
  }
  // Adds the planes that touch three balls. The normal of such a plane has a product with each line between centres
  // that is the difference of the radii.
  void add_faces(const std::array<Index, 3>& triangle) {
    const auto& [a, b, c] = triangle;
    const Vector u = mesh_.centers[b] - mesh_.centers[a], v = mesh_.centers[c] - mesh_.centers[a];
    const Vector up = u.cross(v);
    const double square = up.squaredNorm();
    if (!(square > 0)) return;
    const double du = mesh_.radii[a] - mesh_.radii[b], dv = mesh_.radii[a] - mesh_.radii[c];
    const Vector flat = (du * v.cross(up) + dv * up.cross(u)) / square;
    if (!(flat.squaredNorm() < 1)) return;
    const Vector rise = std::sqrt(1 - flat.squaredNorm()) * up.normalized();
    for (const Vector& normal : {Vector(flat + rise), Vector(flat - rise)}) {
      const Vector p = u - du * normal, q = v - dv * normal;
      add({Piece::Kind::face, triangle, normal}, p.cross(q).norm() / 2);
    }
  }

  Point point_on(const Piece& piece, Random& random) const {
    const auto& [a, b, c] = piece.corners;
    if (piece.kind == Piece::Kind::sphere) {
      const double z = 2 * random.uniform() - 1, turn = 2 * std::numbers::pi * random.uniform();
      const double across = std::sqrt(std::max(0.0, 1 - z * z));
      return mesh_.centers[a] + mesh_.radii[a] * Vector(across * std::cos(turn), across * std::sin(turn), z);
    }
    if (piece.kind == Piece::Kind::cone) {
      // Places along the axis are chosen in proportion to the length of the circle around them.
      const double r = mesh_.radii[a], s = mesh_.radii[b], u = random.uniform();
      const double reached = std::sqrt(r * r + u * (s * s - r * r));
      const double t = std::abs(s - r) > 1e-12 * (r + s) ? (reached - r) / (s - r) : u;
      const double turn = 2 * std::numbers::pi * random.uniform();
      const Vector side = piece.normal.unitOrthogonal(), other = piece.normal.cross(side);
      const double across = std::sqrt(1 - piece.lean * piece.lean);
      const Vector out = piece.lean * piece.normal + across * (std::cos(turn) * side + std::sin(turn) * other);
      return mesh_.centers[a] + t * (mesh_.centers[b] - mesh_.centers[a]) + (r + t * (s - r)) * out;
    }
    const double u = std::sqrt(random.uniform()), v = random.uniform();
    const auto corner = [&](Index i) { return Point(mesh_.centers[i] + mesh_.radii[i] * piece.normal); };
    return (1 - u) * corner(a) + u * (1 - v) * corner(b) + u * v * corner(c);
  }

  const MedialMesh& mesh_;
  const Reconstruction& reconstruction_;
  std::vector<Piece> pieces_;
  std::vector<double> areas_;  // the areas of the pieces, each added to all before it
  double largest_ = 0;
};

}  // namespace

std::vector<Point> envelope_samples(const MedialMesh& mesh, const Reconstruction& reconstruction, Index count,
                                    std::uint64_t seed) {
  return Sampler(mesh, reconstruction).run(count, seed);
}

}  // namespace orchard::detail
