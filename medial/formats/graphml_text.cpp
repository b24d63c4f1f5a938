#include "graphml_text.h"

#include <charconv>
#include <utility>

namespace orchard::detail {

GraphmlText::GraphmlText(std::string_view graph, std::span<const char* const> edge_numbers)
    : edge_numbers_(edge_numbers),
      text_("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n") {
  for (const char* key : {"x", "y", "z", "radius"}) declare(key, "node", "double");
  for (const char* key : edge_numbers) declare(key, "edge", "double");
  declare("kind", "edge", "string");
  text_.append("  <graph id=\"").append(graph).append("\" edgedefault=\"undirected\">\n");
}

void GraphmlText::add_node(const Point& center, double radius) {
  text_ += "    <node id=\"n" + std::to_string(nodes_++) + "\">";
  add_number("x", center.x());
  add_number("y", center.y());
  add_number("z", center.z());
  add_number("radius", radius);
  text_ += "</node>\n";
}

void GraphmlText::add_edge(Index from, Index to, std::span<const double> numbers, std::string_view kind) {
  text_ += "    <edge source=\"n" + std::to_string(from) + "\" target=\"n" + std::to_string(to) + "\">";
  for (std::size_t i = 0; i < numbers.size(); ++i) add_number(edge_numbers_[i], numbers[i]);
  text_.append("<data key=\"kind\">").append(kind).append("</data></edge>\n");
}

std::string GraphmlText::finished() { return std::move(text_) + "  </graph>\n</graphml>\n"; }

void GraphmlText::declare(const char* key, const char* of, const char* type) {
  text_ += "  <key id=\"" + std::string(key) + "\" for=\"" + of + "\" attr.name=\"" + key + "\" attr.type=\"" + type +
           "\"/>\n";
}

void GraphmlText::add_number(const char* key, double value) {
  char digits[32];
  text_.append("<data key=\"").append(key).append("\">");
  text_.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr).append("</data>");
}

}  // namespace orchard::detail
