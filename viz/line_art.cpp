#include "line_art.h"

#include <vtkCellArray.h>
#include <vtkCleanPolyData.h>
#include <vtkClipPolyData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkTriangleFilter.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "actors.h"
#include "hidden_lines.h"
#include "line_chains.h"

namespace orchard::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSlack = 2e-4;  // of the larger side of the panel: lines nearer to a surface than this lie on it
// The number of sides of a circle, chosen so that chords are within Occluders' slack for spheres.
constexpr int kCircle = 72;
constexpr std::size_t kMostMeetings = 20'000;

// Returns the surface without repeated points, cut by the plane.
Data prepared(vtkPolyData* surface, const std::optional<std::array<double, 4>>& plane) {
  vtkNew<vtkTriangleFilter> triangles;  // also divides strips into triangles
  triangles->SetInputData(surface);
  triangles->PassVertsOff();
  vtkNew<vtkCleanPolyData> clean;
  clean->ToleranceIsAbsoluteOn();
  clean->SetAbsoluteTolerance(0);
  clean->ConvertPolysToLinesOff();
  clean->ConvertLinesToPointsOff();
  vtkNew<vtkClipPolyData> cut;
  clean->SetInputConnection(triangles->GetOutputPort());
  if (plane) {
    const auto& [a, b, c, d] = *plane;
    const double square = a * a + b * b + c * c;
    vtkNew<vtkPlane> where;
    where->SetOrigin(a * d / square, b * d / square, c * d / square);
    where->SetNormal(a, b, c);
    cut->SetInputConnection(triangles->GetOutputPort());
    cut->SetClipFunction(where);
    cut->InsideOutOn();
    clean->SetInputConnection(cut->GetOutputPort());
  }
  clean->Update();
  return clean->GetOutput();
}

// An edge of a triangle, and the corner opposite to it.
struct Side {
  int a, b, opposite;
};

std::vector<Side> sides_of(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<Side> sides;
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
      sides.push_back({a, b, t[(k + 2) % 3]});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    return std::array{x.a, x.b, x.opposite} < std::array{y.a, y.b, y.opposite};
  });
  return sides;
}

// Whether both triangles are seen on one side of their common edge, because only one of them faces the eye.
bool is_outline(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const auto side = [&](const Vector3d& p) {
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
  };
  return side(c) * side(d) > 0;
}

// Whether two triangles bend by more than the angle of features along their common edge.
bool is_sharp(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  const Vector3d along = (b - a).normalized();
  const auto away = [&](const Vector3d& p) { return Vector3d((p - a) - (p - a).dot(along) * along); };
  const Vector3d one = away(c), other = -away(d);
  static const double kLimit = std::cos(kFeatureAngle * std::numbers::pi / 180);
  return one.dot(other) < kLimit * one.norm() * other.norm();
}

}  // namespace

int LineArt::add_place(const Vector3d& place) {
  places_.push_back(place);
  cut_.push_back(false);
  return static_cast<int>(places_.size()) - 1;
}

bool LineArt::on_cut(int a, int b) const {
  return cut_[static_cast<std::size_t>(a)] && cut_[static_cast<std::size_t>(b)];
}

void LineArt::add_surface(vtkPolyData* surface, Surface kind) {
  const Data data = prepared(surface, plane_);
  const int first = static_cast<int>(places_.size());
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    Vector3d place;
    data->GetPoint(i, place.data());
    add_place(projection_(place));
    if (!plane_) continue;
    const auto& [a, b, c, d] = *plane_;
    const double off = a * place.x() + b * place.y() + c * place.z() - d;
    cut_.back() = std::abs(off) <= 1e-9 * (std::abs(d) + Vector3d(a, b, c).norm() * data->GetLength());
  }
  add_edges(data, kind, first);
}

void LineArt::add_edges(vtkPolyData* surface, Surface kind, int first) {
  auto& hiding = kind == Surface::glass ? glass_ : solid_;
  std::vector<std::array<int, 3>> triangles;
  vtkNew<vtkIdList> corners;
  const auto number = [&](vtkIdType i) { return first + static_cast<int>(corners->GetId(i)); };
  vtkCellArray* polys = surface->GetPolys();
  for (polys->InitTraversal(); polys->GetNextCell(corners) != 0;)
    if (corners->GetNumberOfIds() == 3) triangles.push_back({number(0), number(1), number(2)});
  hiding.insert(hiding.end(), triangles.begin(), triangles.end());
  const std::vector<Side> sides = sides_of(triangles);
  const bool glass = kind == Surface::glass, axis = kind == Surface::axis;
  const auto at = [&](int i) -> const Vector3d& { return places_[static_cast<std::size_t>(i)]; };
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].a == sides[i].a && sides[end].b == sides[i].b) ++end;
    const auto add = [&](Kind own) { edges_.push_back({sides[i].a, sides[i].b, glass ? Kind::glass : own}); };
    if (end - i == 1 || end - i > 2) {
      const Kind of_axis = end - i == 1 ? Kind::border : Kind::seam;
      add(axis && !on_cut(sides[i].a, sides[i].b) ? of_axis : Kind::sharp);
    } else {
      const Vector3d &a = at(sides[i].a), &b = at(sides[i].b), &c = at(sides[i].opposite),
                     &d = at(sides[i + 1].opposite);
      if (is_outline(a, b, c, d))
        add(Kind::outline);
      else if (!axis && is_sharp(a, b, c, d))
        add(Kind::sharp);
    }
    i = end;
  }
  vtkCellArray* lines = surface->GetLines();
  for (lines->InitTraversal(); lines->GetNextCell(corners) != 0;)
    for (vtkIdType k = 0; k + 1 < corners->GetNumberOfIds(); ++k)
      edges_.push_back({number(k), number(k + 1), glass ? Kind::glass : Kind::curve});
}

void LineArt::add_circle(const Vector3d& center, const Vector3d& u, const Vector3d& v) {
  const int first = static_cast<int>(places_.size());
  for (int i = 0; i < kCircle; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCircle;
    add_place(center + std::cos(angle) * u + std::sin(angle) * v);
    edges_.push_back({first + i, first + (i + 1) % kCircle, Kind::sphere});
  }
}

void LineArt::add_meeting(const Ball& one, const Ball& other) {
  const Vector3d between = other.center - one.center;
  const double distance = between.norm();
  if (distance >= one.radius + other.radius || distance <= std::abs(one.radius - other.radius)) return;
  const double along = (distance * distance + one.radius * one.radius - other.radius * other.radius) / (2 * distance);
  const double radius = std::sqrt(std::max(0.0, one.radius * one.radius - along * along));
  const Vector3d normal = between / distance, u = normal.unitOrthogonal();
  add_circle(one.center + along * normal, radius * u, radius * normal.cross(u));
}

void LineArt::add_spheres(vtkPolyData* spheres) {
  vtkDataArray* radii = require_array(spheres->GetPointData(), "radius", spheres->GetNumberOfPoints());
  std::vector<Ball> balls;
  for (vtkIdType i = 0; i < spheres->GetNumberOfPoints(); ++i) {
    Vector3d center;
    spheres->GetPoint(i, center.data());
    const double radius = radii->GetComponent(i, 0) / projection_.unit;
    if (std::isfinite(radius) && radius > 0) balls.push_back({projection_(center), radius});
  }
  for (const Ball& ball : balls)
    add_circle(ball.center, ball.radius * Vector3d::UnitX(), ball.radius * Vector3d::UnitY());
  std::sort(balls.begin(), balls.end(),
            [](const Ball& a, const Ball& b) { return a.center.x() - a.radius < b.center.x() - b.radius; });
  std::vector<std::pair<std::size_t, std::size_t>> meetings;
  for (std::size_t i = 0; i < balls.size() && meetings.size() <= kMostMeetings; ++i)
    for (std::size_t j = i + 1;
         j < balls.size() && balls[j].center.x() - balls[j].radius < balls[i].center.x() + balls[i].radius; ++j)
      if ((balls[i].center - balls[j].center).norm() < balls[i].radius + balls[j].radius) meetings.emplace_back(i, j);
  if (meetings.size() <= kMostMeetings)
    for (const auto& [i, j] : meetings) add_meeting(balls[i], balls[j]);
  balls_.insert(balls_.end(), balls.begin(), balls.end());
}

void LineArt::add_points(vtkPolyData* points) {
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i) {
    Vector3d place;
    points->GetPoint(i, place.data());
    const int number = add_place(projection_(place));
    edges_.push_back({number, number, Kind::dot});
  }
}

VectorLine LineArt::look_of(Kind kind) {
  switch (kind) {
    case Kind::glass:
      return {rgb(0x9aa3ad), 0.5, {}};
    case Kind::dot:
      return {kOriginColors[0], 2.2, {}};
    case Kind::sphere:
      return {kInk, 0.5, {}};
    case Kind::outline:
      return {kInk, 0.7, {}};
    case Kind::sharp:
      return {kInk, 0.9, {}};
    case Kind::curve:
      return {kCurveColor, 1.3, {}};
    case Kind::border:
      return {kBorderColor, 1.1, {}};
    case Kind::seam:
      return {kSeamColor, 1.5, {}};
  }
  return {};
}

std::vector<VectorLine> LineArt::lines() const {
  const double slack = kSlack * sides_.sizes().maxCoeff();
  Occluders solid(slack), all(slack);
  const auto at = [&](int i) -> const Vector3d& { return places_[static_cast<std::size_t>(i)]; };
  for (const auto& [a, b, c] : solid_) solid.add_triangle(at(a), at(b), at(c)), all.add_triangle(at(a), at(b), at(c));
  for (const auto& [a, b, c] : glass_) all.add_triangle(at(a), at(b), at(c));
  for (const Ball& ball : balls_) solid.add_sphere(ball.center, ball.radius), all.add_sphere(ball.center, ball.radius);
  solid.finish();
  all.finish();

  std::vector<Edge> edges = edges_;
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& x, const Edge& y) { return x.kind < y.kind; });
  std::vector<VectorLine> result;
  for (auto begin = edges.begin(); begin != edges.end();) {
    const auto end = std::find_if(begin, edges.end(), [&](const Edge& edge) { return edge.kind != begin->kind; });
    LineChains chains(sides_);
    const Occluders& hiding = begin->kind == Kind::glass ? all : solid;
    for (auto edge = begin; edge != end; ++edge)
      for (const auto& [from, to] : hiding.visible(at(edge->a), at(edge->b)))
        chains.add({edge->a, edge->b}, at(edge->a).head<2>(), at(edge->b).head<2>(), from, to);
    for (std::vector<double>& places : chains.joined()) {
      result.push_back(look_of(begin->kind));
      result.back().places = std::move(places);
    }
    begin = end;
  }
  return result;
}

}  // namespace orchard::detail
