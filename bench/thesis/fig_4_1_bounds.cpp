// Figures 4.1 to 4.4: space-time bounds of an object that moves in the plane, drawn over time:
//   fig_4_1_bounds [folder for the SVG files]
// The bounds are those that the broad phase's methods compare (make_bound()), of a motion whose z is 0. In each picture
// runs a path whose accelerations are drawn at random within M and the half-space. The program checks that the paths
// of 1000 such objects stay inside, prints what the bounds hold, and exits with 1 if one leaves its bound.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "broad_phase_methods/space_time_bound.h"
#include "worlds.h"

namespace {

using namespace orchard::broad_phase_methods;
using orchard::runtime::test::Draw;

using Point = std::array<double, 2>;
using Polygon = std::vector<Point>;  // of a cross section, in x and y

constexpr int kSections = 24;  // cross sections that are drawn
constexpr int kForces = 8;     // changes of the acceleration along a path
constexpr int kPaths = 1000;   // that are checked

Motion motion_of(double radius, bool with_plane) {
  Motion motion;
  motion.position = {0, -0.2, 0};
  motion.velocity = {0.35, 0.5, 0};
  motion.radius = radius;
  motion.acceleration = 1.1;
  if (with_plane) motion.half_space = {0.8, -0.6, 0};
  return motion;
}

// Positions at `steps` + 1 equal times of [0, 1], under piecewise constant accelerations within the motion's bounds.
std::vector<Point> random_path(const Motion& motion, int steps, Draw& draw) {
  std::array<Point, kForces> forces{};
  for (Point& force : forces) {
    const double angle = draw.uniform(0, 2 * std::numbers::pi), size = motion.acceleration * draw.uniform(0.3, 1);
    force = {size * std::cos(angle), size * std::sin(angle)};
    if (force[0] * motion.half_space[0] + force[1] * motion.half_space[1] > 0) force = {-force[0], -force[1]};
  }
  Point x{motion.position[0], motion.position[1]}, v{motion.velocity[0], motion.velocity[1]};
  std::vector<Point> path{x};
  const double h = 1.0 / steps;
  for (int i = 0; i < steps; ++i) {
    const Point& a = forces[static_cast<std::size_t>(i * kForces / steps)];
    for (std::size_t d = 0; d < 2; ++d) x[d] += h * v[d] + h * h / 2 * a[d], v[d] += h * a[d];
    path.push_back(x);
  }
  return path;
}

Polygon circle(const SpaceTimeBound& bound, double t) {
  constexpr int kCorners = 64;
  const auto center = bound.center_at(t);
  const double r = bound.horn_radius(t);
  Polygon result;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    result.push_back({center[0] + r * std::cos(angle), center[1] + r * std::sin(angle)});
  }
  return result;
}

Polygon square(const SpaceTimeBound& bound, double t) {
  const auto c = bound.center_at(t);
  const double h = bound.trapezoid_half(t);
  return {{c[0] - h, c[1] - h}, {c[0] + h, c[1] - h}, {c[0] + h, c[1] + h}, {c[0] - h, c[1] + h}};
}

// How far a point lies in front of the cutting plane.
double in_front(const SpaceTimeBound& bound, double t, const Point& p) {
  const auto c = bound.center_at(t);
  return (p[0] - c[0]) * bound.normal[0] + (p[1] - c[1]) * bound.normal[1] - bound.cut - t * bound.cut_growth;
}

Polygon behind_plane(const SpaceTimeBound& bound, double t, const Polygon& polygon) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double at_p = in_front(bound, t, p), at_q = in_front(bound, t, q);
    if (at_p <= 0) result.push_back(p);
    if ((at_p < 0) == (at_q < 0) || at_p == at_q) continue;
    const double s = at_p / (at_p - at_q);
    result.push_back({p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])});
  }
  return result;
}

double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    twice += p[0] * q[1] - p[1] * q[0];
  }
  return std::abs(twice) / 2;
}

// An oblique view: time to the right, y upwards, x towards the reader.
class Drawing {
 public:
  explicit Drawing(const std::string& title) {
    out_ << "<text x=\"" << kWidth / 2 << "\" y=\"22\" text-anchor=\"middle\" font-weight=\"bold\">" << title
         << "</text>\n";
    line({0, 0}, 0, {0, 0}, 1.12, "stroke=\"#555\"");
    line({0, 0}, 0, {1.1, 0}, 0, "stroke=\"#555\"");
    line({0, 0}, 0, {0, 1.1}, 0, "stroke=\"#555\"");
    label({0, 0}, 1.16, "t");
    label({1.25, 0}, 0, "x");
    label({0, 1.2}, 0, "y");
  }
  void polygon(const Polygon& corners, double t, const std::string& style) {
    out_ << "<path d=\"";
    for (std::size_t i = 0; i < corners.size(); ++i) out_ << (i == 0 ? 'M' : 'L') << place(corners[i], t);
    out_ << "Z\" " << style << "/>\n";
  }
  void line(const Point& from, double t, const Point& to, double end, const std::string& style) {
    out_ << "<path fill=\"none\" d=\"M" << place(from, t) << 'L' << place(to, end) << "\" " << style << "/>\n";
  }
  void path(const std::vector<Point>& points, const std::string& style) {
    out_ << "<path fill=\"none\" d=\"";
    for (std::size_t i = 0; i < points.size(); ++i)
      out_ << (i == 0 ? 'M' : 'L') << place(points[i], static_cast<double>(i) / static_cast<double>(points.size() - 1));
    out_ << "\" " << style << "/>\n";
  }
  std::string svg() const {
    std::ostringstream all;
    all << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << kWidth << "\" height=\"" << kHeight
        << "\" viewBox=\"0 0 " << kWidth << ' ' << kHeight << "\" font-family=\"sans-serif\" font-size=\"13\">\n"
        << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        << out_.str() << "</svg>\n";
    return all.str();
  }

 private:
  static constexpr double kWidth = 560, kHeight = 330;
  static std::string place(const Point& p, double t) {
    std::ostringstream text;
    text << 90 + 370 * t - 52 * p[0] << ',' << 180 - 105 * p[1] + 58 * p[0];
    return text.str();
  }
  void label(const Point& p, double t, const std::string& what) {
    const std::string at = place(p, t);
    const auto comma = at.find(',');
    out_ << "<text x=\"" << at.substr(0, comma) << "\" y=\"" << at.substr(comma + 1) << "\">" << what << "</text>\n";
  }
  std::ostringstream out_;
};

const char* const kHorn = "fill=\"#1f6fb4\" fill-opacity=\"0.07\" stroke=\"#1f6fb4\" stroke-opacity=\"0.55\"";
const char* const kTrapezoid = "fill=\"#d9581c\" fill-opacity=\"0.03\" stroke=\"#d9581c\" stroke-opacity=\"0.6\"";
const char* const kEdge = "stroke=\"#d9581c\" stroke-width=\"1.8\"";
const char* const kRemoved = "fill=\"none\" stroke=\"#999\" stroke-dasharray=\"3 3\"";
const char* const kPlane = "stroke=\"#2e8b4f\" stroke-width=\"1.5\"";
const char* const kPath = "stroke=\"#111\" stroke-width=\"2\"";

double time_of(int section) { return static_cast<double>(section) / kSections; }

void draw_horn(Drawing& drawing, const SpaceTimeBound& bound) {
  for (int i = kSections; i >= 0; --i) drawing.polygon(circle(bound, time_of(i)), time_of(i), kHorn);
}

void draw_trapezoid(Drawing& drawing, const SpaceTimeBound& bound) {
  for (int i = kSections; i >= 0; i -= 4) drawing.polygon(square(bound, time_of(i)), time_of(i), kTrapezoid);
  const Polygon first = square(bound, 0), last = square(bound, 1);
  for (std::size_t k = 0; k < 4; ++k) drawing.line(first[k], 0, last[k], 1, kEdge);
  drawing.polygon(first, 0, "fill=\"none\" stroke=\"#d9581c\" stroke-width=\"1.8\"");
  drawing.polygon(last, 1, "fill=\"none\" stroke=\"#d9581c\" stroke-width=\"1.8\"");
}

// The corners that a clipped square has on the plane, in order along it.
std::array<Point, 2> on_plane(const SpaceTimeBound& bound, double t) {
  Polygon on;
  for (const Point& p : behind_plane(bound, t, square(bound, t)))
    if (std::abs(in_front(bound, t, p)) < 1e-9) on.push_back(p);
  const auto along = [&](const Point& p) { return p[1] * bound.normal[0] - p[0] * bound.normal[1]; };
  const auto [low, high] =
      std::minmax_element(on.begin(), on.end(), [&](const Point& a, const Point& b) { return along(a) < along(b); });
  return {*low, *high};
}

void draw_cut(Drawing& drawing, const SpaceTimeBound& bound) {
  for (int i = kSections; i >= 0; i -= 4) {
    const double t = time_of(i);
    drawing.polygon(square(bound, t), t, kRemoved);
    drawing.polygon(behind_plane(bound, t, square(bound, t)), t, kTrapezoid);
  }
  for (int i = kSections; i > 0; --i) {
    const auto now = on_plane(bound, time_of(i)), before = on_plane(bound, time_of(i - 1));
    drawing.line(now[0], time_of(i), before[0], time_of(i - 1), kPlane);
    drawing.line(now[1], time_of(i), before[1], time_of(i - 1), kPlane);
    drawing.line(now[0], time_of(i), now[1], time_of(i), "stroke=\"#2e8b4f\" stroke-opacity=\"0.5\"");
  }
}

// Paths of points, so that the bound of a body of radius r has to hold the ball around each place.
int count_leaving(const Motion& motion, const SpaceTimeBound& bound) {
  constexpr int kSteps = 96;
  Draw draw(7);
  int leaving = 0;
  for (int k = 0; k < kPaths; ++k) {
    const auto path = random_path(motion, kSteps, draw);
    bool inside = true;
    for (int i = 0; i <= kSteps; ++i) {
      const double t = static_cast<double>(i) / kSteps;
      const Point& p = path[static_cast<std::size_t>(i)];
      const auto c = bound.center_at(t);
      const double x = p[0] - c[0], y = p[1] - c[1], r = motion.radius, half = bound.trapezoid_half(t);
      inside =
          inside && std::hypot(x, y) + r <= bound.horn_radius(t) && std::abs(x) + r <= half && std::abs(y) + r <= half;
      inside = inside && (!bound.has_plane() || in_front(bound, t, p) + r <= 0);
    }
    leaving += !inside;
  }
  return leaving;
}

void print_areas(const SpaceTimeBound& bound) {
  std::printf(
      "| t | parabolic horn (Fig. 4.2) | hypertrapezoid (4.3) | cut by the plane (4.4) | trapezoid over horn | cut "
      "over trapezoid |\n|--:|--:|--:|--:|--:|--:|\n");
  for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const double r = bound.horn_radius(t), horn = std::numbers::pi * r * r;
    const double whole = area(square(bound, t)), cut = area(behind_plane(bound, t, square(bound, t)));
    std::printf("| %.2f | %.3f | %.3f | %.3f | %.2f | %.2f |\n", t, horn, whole, cut, whole / horn, cut / whole);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
  std::filesystem::create_directories(folder);
  const struct {
    const char *name, *title;
    double radius;
    bool trapezoid, plane;
  } figures[] = {{"fig_4.1", "Fig. 4.1: parabolic horn of a point", 0, false, false},
                 {"fig_4.2", "Fig. 4.2: expanded parabolic horn", 0.22, false, false},
                 {"fig_4.3", "Fig. 4.3: hypertrapezoid around the horn", 0.22, true, false},
                 {"fig_4.4", "Fig. 4.4: hypertrapezoid and cutting plane", 0.22, true, true}};
  int leaving = 0;
  for (const auto& figure : figures) {
    const Motion motion = motion_of(figure.radius, figure.plane);
    const SpaceTimeBound bound = make_bound(motion, 0, 1);
    leaving += count_leaving(motion, bound);
    Drawing drawing(figure.title);
    if (!figure.plane) draw_horn(drawing, bound);
    if (figure.trapezoid && !figure.plane) draw_trapezoid(drawing, bound);
    if (figure.plane) draw_cut(drawing, bound);
    Draw draw(3);
    drawing.path(random_path(motion, 96, draw), kPath);
    std::ofstream(folder / (std::string(figure.name) + ".svg")) << drawing.svg();
  }
  std::printf("Paths that leave their bound: %d of %d.\n\n", leaving, 4 * kPaths);
  print_areas(make_bound(motion_of(0.22, true), 0, 1));
  return leaving == 0 ? 0 : 1;
}
