#include "robot/command/robot_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "spheres/audit_report.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

constexpr double kMillimetres = 1000;

std::string percent(double part, double whole) { return fmt::format("{:.2f}", 100 * part / whole); }

// "-" where there is nothing to measure.
std::array<std::string, 5> cells(const LinkRow& row) {
  if (row.shape == nullptr) return {"no geometry", "-", "-", "-", "-"};
  if (!row.audit) return {"100", "-", "-", "-", "-"};
  const SphereAudit& audit = *row.audit;
  const std::string open = audit.covered ? "none" : fmt::format("{:.3g}", 100 * audit.likely_open_area / audit.area);
  const std::string gap = audit.covered ? "0" : fmt::format("{:.3g}", kMillimetres * audit.largest_gap.lower);
  if (!audit.beside_solid) return {open, gap, "no solid", "no solid", "no solid"};
  const SphereAudit::BesideSolid& beside = *audit.beside_solid;
  return {open, gap, fmt::format("{:.3g}", kMillimetres * beside.protrusion.lower),
          fmt::format("{:.3g}", kMillimetres * beside.mean.protrusion),
          percent(beside.volume.balls.value, beside.volume.solid)};
}

void add(const LinkRow& row, RobotFigures& figures) {
  figures.spheres += row.spheres;
  if (row.shape == nullptr) return;
  ++figures.links;
  if (is_open(row)) ++figures.open_links;
  if (!row.audit) {
    const double area = row.shape->surface.report().area;
    figures.area += area;
    figures.open_area_lower += area;
    figures.open_area_likely += area;
    figures.open_area_upper += area;
    return;
  }
  const SphereAudit& audit = *row.audit;
  figures.area += audit.area;
  figures.open_area_lower += audit.open_area.lower;
  figures.open_area_likely += audit.likely_open_area;
  figures.open_area_upper += audit.open_area.upper;
  if (audit.largest_gap.lower > figures.largest_gap) {
    figures.largest_gap = audit.largest_gap.lower;
    figures.gap_link = row.link;
  }
  if (!audit.beside_solid) return;
  ++figures.solid_links;
  const SphereAudit::BesideSolid& beside = *audit.beside_solid;
  if (beside.protrusion.lower > figures.protrusion) {
    figures.protrusion = beside.protrusion.lower;
    figures.protruding_link = row.link;
  }
  figures.solid_volume += beside.volume.solid;
  figures.union_volume += beside.volume.balls.value;
  figures.outside_volume += beside.volume.outside.value;
}

}  // namespace

bool is_open(const LinkRow& row) {
  if (row.shape == nullptr) return false;
  return !row.audit || is_open(*row.audit, row.shape->surface);
}

RobotFigures figures_of(const std::vector<LinkRow>& rows) {
  RobotFigures figures;
  for (const LinkRow& row : rows) add(row, figures);
  return figures;
}

json to_json(const LinkRow& row) {
  json report = row.audit ? to_json(*row.audit, row.shape->surface) : json::object();
  report["link"] = row.link;
  report["spheres"] = row.spheres;
  report["switched_off"] = row.switched_off;
  report["geometry"] = row.shape != nullptr;
  if (row.shape == nullptr) return report;
  report["closed"] = !is_open(row);
  report["solid"] = row.shape->surface.solid();
  report["repaired"] = row.shape->repaired;
  report["wrapped"] = row.shape->wrapped;
  report["primitive_deviation"] = row.shape->deviation;
  if (row.fit.empty()) return report;
  report["fit"] = row.fit;
  report["promise_kept"] = row.kept;
  report["radii_grown"] = row.grown;
  return report;
}

json to_json(const RobotFigures& f) {
  json report{{"links", f.links},
              {"open_links", f.open_links},
              {"spheres", f.spheres},
              {"area", f.area},
              {"open_share", {f.open_area_lower / f.area, f.open_area_upper / f.area}},
              {"open_share_likely", f.open_area_likely / f.area},
              {"largest_gap", f.largest_gap},
              {"largest_gap_link", f.gap_link},
              {"solid_links", f.solid_links}};
  if (f.solid_links == 0) return report;
  report["protrusion_max"] = f.protrusion;
  report["protruding_link"] = f.protruding_link;
  report["solid_volume"] = f.solid_volume;
  report["union_over_solid"] = f.union_volume / f.solid_volume;
  report["outside_over_solid"] = f.outside_volume / f.solid_volume;
  return report;
}

void print_rows(const std::vector<LinkRow>& rows) {
  std::size_t width = 4;
  for (const LinkRow& row : rows) width = std::max(width, row.link.size());
  fmt::print("{:{}}  spheres  open %   gap mm  sticks out mm     mean  union %\n", "link", width);
  for (const LinkRow& row : rows) {
    const auto [open, gap, protrusion, mean, volume] = cells(row);
    fmt::print("{:{}}  {:>7}  {:>6}  {:>7}  {:>13}  {:>7}  {:>7}{}{}\n", row.link, width, row.spheres, open, gap,
               protrusion, mean, volume, row.switched_off > 0 ? fmt::format("  {} switched off", row.switched_off) : "",
               row.fit.empty() || row.fit == "cover" ? "" : "  " + row.fit);
  }
}

void print_figures(const RobotFigures& f) {
  fmt::print("the robot: {} spheres on {} links; {} % of the surface is open", f.spheres, f.links,
             f.open_area_upper == 0 ? "0" : fmt::format("{:.3g}", 100 * f.open_area_likely / f.area));
  if (f.largest_gap > 0) fmt::print(", gaps up to {:.3g} mm ({})", kMillimetres * f.largest_gap, f.gap_link);
  fmt::print("\n");
  if (f.solid_links == 0) return;
  fmt::print("  {}sticks out up to {:.3g} mm ({}); unions have {} % of the solids' volume, {} % lies outside\n",
             f.solid_links < f.links ? fmt::format("of the {} links that are solids: ", f.solid_links) : std::string(),
             kMillimetres * f.protrusion, f.protruding_link, percent(f.union_volume, f.solid_volume),
             percent(f.outside_volume, f.solid_volume));
}

void print_self_collision(const robot::SelfCollision& self, const robot::Robot& robot) {
  std::array<Index, 5> counts{};
  for (const robot::LinkPair& pair : self.pairs) ++counts[static_cast<std::size_t>(pair.verdict)];
  const auto count = [&](robot::PairVerdict verdict) { return counts[static_cast<std::size_t>(verdict)]; };
  using robot::PairVerdict;
  fmt::print("self-collision: of {} pairs, {} adjacent, {} never and {} always touch, {} are to be tested\n  {}\n",
             self.pairs.size(), count(PairVerdict::adjacent), count(PairVerdict::never),
             count(PairVerdict::always) + count(PairVerdict::spheres_always), count(PairVerdict::sometimes),
             self.in_words());
  for (const robot::LinkPair& pair : self.pairs)
    if (pair.verdict == PairVerdict::spheres_always)
      fmt::print(
          "  {} and {}: their spheres touch in every state, and they themselves in {:.3g} %: with these spheres the "
          "pair cannot be tested\n",
          robot.links[pair.a].name, robot.links[pair.b].name, 100.0 * pair.touching / self.states);
}

std::vector<std::string> notes_of(const robot::Robot& robot, const std::vector<robot::LinkShape>& shapes) {
  std::vector<std::string> notes = robot.notes;
  for (const robot::LinkShape& shape : shapes)
    for (const std::string& note : shape.notes)
      notes.push_back(fmt::format("link {}: {}", robot.links[shape.link].name, note));
  return notes;
}

}  // namespace orchard::apps
