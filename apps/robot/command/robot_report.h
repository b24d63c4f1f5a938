#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "orchard/spheretree/sphere_audit.h"
#include "robot/link_shape.h"
#include "robot/self_collision.h"
#include "spheres/sphere_files.h"

// What is said of a robot's spheres: a row for each link, and the whole.
namespace orchard::apps {

struct LinkRow {
  std::string link = {};
  Index spheres = 0, switched_off = 0;
  std::string fit = {};                     // of those that were made
  bool kept = true;                         // likewise: what the fit promises
  double grown = 0;                         // likewise: see LinkFit
  const robot::LinkShape* shape = nullptr;  // nothing: the link has no geometry
  std::optional<SphereAudit> audit = {};    // nothing: it has no sphere or no geometry
};

// Areas and volumes of links together. Links without a sphere are open as a whole.
struct RobotFigures {
  Index links = 0, open_links = 0, spheres = 0;
  double area = 0;
  double open_area_lower = 0, open_area_likely = 0, open_area_upper = 0;
  double largest_gap = 0;  // of links with spheres; metres
  std::string gap_link;    // where it is
  Index solid_links = 0;   // those that the figures of solids are of
  double protrusion = 0;   // metres
  std::string protruding_link;
  double solid_volume = 0, union_volume = 0, outside_volume = 0;  // cubic metres, summed over these links
};

bool is_open(const LinkRow& row);
RobotFigures figures_of(const std::vector<LinkRow>& rows);

nlohmann::json to_json(const LinkRow& row);
nlohmann::json to_json(const RobotFigures& figures);

void print_rows(const std::vector<LinkRow>& rows);
void print_figures(const RobotFigures& figures);
void print_self_collision(const robot::SelfCollision& self, const robot::Robot& robot);

// Everything that was left out, decided, repaired or wrapped on the way.
std::vector<std::string> notes_of(const robot::Robot& robot, const std::vector<robot::LinkShape>& shapes);

}  // namespace orchard::apps
