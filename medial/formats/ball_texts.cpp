// Reads text formats that have a ball on each line.
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <unordered_map>

#include "axis_text.h"

namespace orchard::detail {
namespace {

void add_ball(ForeignAxis& axis, const TextLines& lines, const Point& center, double radius) {
  if (radius < 0) lines.fail("the radius is negative; it must be 0 or more");
  axis.mesh.centers.push_back(center);
  axis.mesh.radii.push_back(radius);
}

Point read_point(TextLines& lines) {
  const double x = lines.real(), y = lines.real();
  return {x, y, lines.real()};
}

// The numbers at the beginning of a line. No format has more than five; a sixth is read to detect that there are more.
struct Numbers {
  std::array<double, 6> values{};
  std::size_t count = 0;
};
Numbers numbers_of(TextLines& lines, std::optional<double> first) {
  Numbers own;
  if (first) own.values[own.count++] = *first;
  while (own.count < own.values.size() && lines.real_if_any(own.values[own.count])) ++own.count;
  if (!lines.word().empty() && own.count < own.values.size())
    lines.fail("the line has something that is not a finite number");
  return own;
}

}  // namespace

ForeignAxis parse_balls(const std::string& name, std::string text) {
  for (char& c : text) {
    if (c == ',' || c == ';') c = ' ';
  }
  TextLines lines(name, std::move(text));
  ForeignAxis axis;
  std::optional<double> promised;
  std::size_t columns = 0;
  for (bool first = true; lines.next(); first = false) {
    double value = 0;
    const bool bare = lines.real_if_any(value);
    if (!bare && lines.word() != "v") lines.fail("expected \"x y z\", \"x y z r\" or the same after a \"v\"");
    const Numbers own = numbers_of(lines, bare ? std::optional(value) : std::nullopt);
    if (first && bare && own.count == 1) {
      promised = value;
      continue;
    }
    if (own.count != 3 && own.count != 4) lines.fail("expected three or four numbers: x y z, or x y z r");
    if (columns != 0 && own.count != columns)
      lines.fail("expected " + std::to_string(columns) + " numbers, as on the lines before");
    columns = own.count;
    add_ball(axis, lines, {own.values[0], own.values[1], own.values[2]}, columns == 4 ? own.values[3] : 0);
  }
  if (axis.mesh.centers.empty()) lines.fail("the file has no balls; lines \"x y z r\" are expected");
  if (promised && *promised != static_cast<double>(axis.mesh.centers.size()))
    lines.fail("the first line promises another number of balls than the " + std::to_string(axis.mesh.centers.size()) +
               " that follow; the file may be cut off");
  axis.has_radii = columns == 4;
  return axis;
}

ForeignAxis parse_sph_axis(TextLines lines) {
  if (!lines.next()) lines.fail("the file is empty; a .sph file of balls starts with \"4\" and their number");
  const Index columns = lines.index(), count = lines.index();
  if (columns != 3 && columns != 4)
    lines.fail("expected \"4\" and a number of balls, or \"3\" and a number of centres; a sphere-tree is no axis");
  if (count == 0) lines.fail("the file promises no balls");
  ForeignAxis axis;
  axis.has_radii = columns == 4;
  Index deleted = 0;
  for (Index i = 0; i < count; ++i) {
    if (!lines.next())
      lines.fail("the file ends after " + std::to_string(i) + " of " + std::to_string(count) +
                 " balls; it may be cut off, or a sphere-tree, which is no axis");
    const Point center = read_point(lines);
    const double radius = columns == 4 ? lines.real("a radius") : 0;
    std::array<std::int64_t, 3> flags{};  // type, deleted, copies
    const std::size_t flag_count = lines.whole_numbers_to_the_end(flags);
    if (flag_count > 1 && flags[1] != 0 && flags[1] != 1) lines.fail("the flag \"deleted\" is neither 0 nor 1");
    if (flag_count > 1 && flags[1] == 1) {
      ++deleted;
    } else {
      add_ball(axis, lines, center, radius);
    }
  }
  if (lines.next())
    lines.fail("there are more lines than the " + std::to_string(count) + " balls that the first one promises");
  if (axis.mesh.centers.empty()) lines.fail("every ball is flagged as deleted; nothing is left of this axis");
  if (deleted > 0) axis.notes.push_back(std::to_string(deleted) + " balls are flagged as deleted and left out");
  return axis;
}

ForeignAxis parse_swc_axis(TextLines lines) {
  ForeignAxis axis;
  std::unordered_map<std::int64_t, Index> number;
  std::vector<std::int64_t> parents;
  while (lines.next()) {
    const std::int64_t own = lines.whole();
    lines.whole();  // the kind of neurite, which is not used
    const Point center = read_point(lines);
    add_ball(axis, lines, center, lines.real("a radius"));
    const std::int64_t parent = lines.whole();
    if (parent == own) lines.fail("the node is its own parent");
    if (parent < -1) lines.fail("the parent is no node; -1 stands for none");
    if (parent >= 0 && !number.contains(parent)) lines.fail("the parent is not on a line before this one");
    if (!number.emplace(own, axis.mesh.size() - 1).second) lines.fail("the number of this node is used twice");
    if (parent >= 0) axis.mesh.edges.push_back({number.at(parent), axis.mesh.size() - 1});
  }
  if (axis.mesh.centers.empty()) lines.fail("the file has no nodes; lines \"number kind x y z r parent\" are expected");
  complete(axis.mesh);
  return axis;
}

ForeignAxis parse_polylines(TextLines lines) {
  ForeignAxis axis;
  axis.has_radii = false;
  std::map<std::array<double, 3>, Index> number;
  while (lines.next()) {
    const Index count = lines.index();
    if (count < 2) lines.fail("the line has fewer than two points; \"n x y z x y z ..\" is expected");
    Index before = kNone;
    for (Index i = 0; i < count; ++i) {
      const Point place = read_point(lines);
      const auto [at, added] = number.emplace(std::array{place.x(), place.y(), place.z()}, axis.mesh.size());
      if (added) add_ball(axis, lines, place, 0);
      if (before != kNone && before != at->second) axis.mesh.edges.push_back({before, at->second});
      before = at->second;
    }
    if (!lines.word().empty()) lines.fail("the line has more numbers than those of its points");
  }
  if (axis.mesh.centers.empty()) lines.fail("the file has no lines; \"n x y z x y z ..\" is expected");
  complete(axis.mesh);
  return axis;
}

}  // namespace orchard::detail
