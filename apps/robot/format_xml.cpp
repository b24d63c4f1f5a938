// URDF, SRDF, and VAMP's JSON that names both.
#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "input/xml_file.h"
#include "robot/format_text.h"
#include "robot/urdf_values.h"

namespace orchard::robot {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

std::string printed(const XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

const apps::SphereGroup* group_of(const SphereModel& model, const std::string& link) {
  for (const apps::SphereGroup& group : model.groups)
    if (group.name == link) return &group;
  return nullptr;
}

void add_comments(const SphereModel& model, XMLElement& root) {
  for (auto line = model.head.rbegin(); line != model.head.rend(); ++line)
    root.InsertFirstChild(root.GetDocument()->NewComment(fmt::format(" {} ", harmless(*line)).c_str()));
}

void add_spheres(const apps::SphereGroup& group, XMLElement& link) {
  for (const Sphere& sphere : group.spheres) {
    XMLElement* collision = link.InsertNewChildElement("collision");
    XMLElement* origin = collision->InsertNewChildElement("origin");
    origin->SetAttribute("xyz", point_text(sphere.center, " ").c_str());
    origin->SetAttribute("rpy", "0 0 0");
    XMLElement* geometry = collision->InsertNewChildElement("geometry");
    geometry->InsertNewChildElement("sphere")->SetAttribute("radius", float_text(sphere.radius).c_str());
  }
}

std::string urdf_name(const FormatOptions& options) { return options.prefix + "-spheres.urdf"; }
std::string srdf_name(const FormatOptions& options) { return options.prefix + ".srdf"; }

// In the frame of the link's first collision element, which is what its readers move with the link.
void add_approximation(const SphereModel& model, const Link& link, XMLElement& root) {
  XMLElement* element = root.InsertNewChildElement("link_sphere_approximation");
  element->SetAttribute("link", link.name.c_str());
  const Motion to_element =
      link.collision.empty() ? Motion(Motion::Identity()) : link.collision.front().origin.inverse();
  const apps::SphereGroup* group = group_of(model, link.name);
  const auto add = [&](const Point& center, double radius) {
    XMLElement* sphere = element->InsertNewChildElement("sphere");
    sphere->SetAttribute("center", point_text(center, " ").c_str());
    sphere->SetAttribute("radius", float_text(radius).c_str());
  };
  if (group == nullptr) return add(Point::Zero(), 0);  // radius 0: without it, readers put a ball around the link
  const bool same = to_element.isApprox(Motion::Identity(), 0);
  for (const Sphere& sphere : group->spheres) {
    const double rounding = same ? 0 : 0x1p-46 * (sphere.center.norm() + to_element.translation().norm());
    add(same ? sphere.center : Point(to_element * sphere.center), sphere.radius + rounding);
  }
}

}  // namespace

Files write_urdf(const SphereModel& model, const FormatOptions& options) {
  XMLDocument document;
  apps::parse_xml(model.robot->file, document, "robot", "URDF");
  XMLElement& root = *document.RootElement();
  for (XMLElement* link = root.FirstChildElement("link"); link != nullptr; link = link->NextSiblingElement("link")) {
    for (const char* kind : {"visual", "collision"})
      while (XMLElement* old = link->FirstChildElement(kind)) link->DeleteChild(old);
    if (const apps::SphereGroup* group = group_of(model, link->Attribute("name")); group != nullptr)
      add_spheres(*group, *link);
  }
  add_comments(model, root);
  return {{urdf_name(options), printed(document), "the robot with spheres as its collision geometry"}};
}

Files write_srdf(const SphereModel& model, const FormatOptions& options) {
  XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  XMLElement* root = document.NewElement("robot");
  document.InsertEndChild(root);
  root->SetAttribute("name", model.robot->name.c_str());
  for (const Link& link : model.robot->links) add_approximation(model, link, *root);
  if (model.self) {
    root->InsertNewComment(fmt::format(" Pairs that need no test, {}. ", harmless(model.self->in_words())).c_str());
    for (const LinkPair& pair : model.self->pairs) {
      if (!pair.ignored()) continue;
      XMLElement* element = root->InsertNewChildElement("disable_collisions");
      element->SetAttribute("link1", model.robot->links[pair.a].name.c_str());
      element->SetAttribute("link2", model.robot->links[pair.b].name.c_str());
      element->SetAttribute("reason", name(pair.verdict));
    }
  }
  add_comments(model, *root);
  return {{srdf_name(options), printed(document), "for MoveIt: spheres, and pairs that need no test"}};
}

Files write_vamp(const SphereModel& model, const FormatOptions& options) {
  std::string identifier = options.prefix;
  for (char& c : identifier)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  if (identifier.empty() || std::isdigit(static_cast<unsigned char>(identifier.front())) != 0)
    identifier.insert(identifier.begin(), 'R');
  identifier.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(identifier.front())));
  std::string output = identifier;
  std::transform(output.begin(), output.end(), output.begin(), [](unsigned char c) { return std::tolower(c); });
  const nlohmann::ordered_json json{{"name", identifier},
                                    {"urdf", urdf_name(options)},
                                    {"srdf", srdf_name(options)},
                                    {"end_effector", tool_frames(model, options).front()},
                                    {"resolution", options.resolution},
                                    {"template", "templates/fk_template.hh"},
                                    {"subtemplates", {{{"name", "ccfk"}, {"template", "templates/ccfk_template.hh"}}}},
                                    {"output", output + "_fk.hh"}};
  Files files = write_urdf(model, options);
  for (FormatFile& file : write_srdf(model, options)) files.push_back(std::move(file));
  files.push_back(
      {options.prefix + "-vamp.json", json.dump(2) + "\n", "for VAMP's generator, which reads both of these"});
  return files;
}

}  // namespace orchard::robot
