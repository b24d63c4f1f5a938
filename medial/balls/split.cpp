#include "split.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "../quality/boundary_reach.h"

namespace orchard::detail {
namespace {

// Measures cells, reusing errors of the last round: most cells of a round were measured then.
template <class Cell, class Measure>
void measure(CachedCellErrors<Cell>& known, const std::vector<Cell>& now, Measure&& of) {
  std::vector<double> found(now.size());
  std::vector<std::size_t> unknown;
  std::size_t at = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    while (at < known.cells.size() && known.cells[at] < now[i]) ++at;
    if (at < known.cells.size() && known.cells[at] == now[i]) {
      found[i] = known.errors[at];
    } else {
      unknown.push_back(i);
    }
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, unknown.size(), 128), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) found[unknown[i]] = of(now[unknown[i]]);
  });
  known.cells = now;
  known.errors = std::move(found);
}

template <class Cell>
void renumber_cells(CachedCellErrors<Cell>& known, const std::vector<Index>& number) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < known.cells.size(); ++i) {
    Cell cell = known.cells[i];
    for (Index& v : cell) v = number[v];
    if (std::find(cell.begin(), cell.end(), kNone) != cell.end()) continue;
    known.cells[kept] = cell;
    known.errors[kept++] = known.errors[i];
  }
  known.cells.resize(kept);
  known.errors.resize(kept);
}

class Splitter {
 public:
  Splitter(const Surface& surface, BallComplex& complex, const SplitOptions& options, SplitErrors& known)
      : surface_(surface),
        complex_(complex),
        options_(options),
        known_(known),
        cuts_itself_(!surface.self_intersections().empty()) {}

  // Edges that were beyond the tolerance when dividing ended are not divided in later calls. They are marked by a
  // negative error.
  void give_up_what_is_left() {
    for (std::vector<double>* errors : {&known_.edges.errors, &known_.triangles.errors}) {
      for (double& error : *errors) {
        if (error > options_.tolerance) error = -error;
      }
    }
  }

  // Returns for each edge the largest error of the balls on it and on the triangles whose longest edge it is. Edges
  // that were given up have error 0.
  std::vector<double> errors() {
    measure(known_.edges, complex_.edges, [this](const auto& edge) {
      return held(error_of_edge(edge), {edge[0], edge[1], edge[1]});
    });
    measure(known_.triangles, complex_.triangles,
            [this](const auto& triangle) { return held(error_of_triangle(triangle), triangle); });
    std::vector<double> error = known_.edges.errors;
    const EdgeNumbers edge_numbers = complex_.edge_numbers();
    given_up_.assign(error.size(), 0);
    for (Index e = 0; e < error.size(); ++e) given_up_[e] = error[e] < 0 ? 1 : 0;
    for (Index t = 0; t < complex_.triangles.size(); ++t) {
      const double of_triangle = known_.triangles.errors[t];
      if (std::abs(of_triangle) <= options_.tolerance) continue;
      const auto [a, b] = longest_edge(complex_.triangles[t]);
      const Index longest = edge_numbers(a, b);
      error[longest] = std::max(error[longest], of_triangle);
      if (of_triangle < 0) given_up_[longest] = 1;
    }
    return error;
  }

  Index count_undivided(const std::vector<double>& error) const {
    Index count = 0;
    for (Index e = 0; e < error.size(); ++e) count += error[e] > options_.tolerance || given_up_[e] != 0 ? 1 : 0;
    return count;
  }

  // Returns how many edges were divided.
  Index divide(const std::vector<double>& error) {
    std::vector<Index> chosen, cut(complex_.edges.size(), kNone);
    const std::vector<std::uint8_t> never = find_never_linear(error);
    for (Index e = 0; e < error.size(); ++e) {
      if (error[e] <= options_.tolerance || length(complex_.edges[e]) <= options_.min_length || never[e]) continue;
      cut[e] = complex_.size() + static_cast<Index>(chosen.size());
      chosen.push_back(e);
    }
    std::vector<ExactBall> middles(chosen.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, chosen.size(), 64), [&](const auto& range) {
      BallSolver solver(surface_, options_.merging);
      for (std::size_t i = range.begin(); i != range.end(); ++i) {
        const auto& [a, b] = complex_.edges[chosen[i]];
        middles[i] = middle(solver, complex_.balls[a], complex_.balls[b]);
      }
    });
    if (chosen.empty()) return 0;
    complex_.balls.insert(complex_.balls.end(), middles.begin(), middles.end());
    subdivide(complex_, cut);
    return static_cast<Index>(chosen.size());
  }

 private:
  // Returns the ball of the vertex that divides an edge. If the ends belong to different sheets, the exact ball may be
  // close to one of them. Dividing there would not help, so the ball at the middle is used.
  ExactBall middle(BallSolver& solver, const ExactBall& a, const ExactBall& b) const {
    ExactBall exact = solver.between(a, b, 0.5);
    const Point straight = 0.5 * (a.center + b.center);
    const double apart = (a.center - b.center).norm();
    if ((exact.center - straight).norm() <= kMaxAside * apart || !surface_.inside(straight)) return exact;
    return solver.at(straight);
  }

  // Where the surface cuts itself, parts of it lie inside the solid. Distances fall to 0 there, so an edge
  // through one of them has balls that are too large however often it is divided.
  std::vector<std::uint8_t> find_never_linear(const std::vector<double>& error) const {
    std::vector<std::uint8_t> never(error.size(), 0);
    if (!cuts_itself_) return never;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, error.size(), 128), [&](const auto& range) {
      std::vector<Index> crossed;
      for (std::size_t e = range.begin(); e != range.end(); ++e) {
        if (error[e] <= options_.tolerance) continue;
        const auto& [a, b] = complex_.edges[e];
        if (!(complex_.balls[a].radius > 0) || !(complex_.balls[b].radius > 0)) continue;
        const Point &from = complex_.balls[a].center, &to = complex_.balls[b].center;
        crossed.clear();
        surface_.triangles_overlapping({from, to, to}, crossed);
        never[e] = crossed.empty() ? 0 : 1;
      }
    });
    return never;
  }

  // Returns the error measured at the sample places; or, if balls between these places may protrude by more than is
  // promised, at least the amount by which they may.
  double held(double error, const std::array<Index, 3>& cell) const {
    const double limit = kMaxStickingOut * options_.tolerance;
    if (error > options_.tolerance) return error;
    std::array<Sphere, 3> balls;
    for (std::size_t k = 0; k < 3; ++k) balls[k] = {complex_.balls[cell[k]].center, complex_.balls[cell[k]].radius};
    return may_stick_out(surface_, balls, limit) ? limit : error;
  }

  double length(const std::array<Index, 2>& edge) const {
    return (complex_.balls[edge[0]].center - complex_.balls[edge[1]].center).norm();
  }
  std::array<Index, 2> longest_edge(const std::array<Index, 3>& t) const {
    const std::array<std::array<Index, 2>, 3> sides{{{t[0], t[1]}, {t[0], t[2]}, {t[1], t[2]}}};
    return *std::max_element(sides.begin(), sides.end(),
                             [&](const auto& a, const auto& b) { return length(a) < length(b); });
  }
  // Along an edge, both the interpolated radius and the distance change by at most the length travelled, so short edges
  // need no measurement.
  double error_of_edge(const std::array<Index, 2>& edge) const {
    const ExactBall &a = complex_.balls[edge[0]], &b = complex_.balls[edge[1]];
    const double reach = (length(edge) + std::abs(a.radius - b.radius)) / 2;
    if (reach <= options_.tolerance) return 0;
    const auto error_at = [&](double t, double fine) {
      return ball_error(surface_, (1 - t) * a.center + t * b.center, (1 - t) * a.radius + t * b.radius, length(edge),
                        {{&a, 1 - t}, {&b, t}}, fine);
    };
    const int parts = parts_of(length(edge), (a.radius + b.radius) / 2);
    const double small = kSmall * options_.tolerance;
    double worst = error_at(0.5, small);
    if (parts == kMinParts && worst < small) return worst;  // the error at the quarters is then small as well
    for (int i = 1; i < parts; ++i) {
      if (2 * i != parts) worst = std::max(worst, error_at(static_cast<double>(i) / parts, options_.tolerance));
    }
    return worst;
  }
  double error_of_triangle(const std::array<Index, 3>& t) const {
    const ExactBall &a = complex_.balls[t[0]], &b = complex_.balls[t[1]], &c = complex_.balls[t[2]];
    const double longest = std::max({length({t[0], t[1]}), length({t[0], t[2]}), length({t[1], t[2]})});
    const auto error_at = [&](double u, double v) {
      const double w = 1 - u - v;
      return ball_error(surface_, u * a.center + v * b.center + w * c.center,
                        u * a.radius + v * b.radius + w * c.radius, longest, {{&a, u}, {&b, v}, {&c, w}},
                        options_.tolerance);
    };
    const int parts = parts_of(longest, (a.radius + b.radius + c.radius) / 3);
    double worst = error_at(1.0 / 3, 1.0 / 3);
    if (parts == kMinParts) return worst;
    for (int i = 1; i + 1 < parts; ++i) {
      for (int k = 1; i + k < parts; ++k)
        worst = std::max(worst, error_at(static_cast<double>(i) / parts, static_cast<double>(k) / parts));
    }
    return worst;
  }
  // Returns into how many parts the sample places cut a cell. Between two samples that are h apart on an edge, where
  // distances are d, the balls may differ by about h^2 / (8 d) more. This is kept below another tolerance.
  int parts_of(double length, double radius) const {
    const double part = std::min(kPart * options_.tolerance, std::sqrt(8 * options_.tolerance * radius));
    return std::clamp(static_cast<int>(std::ceil(length / part)), kMinParts, kMaxParts);
  }

  static constexpr double kPart = 10;  // tolerances
  static constexpr int kMinParts = 4, kMaxParts = 32;
  static constexpr double kMaxAside = 0.4;  // of an edge's length: how far the dividing vertex may be from the middle
  static constexpr double kSmall = 0.25;
  const Surface& surface_;
  BallComplex& complex_;
  const SplitOptions& options_;
  SplitErrors& known_;
  const bool cuts_itself_;
  std::vector<std::uint8_t> given_up_;  // edges that were given up, and longest edges of such triangles
};

}  // namespace

void SplitErrors::renumber(const std::vector<Index>& number) {
  renumber_cells(edges, number);
  renumber_cells(triangles, number);
}

SplitReport split_nonlinear(const Surface& surface, BallComplex& complex, const SplitOptions& options,
                            SplitErrors& known, const Progress& progress) {
  SplitReport report;
  Splitter splitter(surface, complex, options, known);
  splitter.give_up_what_is_left();
  for (int round = 0;; ++round) {
    const std::vector<double> errors = splitter.errors();
    report.undivided = splitter.count_undivided(errors);
    if (round == options.max_rounds || report.undivided == 0) break;
    const Index divided = splitter.divide(errors);
    if (divided == 0) break;
    report.divided += divided;
    report_progress(progress, "refining the axis", 0.6 + 0.4 * (round + 1) / (options.max_rounds + 1));
  }
  return report;
}

bool becomes_linear(const Surface& surface, const ExactBall& a, const ExactBall& b, const ExactBall& c,
                    const SplitOptions& options) {
  BallComplex alone;
  alone.balls = {a, b, c};
  alone.triangles = {{0, 1, 2}};
  alone.complete();
  SplitErrors errors;
  return split_nonlinear(surface, alone, options, errors, {}).undivided == 0;
}

}  // namespace orchard::detail
