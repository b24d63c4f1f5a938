#pragma once
#include <span>
#include <string>
#include <string_view>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Builds a graph in space as GraphML: nodes with centre and radius, numbered in their order, and edges that have a
// kind.
class GraphmlText {
 public:
  // `edge_numbers` has the names of the numbers that each edge has.
  GraphmlText(std::string_view graph, std::span<const char* const> edge_numbers);

  void add_node(const Point& center, double radius);
  // Adds an edge with its numbers, which are in the order of their names.
  void add_edge(Index from, Index to, std::span<const double> numbers, std::string_view kind);
  // Returns the whole file. Call it once, after everything has been added.
  std::string finished();

 private:
  void declare(const char* key, const char* of, const char* type);
  void add_number(const char* key, double value);

  std::span<const char* const> edge_numbers_;
  Index nodes_ = 0;
  std::string text_;
};

}  // namespace orchard::detail
