#pragma once
#include <Eigen/Geometry>
#include <utility>
#include <vector>

namespace orchard::detail {

// Joins the visible parts of edges into long lines with few points.
class LineChains {
 public:
  // Lines end at the sides of this rectangle.
  explicit LineChains(const Eigen::AlignedBox2d& sides) : sides_(sides) {}

  // Adds the part from `begin` to `end`, where 0 is a and 1 is b, of an edge between the places numbered `ends`. Parts
  // that end at the same place are joined there, unless a third part does, too.
  void add(std::pair<int, int> ends, const Eigen::Vector2d& a, const Eigen::Vector2d& b, double begin, double end);

  // Returns x, y of each point of each line. Points are left out if the line changes by less than 0.1 without them, and
  // so are shorter lines. An edge without length is a line of one point.
  std::vector<std::vector<double>> joined() const;

 private:
  struct Piece {
    int ends[2];  // -1 if it is cut there
    Eigen::Vector2d places[2];
  };

  Eigen::AlignedBox2d sides_;
  std::vector<Piece> pieces_;
};

}  // namespace orchard::detail
