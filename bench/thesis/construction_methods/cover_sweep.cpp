#include "cover_sweep.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include "monotone_curve.h"
#include "orchard/geometry/error.h"
#include "plane_edges.h"

namespace orchard::construction_methods {
namespace {

constexpr double kSliver = 1e-12;  // of the region's size: gaps that are thinner are no gaps

// All curves that may matter, from the region's lowest point on.
class Curves {
 public:
  explicit Curves(std::span<const PlanePoint> region) {
    for (const PlanePoint& p : region) box_.extend(p);
    add_polygon(region, 0);
  }
  const Eigen::AlignedBox2d& box() const { return box_; }
  const std::vector<MonotoneCurve>& all() const { return curves_; }
  // Whether it follows another one on a chain, and so does not start by itself.
  bool follows(Index curve) const { return follows_[curve] != 0; }

  void add(const PlanarShape& shape) {
    if (!shape.corners.empty()) return add_polygon(detail::convex_corners(shape.corners), 1);
    if (!(shape.radius > 0 && std::isfinite(shape.radius)) || !shape.center.allFinite())
      throw InputError("a disk needs a finite centre and a positive radius");
    const PlanePoint half = PlanePoint::Constant(shape.radius);
    if (!box_.intersects(Eigen::AlignedBox2d(shape.center - half, shape.center + half))) return;
    for (const int side : {-1, 1}) {
      MonotoneCurve curve;
      curve.low = shape.center.y() - shape.radius, curve.high = shape.center.y() + shape.radius;
      curve.enters = -side, curve.side = side, curve.center = shape.center, curve.radius = shape.radius;
      keep(curve);
    }
  }

 private:
  // Counter-clockwise corners have the inside on the right of what descends. The region's order does not matter.
  void add_polygon(std::span<const PlanePoint> corners, int shape) {
    Eigen::AlignedBox2d box;
    for (const PlanePoint& p : corners) box.extend(p);
    if (!box_.intersects(box)) return;
    const std::size_t n = corners.size();
    std::vector<Index> edges(n, kNone);
    for (std::size_t i = 0; i < n; ++i) {
      const PlanePoint &p = corners[i], &q = corners[(i + 1) % n];
      if (p.y() == q.y()) continue;
      MonotoneCurve curve;
      curve.low = std::min(p.y(), q.y()), curve.high = std::max(p.y(), q.y());
      curve.enters = shape * (p.y() > q.y() ? 1 : -1);
      curve.center = p.y() < q.y() ? p : q;
      curve.slope = (q.x() - p.x()) / (q.y() - p.y());
      edges[i] = keep(curve);
    }
    for (std::size_t i = 0; i < n; ++i) {  // a chain goes on at corners that are neither its top nor its bottom
      const std::size_t k = (i + 1) % n;
      if (edges[i] == kNone || edges[k] == kNone) continue;
      const bool up = corners[i].y() < corners[k].y(), still_up = corners[k].y() < corners[(k + 1) % n].y();
      if (up && still_up) link(edges[i], edges[k]);
      if (!up && !still_up) link(edges[k], edges[i]);
    }
  }

  Index keep(MonotoneCurve curve) {
    if (curve.high <= box_.min().y() || curve.low >= box_.max().y()) return kNone;
    curve.low = std::max(curve.low, box_.min().y());
    curves_.push_back(curve);
    follows_.push_back(false);
    return static_cast<Index>(curves_.size() - 1);
  }
  void link(Index below, Index above) {
    curves_[below].next = above;
    follows_[above] = true;
  }

  Eigen::AlignedBox2d box_;
  std::vector<MonotoneCurve> curves_;
  std::vector<char> follows_;
};

struct Event {
  enum class Kind { start, crossing, end };
  double y;
  Kind kind;
  Index a, b;  // of a crossing: the curves from left to right before it
};
struct Later {
  bool operator()(const Event& p, const Event& q) const { return p.y != q.y ? p.y > q.y : p.kind > q.kind; }
};

class Sweep {
 public:
  explicit Sweep(const Curves& curves) : curves_(curves.all()), box_(curves.box()), place_(curves_.size(), kNone) {
    std::vector<Event> first;
    for (Index i = 0; i < curves_.size(); ++i)
      if (!curves.follows(i)) first.push_back({curves_[i].low, Event::Kind::start, i, i});
    events_ = std::priority_queue<Event, std::vector<Event>, Later>(Later{}, std::move(first));
    size_ = box_.diagonal().norm();
  }

  SweptCover run() {
    while (!events_.empty() && events_.top().y < box_.max().y()) {
      const Event event = events_.top();
      events_.pop();
      if (event.y > now_ && gap_until(event.y)) return std::move(result_);
      now_ = std::max(now_, event.y);
      handle(event);
    }
    if (!gap_until(box_.max().y())) result_.covered = true;
    return std::move(result_);
  }

 private:
  void handle(const Event& event) {
    switch (event.kind) {
      case Event::Kind::start:
        return start(event.a);
      case Event::Kind::end:
        return end(event.a);
      case Event::Kind::crossing:
        return cross(event.a, event.b);
    }
  }

  void start(Index curve) {
    const MonotoneCurve& c = curves_[curve];
    const double x = c.x_at(now_), slope = c.slope_at(now_);
    const auto at = std::partition_point(line_.begin(), line_.end(), [&](Index other) {
      const double other_x = curves_[other].x_at(now_);
      return other_x != x ? other_x < x : curves_[other].slope_at(now_) < slope;
    });
    const auto place = static_cast<std::size_t>(at - line_.begin());
    line_.insert(at, curve);
    renumber(place);
    events_.push({c.high, Event::Kind::end, curve, curve});
    if (place > 0) expect(line_[place - 1], curve, true);
    if (place + 1 < line_.size()) expect(curve, line_[place + 1], true);
  }

  void end(Index curve) {
    const std::size_t place = place_[curve];
    const Index next = curves_[curve].next;
    place_[curve] = kNone;
    if (next != kNone) {
      line_[place] = next;
      place_[next] = static_cast<Index>(place);
      events_.push({curves_[next].high, Event::Kind::end, next, next});
      if (place > 0) expect(line_[place - 1], next, true);
      if (place + 1 < line_.size()) expect(next, line_[place + 1], true);
      return;
    }
    line_.erase(line_.begin() + static_cast<std::ptrdiff_t>(place));
    renumber(place);
    if (place > 0 && place < line_.size()) expect(line_[place - 1], line_[place], true);
  }

  void cross(Index a, Index b) {
    const std::size_t place = place_[a];
    if (place_[a] == kNone || place + 1 >= line_.size() || line_[place + 1] != b) return;
    ++result_.crossings;
    std::swap(line_[place], line_[place + 1]);
    place_[b] = static_cast<Index>(place), place_[a] = static_cast<Index>(place + 1);
    if (!stale_) {
      gaps_ -= is_gap(place);
      pass(place);
      gaps_ += is_gap(place);
    }
    expect(b, a, false);
    if (place > 0) expect(line_[place - 1], b, true);
    if (place + 2 < line_.size()) expect(a, line_[place + 2], true);
  }

  // New neighbours may have crossed a rounding ago; a pair that has just crossed is not to do so at once again.
  void expect(Index left, Index right, bool are_new) {
    const std::optional<double> y = overtaking(curves_[left], curves_[right]);
    if (!y || (are_new ? *y < now_ - kSliver * size_ : *y <= now_)) return;
    events_.push({*y, Event::Kind::crossing, left, right});
  }

  void renumber(std::size_t from) {
    for (std::size_t k = from; k < line_.size(); ++k) place_[line_[k]] = static_cast<Index>(k);
    stale_ = true;
  }

  // What lies on the right of a place on the line: by how many shapes it is held, and whether it is in the region.
  struct Right {
    int depth = 0;
    bool inside = false;
  };
  void pass(std::size_t place) {
    Right right = place > 0 ? right_[place - 1] : Right{};
    const int enters = curves_[line_[place]].enters;
    right.depth += enters;
    right.inside = right.inside != (enters == 0);
    right_[place] = right;
  }
  bool is_gap(std::size_t place) const { return right_[place].inside && right_[place].depth == 0; }

  // Whether there is a gap between the present line and the one at `y`.
  bool gap_until(double y) {
    if (stale_) {
      right_.resize(line_.size());
      gaps_ = 0;
      for (std::size_t k = 0; k < line_.size(); ++k) {
        pass(k);
        gaps_ += is_gap(k);
      }
      stale_ = false;
    }
    if (gaps_ == 0 || y - now_ <= kSliver * size_) return false;
    const double middle = (now_ + y) / 2;
    for (std::size_t k = 0; k + 1 < line_.size(); ++k) {
      if (!is_gap(k)) continue;
      const double left = curves_[line_[k]].x_at(middle), right = curves_[line_[k + 1]].x_at(middle);
      if (right - left <= kSliver * size_) continue;
      result_.witness = {(left + right) / 2, middle};
      return true;
    }
    return false;
  }

  const std::vector<MonotoneCurve>& curves_;
  const Eigen::AlignedBox2d box_;
  std::vector<Index> place_;  // on the line, by curve
  double size_ = 0, now_ = -std::numeric_limits<double>::infinity();
  std::priority_queue<Event, std::vector<Event>, Later> events_;
  std::vector<Index> line_;  // the curves that it crosses, from left to right
  std::vector<Right> right_;
  std::size_t gaps_ = 0;
  bool stale_ = false;  // right_ is to be found again
  SweptCover result_;
};

}  // namespace

SweptCover cover_by_sweep(std::span<const PlanePoint> region, std::span<const PlanarShape> shapes) {
  Curves curves(region);
  for (const PlanarShape& shape : shapes) curves.add(shape);
  return Sweep(curves).run();
}

}  // namespace orchard::construction_methods
