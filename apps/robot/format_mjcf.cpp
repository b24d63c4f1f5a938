#include <fmt/format.h>
#include <tinyxml2.h>

#include "robot/bodies.h"
#include "robot/format_text.h"

namespace orchard::robot {
namespace {

using tinyxml2::XMLElement;

// The readers refuse bodies that move and have less.
constexpr double kLeastMass = 1e-6, kLeastInertia = 1e-9;

void set_place(const Motion& motion, XMLElement& element) {
  element.SetAttribute("pos", point_text(motion.translation(), " ").c_str());
  const Eigen::Quaterniond q(motion.linear());
  element.SetAttribute("quat", (float_text(q.w()) + " " + point_text(q.vec(), " ")).c_str());
}

class MjcfWriter {
 public:
  explicit MjcfWriter(const SphereModel& model) : model_(model), robot_(*model.robot) {}

  std::string run() {
    document_.InsertEndChild(document_.NewDeclaration());
    XMLElement* root = document_.NewElement("mujoco");
    document_.InsertEndChild(root);
    root->SetAttribute("model", robot_.name.c_str());
    for (const std::string& line : model_.head) root->InsertNewComment(fmt::format(" {} ", harmless(line)).c_str());
    XMLElement* compiler = root->InsertNewChildElement("compiler");
    compiler->SetAttribute("angle", "radian");
    compiler->SetAttribute("boundmass", float_text(kLeastMass).c_str());
    compiler->SetAttribute("boundinertia", float_text(kLeastInertia).c_str());
    XMLElement* world = root->InsertNewChildElement("worldbody");
    for (Index link = 0; link < robot_.links.size(); ++link)
      if (!robot_.joint_above(link)) add_body(link, nullptr, *world);
    add_excluded(*root);
    add_mimics(*root);
    tinyxml2::XMLPrinter printer;
    document_.Print(&printer);
    return printer.CStr();
  }

 private:
  void add_body(Index link, const Joint* above, XMLElement& parent) {
    XMLElement* body = parent.InsertNewChildElement("body");
    body->SetAttribute("name", robot_.links[link].name.c_str());
    if (above != nullptr) set_place(above->origin, *body);
    add_inertial(link, *body);
    if (above != nullptr) add_joint(*above, *body);
    for (std::size_t g = 0; g < model_.groups.size(); ++g)
      if (model_.groups[g].name == robot_.links[link].name)
        for (const Sphere& sphere : model_.groups[g].spheres) add_geom(sphere, *body);
    for (const Joint& joint : robot_.joints)
      if (joint.parent == link) add_body(joint.child, &joint, *body);
  }

  static void add_geom(const Sphere& sphere, XMLElement& body) {
    XMLElement* geom = body.InsertNewChildElement("geom");
    geom->SetAttribute("type", "sphere");
    geom->SetAttribute("pos", point_text(sphere.center, " ").c_str());
    geom->SetAttribute("size", float_text(sphere.radius).c_str());
  }

  // fullinertia is Ixx Iyy Izz Ixy Ixz Iyz.
  void add_inertial(Index link, XMLElement& body) {
    const Inertial* inertial = nullptr;
    if (robot_.links[link].inertial) inertial = &*robot_.links[link].inertial;
    for (std::size_t g = 0; g < model_.groups.size(); ++g)
      if (model_.groups[g].name == robot_.links[link].name) inertial = &model_.bodies[g];
    const Inertial least{kLeastMass, Point::Zero(), kLeastInertia * Eigen::Matrix3d::Identity()};
    if (inertial == nullptr || inertial->mass < kLeastMass || !is_body(*inertial)) inertial = &least;
    XMLElement* element = body.InsertNewChildElement("inertial");
    element->SetAttribute("pos", point_text(inertial->center, " ").c_str());
    element->SetAttribute("mass", float_text(inertial->mass).c_str());
    const Eigen::Matrix3d& i = inertial->inertia;
    element->SetAttribute(
        "fullinertia",
        (point_text(i.diagonal(), " ") + " " + point_text(Point(i(0, 1), i(0, 2), i(1, 2)), " ")).c_str());
  }

  void add_joint(const Joint& joint, XMLElement& body) {
    if (joint.kind == JointKind::fixed || joint.kind == JointKind::floating || joint.kind == JointKind::planar) return;
    XMLElement* element = body.InsertNewChildElement("joint");
    element->SetAttribute("name", joint.name.c_str());
    element->SetAttribute("type", joint.kind == JointKind::prismatic ? "slide" : "hinge");
    element->SetAttribute("axis", point_text(joint.axis, " ").c_str());
    const bool limited =
        joint.kind != JointKind::continuous && joint.limits && joint.limits->lower < joint.limits->upper;
    element->SetAttribute("limited", limited ? "true" : "false");
    if (limited)
      element->SetAttribute("range", (float_text(joint.limits->lower) + " " + float_text(joint.limits->upper)).c_str());
  }

  void add_excluded(XMLElement& root) {
    if (!model_.self) return;
    XMLElement* contact = root.InsertNewChildElement("contact");
    contact->InsertNewComment(fmt::format(" Pairs that need no test, {}. ", harmless(model_.self->in_words())).c_str());
    for (const LinkPair& pair : model_.self->pairs) {
      if (!pair.ignored()) continue;
      XMLElement* exclude = contact->InsertNewChildElement("exclude");
      exclude->SetAttribute("body1", robot_.links[pair.a].name.c_str());
      exclude->SetAttribute("body2", robot_.links[pair.b].name.c_str());
    }
  }

  void add_mimics(XMLElement& root) {
    XMLElement* equality = nullptr;
    for (const Joint& joint : robot_.joints) {
      if (!joint.mimic) continue;
      if (equality == nullptr) equality = root.InsertNewChildElement("equality");
      XMLElement* element = equality->InsertNewChildElement("joint");
      element->SetAttribute("joint1", joint.name.c_str());
      element->SetAttribute("joint2", robot_.joints[joint.mimic->joint].name.c_str());
      element->SetAttribute(
          "polycoef",
          fmt::format("{} {} 0 0 0", float_text(joint.mimic->offset), float_text(joint.mimic->multiplier)).c_str());
    }
  }

  const SphereModel& model_;
  const Robot& robot_;
  tinyxml2::XMLDocument document_;
};

}  // namespace

Files write_mjcf(const SphereModel& model, const FormatOptions& options) {
  return {{options.prefix + ".xml", MjcfWriter(model).run(), "for MuJoCo"}};
}

}  // namespace orchard::robot
