// Tests whether the balls of a file fit the mesh that they are read with, and if not, in which frame they would.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/medial/read_axis.h"
#include "orchard/medial/topology.h"

namespace orchard {
namespace {

constexpr Index kLookedAt = 300;  // balls at most, evenly chosen: a median needs no more
constexpr double kSampleOnSurface =
    1e-6;                           // of the diagonal: centres nearer than this are vertices or samples of the surface
constexpr double kUnfilled = 0.1;   // of the diagonal: axes in few balls leave so much of the solid's box empty
constexpr double kSameFrame = 0.3;  // of the diagonal: a frame that moves no corner of the box by more is the same one
constexpr double kMostly = 0.9;     // of all balls
constexpr double kFits = 0.25;      // of what it was: a frame that makes it so much better is named
constexpr double kFarOff = 3;       // times tolerance::kFrameError: no frame need fit for a refusal

// A map from the file's coordinates to the mesh's: first axes are exchanged, then it scales, then it moves.
struct Frame {
  std::array<int, 3> axes{0, 1, 2};
  std::array<int, 3> signs{1, 1, 1};
  double scale = 1;
  Vector move = Vector::Zero();

  Point operator()(const Point& p) const {
    Point q;
    for (int i = 0; i < 3; ++i) {
      const auto k = static_cast<std::size_t>(i);
      q[i] = signs[k] * p[axes[k]];
    }
    return scale * q + move;
  }
};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string in_words(const Frame& frame) {
  std::string text;
  if (frame.axes != std::array{0, 1, 2}) {
    text += "with axes (";
    for (std::size_t i = 0; i < 3; ++i)
      text += (i > 0 ? ", " : "") + std::string(frame.signs[i] < 0 ? "-" : "") + "xyz"[frame.axes[i]];
    text += "), ";
  }
  return text + "scaled by " + number(frame.scale) + " and then moved by (" + number(frame.move.x()) + ", " +
         number(frame.move.y()) + ", " + number(frame.move.z()) + ")";
}

// How an axis is to fit the surface: its balls touch the surface; its centres lie inside; or its centres lie on the
// surface itself (then it is a copy of the surface).
enum class Fit : std::uint8_t { balls, inside, surface };

class FrameFinder {
 public:
  FrameFinder(const Surface& surface, const ForeignAxis& axis, Fit fit)
      : surface_(surface), diagonal_(surface.bounding_box().diagonal().norm()), fit_(fit) {
    const MedialMesh& mesh = axis.mesh;
    const Index step = std::max<Index>(mesh.size() / kLookedAt, 1);
    const bool radii = fit == Fit::balls;
    for (Index i = 0; i < mesh.size(); i += step) balls_.push_back({mesh.centers[i], radii ? mesh.radii[i] : 0});
    for (Index i = 0; i < mesh.size(); ++i) {
      const Vector reach = Vector::Constant(radii ? mesh.radii[i] : 0);
      box_.extend(mesh.centers[i] - reach).extend(mesh.centers[i] + reach);
    }
  }

  // The median, as a fraction of the diagonal, of the balls' distances from touching the surface; for centres without
  // radii, of their distances outside the solid.
  double median(const Frame& frame) const {
    std::vector<double> errors;
    for (const auto& [center, radius] : balls_) {
      const double depth = -surface_.signed_distance(frame(center));
      errors.push_back(fit_ == Fit::inside ? std::max(-depth, 0.0) : std::abs(frame.scale * radius - depth));
    }
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    return *middle / diagonal_;
  }
  // The median, plus how far the box of the balls is from the solid's box: the median alone would favour frames that
  // make everything small.
  double error(const Frame& frame) const {
    return median(frame) + (fit_ == Fit::inside ? size_error(frame.scale) : box_error(frame));
  }

  // The farthest that the frame moves a corner of the solid's box, as a fraction of the diagonal.
  double moved(const Frame& frame) const {
    double farthest = 0;
    for (int i = 0; i < 8; ++i) {
      const Point corner = surface_.bounding_box().corner(static_cast<Box::CornerType>(i));
      farthest = std::max(farthest, (frame(corner) - corner).norm());
    }
    return farthest / diagonal_;
  }

  // Whether nearly all centres are on the surface.
  bool on_surface(const Frame& frame) const {
    const auto near = std::count_if(balls_.begin(), balls_.end(), [&](const Sphere& ball) {
      return surface_.distance(frame(ball.center)) < kSampleOnSurface * diagonal_;
    });
    return balls_.size() > 3 && static_cast<double>(near) > kMostly * static_cast<double>(balls_.size());
  }

  Frame best() const {
    Frame best;
    double min = std::numeric_limits<double>::infinity();
    for (const Frame& frame : candidates()) {
      const double own = error(frame);
      if (own < min) min = own, best = frame;
    }
    return best;
  }

 private:
  // How far the size of the centres' box is outside the range that is usual, as a part of the solid's box. Without this
  // condition a frame that shrinks all centres to a point inside would fit.
  double size_error(double scale) const {
    const double ratio = scale * box_.diagonal().norm() / diagonal_;
    return ratio > 1.5 ? ratio - 1.5 : ratio < 0.25 ? 0.25 - ratio : 0;
  }

  double box_error(const Frame& frame) const {
    const Point a = frame(box_.min()), b = frame(box_.max());
    const Box own(a.cwiseMin(b), a.cwiseMax(b));
    const Box& wanted = surface_.bounding_box();
    const double off =
        std::max((own.min() - wanted.min()).cwiseAbs().maxCoeff(), (own.max() - wanted.max()).cwiseAbs().maxCoeff());
    return std::max(0.0, off / diagonal_ - kUnfilled);
  }

  // The inverses of the frames into which programs commonly bring a mesh before they compute: the lowest corner or the
  // middle of its box at 0; the longest side, the diagonal or half of either scaled to a round length. Also the
  // identity, and the frame in which the boxes of balls and mesh agree. Each as it is and with y and z exchanged.
  std::vector<Frame> candidates() const {
    std::vector<Frame> all;
    const Box& box = surface_.bounding_box();
    const double side = box.sizes().maxCoeff();
    for (const Frame& turned : {Frame{}, Frame{{0, 2, 1}, {1, -1, 1}}, Frame{{0, 2, 1}, {1, 1, -1}}}) {
      for (const double length : {1.0, 2.0, 10.0, 100.0, 1000.0}) {
        for (const double own : {side, diagonal_}) {
          for (const Point& at : {Point(box.min()), Point(box.center())}) {
            Frame frame = turned;
            frame.scale = own / length;
            frame.move = at;
            all.push_back(frame);
          }
        }
      }
      all.push_back(turned);
      all.push_back(fitted(turned));
    }
    return all;
  }
  Frame fitted(Frame frame) const {
    const double own = box_.diagonal().norm();
    frame.scale = own > 0 ? diagonal_ / own : 1;
    frame.move = surface_.bounding_box().center() - frame(box_.center());
    return frame;
  }

  const Surface& surface_;
  double diagonal_;
  Fit fit_;
  std::vector<Sphere> balls_;
  Box box_;
};

std::string name_of(const ForeignAxis& axis) { return axis.files.empty() ? "the axis" : axis.files.front().string(); }

void refuse_surface(const ForeignAxis& axis) {
  const bool unit = axis.has_radii && std::all_of(axis.mesh.radii.begin(), axis.mesh.radii.end(),
                                                  [](double radius) { return radius == 1; });
  throw InputError(name_of(axis) + ": the cells of this axis are the input surface" +
                   (unit ? " with radius 1" : ": its vertices lie on the mesh") +
                   ", which is where programs start from, not a medial axis");
}

void check_frame(const Surface& surface, const ForeignAxis& axis) {
  const std::vector<double>& radii = axis.mesh.radii;
  if (!axis.has_radii || std::all_of(radii.begin(), radii.end(), [&](double r) { return r == radii.front(); })) {
    const FrameFinder copies(surface, axis, Fit::surface);
    // An axis of lines and points alone can be scaled onto many surfaces (a ring's circle, made larger, lies on the
    // ring), so only one with triangles is tried in other frames.
    const bool surface_like = !axis.mesh.triangles.empty();
    if (copies.on_surface({}) || (surface_like && copies.on_surface(copies.best()))) refuse_surface(axis);
  }
  const FrameFinder finder(surface, axis, axis.has_radii ? Fit::balls : Fit::inside);
  const double now = finder.error({}), balls_off = finder.median({});
  if (now <= tolerance::kFrameError) return;
  const Frame best = finder.best();
  // A coarse axis, whose balls are too large, would always fit better if it were a little smaller: such a frame is not
  // reported as another one.
  const bool other = finder.moved(best) > kSameFrame;
  const double then = finder.error(best);
  const std::string off = name_of(axis) + ": the balls do not lie near the mesh: half of them are off its surface by " +
                          number(100 * balls_off) + " % of its diagonal or more, or they fill another box";
  if (other && then < kFits * now && then <= tolerance::kFrameError)
    throw InputError(off + "; they would be off by " + number(100 * finder.median(best)) + " % if they were " +
                     in_words(best) + ", so the file is in another frame than the mesh");
  if (balls_off > kFarOff * tolerance::kFrameError)
    throw InputError(off + ", and no frame that programs commonly use fits; is it the axis of this mesh?");
}

std::string in_words(const Topology& topology) {
  const auto count = [](std::int64_t number, const char* noun) {
    return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
  };
  return count(topology.components, "component") + ", " + count(topology.loops, "loop") + ", " +
         std::to_string(topology.cavities) + (topology.cavities == 1 ? " cavity" : " cavities");
}

void connect(const Surface& surface, PlacedAxis& placed) {
  ConnectedBalls connected = connect_balls(surface, placed.mesh);
  placed.mesh = std::move(connected.mesh);
  placed.connected = true;
  placed.notes.push_back("the file has no cells: its balls are connected by their power diagram within the solid" +
                         (connected.left_out > 0
                              ? "; " + std::to_string(connected.left_out) + " without a part of it are left out"
                              : std::string()));
  const Topology found = topology(placed.mesh), wanted = solid_topology(surface);
  if (found == wanted) return;
  placed.notes.push_back("so connected they have " + in_words(found) + ", the solid has " + in_words(wanted) +
                         ": where one ball is the nearest to two pieces of the solid, or two balls meet in two places, "
                         "the diagram does not tell these apart; more balls there would");
}

}  // namespace

PlacedAxis place_axis(const Surface& surface, ForeignAxis axis, const PlaceOptions& options) {
  if (!surface.solid())
    throw InputError("the medial axis needs a solid: " + surface.report().faults() + "; repair the mesh first");
  check_frame(surface, axis);
  PlacedAxis placed{.mesh = std::move(axis.mesh), .structure = std::move(axis.structure), .notes = axis.notes};
  if (!axis.has_radii) {
    for (Index i = 0; i < placed.mesh.size(); ++i) placed.mesh.radii[i] = surface.distance(placed.mesh.centers[i]);
    placed.notes.push_back("the file has no radii: each is the distance of its centre to the surface");
  }
  placed.radii_found = !axis.has_radii;
  if (placed.mesh.edges.empty()) {
    if (options.connect) {
      connect(surface, placed);
    } else if (placed.mesh.size() > 1) {
      placed.notes.push_back("the file has no cells: its balls are measured alone");
    }
  }
  return placed;
}

}  // namespace orchard
