#pragma once
#include <Eigen/Geometry>
#include <utility>
#include <vector>

namespace orchard::detail {

// Joins the visible parts of edges to long lines with few points.
class LineChains {
 public:
  // Lines end at the sides of this rectangle.
  explicit LineChains(const Eigen::AlignedBox2d& sides) : sides_(sides) {}

  // The part from `begin` to `end`, 0 being a and 1 being b, of an edge between the places numbered `ends`. Parts that
  // share a number are joined there if no third part has it.
  void add(std::pair<int, int> ends, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double begin, double end);

  // x, y of each point of each line. Points are left out where a line changes by less than 0.1 without them, and so are
  // lines that are shorter; an edge without a length is a line of one point.
  std::vector<std::vector<double>> joined() const;

 private:
  struct Piece {
    int ends[2];  // -1: cut here
    Eigen::Vector2d places[2];
  };

  Eigen::AlignedBox2d sides_;
  std::vector<Piece> pieces_;
};

}  // namespace orchard::detail
