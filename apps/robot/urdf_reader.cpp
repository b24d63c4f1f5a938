#include "robot/urdf_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "input/xml_file.h"
#include "orchard/geometry/error.h"
#include "robot/mesh_search.h"
#include "robot/urdf_joints.h"
#include "robot/urdf_values.h"

namespace orchard::robot {
namespace {

namespace fs = std::filesystem;
using apps::at_line;
using apps::children_of;
using tinyxml2::XMLElement;

class Reader {
 public:
  Reader(const fs::path& file, const UrdfOptions& options) : file_(file), options_(options) { robot_.file = file; }

  Robot run() {
    tinyxml2::XMLDocument document;
    if (file_.extension() == ".xacro") refuse_xacro();
    const XMLElement& root = apps::parse_xml(file_, document, "robot", "URDF");
    if (const char* name = root.Attribute("name"); name != nullptr) robot_.name = name;
    note_unknown(root, {"link", "joint", "material", "transmission", "gazebo"});
    for (const XMLElement* link : children_of(root, "link")) add_link(*link);
    if (robot_.links.empty()) throw InputError(file_.string() + ": the file has no link");
    read_joints(root, robot_);
    require_meshes();
    add_notes();
    return std::move(robot_);
  }

 private:
  [[noreturn]] void refuse_xacro() const {
    throw InputError(fmt::format("{}: this is xacro, from which a URDF is made; expand it first: xacro {} > {}",
                                 file_.string(), file_.string(),
                                 fs::path(file_.stem()).replace_extension(".urdf").string()));
  }

  // Equal messages are counted, so that each is printed once.
  void note_unknown(const XMLElement& parent, const std::set<std::string>& known) {
    for (const XMLElement* child = parent.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
      const std::string name = child->Name();
      if (name.starts_with("xacro:")) refuse_xacro();
      if (known.contains(name)) continue;
      auto& [line, count] = unknown_[fmt::format("<{}> in <{}>", name, parent.Name())];
      if (count++ == 0) line = child->GetLineNum();
    }
  }

  void add_link(const XMLElement& element) {
    Link link;
    link.name = required(element, "name", file_);
    link.line = element.GetLineNum();
    if (robot_.find_link(link.name))
      throw InputError(fmt::format("{}: there is already a link {}", at_line(file_, element), link.name));
    note_unknown(element, {"inertial", "visual", "collision", "contact", "sensor", "self_collision_checking"});
    for (const XMLElement* one : children_of(element, "collision")) add_element(*one, Geometry::collision, link);
    for (const XMLElement* one : children_of(element, "visual")) add_element(*one, Geometry::visual, link);
    if (const XMLElement* inertial = element.FirstChildElement("inertial"); inertial != nullptr)
      link.inertial = read_inertial(*inertial, file_);
    robot_.links.push_back(std::move(link));
  }

  void add_element(const XMLElement& element, Geometry kind, Link& link) {
    note_unknown(element, {"origin", "geometry", "material", "verbose"});
    const XMLElement* geometry = element.FirstChildElement("geometry");
    if (geometry == nullptr) throw InputError(at_line(file_, element) + ": the element has no <geometry>");
    const XMLElement* shape = geometry->FirstChildElement();
    if (shape == nullptr)
      throw InputError(at_line(file_, *geometry) + ": the element is empty; give it a mesh or a shape");
    Element read;
    read.line = shape->GetLineNum();
    read.origin = read_origin(element, file_);
    if (!read_shape(*shape, read)) {
      note_unknown(*geometry, {});
      return;
    }
    if (read.shape == Shape::mesh) find(*shape, kind, read);
    (kind == Geometry::collision ? link.collision : link.visual).push_back(std::move(read));
  }

  bool read_shape(const XMLElement& shape, Element& read) {
    const std::string name = shape.Name();
    const auto sizes = [&](const char* radius, const char* length) {
      read.size.x() = positive(shape, radius, file_);
      if (length != nullptr) read.size.y() = positive(shape, length, file_);
    };
    if (name == "box") {
      read.shape = Shape::box;
      read.size = positive_vector(shape, "size", file_);
    } else if (name == "cylinder" || name == "capsule") {
      read.shape = name == "capsule" ? Shape::capsule : Shape::cylinder;
      sizes("radius", "length");
      if (name == "capsule")
        note_once(shape, "a capsule is no part of the URDF standard: its length is that without the caps");
    } else if (name == "sphere") {
      read.shape = Shape::sphere;
      sizes("radius", nullptr);
    } else {
      return name == "mesh";
    }
    return true;
  }

  void find(const XMLElement& mesh, Geometry kind, Element& read) {
    read.written = required(mesh, "filename", file_);
    if (mesh.Attribute("scale") != nullptr) read_scale(mesh, read);
    if (kind != options_.geometry) return;
    FoundMesh found = find_mesh(read.written, file_, options_.packages);
    read.file = found.file;
    if (!found.note.empty()) note_once(mesh, read.written + ": " + found.note);
    if (read.file.empty()) missing_.push_back(in_words(mesh, read, found));
  }

  void read_scale(const XMLElement& mesh, Element& read) {
    const std::string text = mesh.Attribute("scale");
    const bool one = text.find_first_of(" \t", text.find_first_not_of(" \t")) == std::string::npos;
    const std::vector<double> scale = apps::numbers_in(text, one ? 1 : 3, at_line(file_, mesh), "scale");
    read.scale = one ? Vector::Constant(scale[0]).eval() : Vector(scale[0], scale[1], scale[2]);
    if (one) note_once(mesh, "a scale of one number is no part of the URDF standard: it counts along all axes");
    if (!read.scale.allFinite() || (read.scale.array() == 0).any())
      throw InputError(at_line(file_, mesh) + ": scale must consist of finite numbers other than 0");
  }

  std::string in_words(const XMLElement& mesh, const Element& read, const FoundMesh& found) const {
    std::vector<std::string> tried;
    for (const fs::path& place : found.tried) tried.push_back(place.string());
    std::string text = fmt::format("line {}: {} (tried {}", mesh.GetLineNum(), read.written, fmt::join(tried, ", "));
    for (const fs::path& place : found.tried)
      if (const fs::path other = other_case(place); !other.empty())
        text += fmt::format("; there is {}, whose letters have another case", other.filename().string());
    return text + ")";
  }

  void note_once(const XMLElement& element, const std::string& what) {
    auto& [line, count] = unusual_[what];
    if (count++ == 0) line = element.GetLineNum();
  }

  void require_meshes() const {
    if (missing_.empty()) return;
    throw InputError(fmt::format(
        "{}: {} missing: {}; give --package-path for the packages of package://", file_.string(),
        missing_.size() == 1 ? "a mesh is" : fmt::format("{} meshes are", missing_.size()), fmt::join(missing_, "; ")));
  }

  void add_notes() {
    const auto more = [](int count) { return count > 1 ? fmt::format(", and {} more", count - 1) : std::string(); };
    for (const auto& [what, seen] : unknown_)
      robot_.notes.push_back(fmt::format("{}, line {}{}: {} is not known and left out", file_.string(), seen.first,
                                         more(seen.second), what));
    for (const auto& [what, seen] : unusual_)
      robot_.notes.push_back(fmt::format("{}, line {}{}: {}", file_.string(), seen.first, more(seen.second), what));
    for (const Link& link : robot_.links)
      if (elements_of(link, options_.geometry).empty() && !(link.collision.empty() && link.visual.empty()))
        robot_.notes.push_back(fmt::format("{}, line {}: link {} has {} geometry alone, and gets no spheres",
                                           file_.string(), link.line, link.name,
                                           options_.geometry == Geometry::collision ? "visual" : "collision"));
  }

  const fs::path& file_;
  const UrdfOptions& options_;
  Robot robot_;
  std::map<std::string, std::pair<int, int>> unknown_, unusual_;  // first line, number
  std::vector<std::string> missing_;
};

}  // namespace

Robot read_urdf(const fs::path& file, const UrdfOptions& options) { return Reader(file, options).run(); }

const std::vector<Element>& elements_of(const Link& link, Geometry geometry) {
  return geometry == Geometry::collision ? link.collision : link.visual;
}

}  // namespace orchard::robot
