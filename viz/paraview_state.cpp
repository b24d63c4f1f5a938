#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <limits>

#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/xml_escaped.h"
#include "paraview_script.h"
#include "vtk_data.h"

// A state lists ParaView's objects ("proxies") by number, each with the properties that differ from what ParaView takes
// by itself, and then the names by which they are found.
namespace orchard {
namespace {

enum Object : int {
  kMeshFile = 101,
  kLevelsFile,
  kColors,
  kOpacities,
  kMeshShown,
  kSpheresShown,
  kLegend,
  kView,
  kLayout,
  kTimes,
  kAnimation,
  kGlyphs  // and the numbers after it
};

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

std::vector<std::string> texts(std::initializer_list<double> numbers) {
  std::vector<std::string> result;
  for (const double number : numbers) result.push_back(digits(number));
  return result;
}

std::vector<std::string> texts(const Vector& v) { return texts({v.x(), v.y(), v.z()}); }

class State {
 public:
  void begin(const char* group, const char* type, Object object) {
    object_ = std::to_string(object);
    text_.append("    <Proxy group=\"").append(group).append("\" type=\"").append(type);
    text_.append("\" id=\"" + object_ + "\">\n");
  }

  void set(const char* property, const std::vector<std::string>& values) {
    begin_property(property, values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      text_ += "        <Element index=\"" + std::to_string(i) + "\" value=\"" + xml_escaped(values[i]) + "\"/>\n";
    text_ += "      </Property>\n";
  }

  void set(const char* property, const std::string& value) { set(property, std::vector<std::string>{value}); }
  void set(const char* property, double value) { set(property, texts({value})); }

  // choices: objects that the property offers in place of this one.
  void link(const char* property, std::initializer_list<Object> objects, const std::vector<Object>& choices = {}) {
    begin_property(property, objects.size());
    for (const Object object : objects) text_ += "        <Proxy value=\"" + std::to_string(object) + "\"/>\n";
    if (!choices.empty()) {
      text_ += "        <Domain name=\"proxy_list\" id=\"" + object_ + "." + property + ".proxy_list\">\n";
      for (const Object object : choices) text_ += "          <Proxy value=\"" + std::to_string(object) + "\"/>\n";
      text_ += "        </Domain>\n";
    }
    text_ += "      </Property>\n";
  }

  void layout_of(Object view) {
    text_ += "      <Layout number_of_elements=\"1\">\n        <Item direction=\"0\" fraction=\"0.5\" view=\"" +
             std::to_string(view) + "\"/>\n      </Layout>\n";
  }

  void end() { text_ += "    </Proxy>\n"; }

  void name(const char* collection, Object object, const std::string& name) {
    names_.append("    <ProxyCollection name=\"").append(collection).append("\">\n      <Item id=\"");
    names_ += std::to_string(object) + "\" name=\"" + xml_escaped(name) + "\"/>\n    </ProxyCollection>\n";
  }

  std::string whole() const {
    return "<ParaView>\n  <ServerManagerState version=\"5.11.0\">\n" + text_ + names_ +
           "  </ServerManagerState>\n</ParaView>\n";
  }

 private:
  void begin_property(const char* property, std::size_t count) {
    text_.append("      <Property name=\"").append(property).append("\" id=\"" + object_ + "." + property);
    text_.append("\" number_of_elements=\"" + std::to_string(count) + "\">\n");
  }

  std::string text_, names_, object_;
};

// Of what the colours stand for, among the spheres that the last level shows.
std::array<double, 2> range(const SphereTree& tree, bool inaccuracy) {
  std::array<double, 2> result{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const SphereNode& node : tree.nodes) {
    if (node.level != tree.depth() && node.child_count > 0) continue;
    const double value = inaccuracy ? node.inaccuracy : node.sphere.radius;
    result = {std::min(result[0], value), std::max(result[1], value)};
  }
  // Two colours at one place are none.
  result[1] = std::max(result[1], result[0] + 1e-9 * std::max(std::abs(result[0]), tree.nodes.front().sphere.radius));
  return result;
}

void add_files(State& state, const std::filesystem::path& files) {
  state.begin("sources", "XMLPolyDataReader", kMeshFile);
  state.set("FileName", files.string() + "-mesh.vtp");
  state.end();
  state.name("sources", kMeshFile, "mesh");
  state.begin("sources", "PVDReader", kLevelsFile);
  state.set("FileName", files.string() + ".pvd");
  state.end();
  state.name("sources", kLevelsFile, "levels");
}

void add_colors(State& state, const std::string& name, const std::array<double, 2>& range) {
  constexpr std::array<std::array<double, 3>, 9> kViridis{{
      {0.267, 0.005, 0.329},
      {0.279, 0.175, 0.483},
      {0.230, 0.322, 0.546},
      {0.173, 0.449, 0.558},
      {0.128, 0.567, 0.551},
      {0.154, 0.680, 0.504},
      {0.361, 0.786, 0.388},
      {0.668, 0.862, 0.196},
      {0.993, 0.906, 0.144},
  }};
  std::vector<std::string> points;
  for (std::size_t i = 0; i < kViridis.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(kViridis.size() - 1);
    for (const double value : {range[0] + t * (range[1] - range[0]), kViridis[i][0], kViridis[i][1], kViridis[i][2]})
      points.push_back(digits(value));
  }
  state.begin("lookup_tables", "PVLookupTable", kColors);
  state.set("RGBPoints", points);
  state.set("ColorSpace", 0);                 // red, green, blue
  state.set("AutomaticRescaleRangeMode", 3);  // to each level's range
  state.set("ScalarRangeInitialized", 1);
  state.link("ScalarOpacityFunction", {kOpacities});
  state.end();
  state.name("lookup_tables", kColors, name + ".PVLookupTable");
  state.begin("piecewise_functions", "PiecewiseFunction", kOpacities);
  state.set("Points", texts({range[0], 0, 0.5, 0, range[1], 1, 0.5, 0}));
  state.set("ScalarRangeInitialized", 1);
  state.end();
  state.name("piecewise_functions", kOpacities, name + ".PiecewiseFunction");
}

void add_shown(State& state, const std::string& color) {
  state.begin("representations", "GeometryRepresentation", kMeshShown);
  state.link("Input", {kMeshFile});
  state.set("Representation", "Surface");
  state.set("Opacity", 0.25);
  for (const char* property : {"AmbientColor", "DiffuseColor"}) state.set(property, texts({0.55, 0.62, 0.70}));
  state.end();
  state.name("representations", kMeshShown, "GeometryRepresentation1");

  // The sphere, and the other shapes that ParaView's list of glyphs would miss.
  std::vector<Object> glyphs;
  for (const char* shape :
       {"SphereSource", "ArrowSource", "ConeSource", "CubeSource", "CylinderSource", "LineSource"}) {
    glyphs.push_back(static_cast<Object>(kGlyphs + glyphs.size()));
    state.begin("sources", shape, glyphs.back());
    if (glyphs.size() == 1)
      for (const char* property : {"ThetaResolution", "PhiResolution"}) state.set(property, 32);
    state.end();
  }
  state.begin("representations", "GeometryRepresentation", kSpheresShown);
  state.link("Input", {kLevelsFile});
  state.set("Representation", "3D Glyphs");
  state.link("GlyphType", {kGlyphs}, glyphs);
  state.set("Scaling", 1);
  state.set("ScaleMode", 1);  // by magnitude
  state.set("SelectScaleArray", "radius");
  state.set("ScaleFactor", 2);  // ParaView's sphere has radius 1/2
  state.set("ColorArrayName", {"0", "0", "0", "0", color});
  state.link("LookupTable", {kColors});
  state.end();
  state.name("representations", kSpheresShown, "GeometryRepresentation2");
}

void add_legend(State& state, const std::string& title) {
  state.begin("representations", "ScalarBarWidgetRepresentation", kLegend);
  for (const char* property : {"Enabled", "Visibility"}) state.set(property, 1);
  state.link("LookupTable", {kColors});
  state.set("Title", title);
  state.set("ComponentTitle", "");
  for (const char* property : {"TitleColor", "LabelColor"}) state.set(property, texts({0.1, 0.1, 0.1}));
  state.set("TitleFontSize", 14);
  state.set("LabelFontSize", 12);
  state.set("ScalarBarLength", 0.3);
  state.set("ScalarBarThickness", 12);
  for (const char* property : {"LabelFormat", "RangeLabelFormat"}) state.set(property, "%.3g");
  state.end();
  state.name("scalar_bars", kLegend, "ScalarBarWidgetRepresentation1");
}

void add_view(State& state, const detail::ParaViewScene& scene, double time) {
  state.begin("views", "RenderView", kView);
  state.link("Representations", {kMeshShown, kSpheresShown, kLegend});
  state.set("UseColorPaletteForBackground", 0);
  state.set("BackgroundColorMode", 0);  // one colour
  state.set("Background", texts({1, 1, 1}));
  state.set("OrientationAxesLabelColor", texts({0.1, 0.1, 0.1}));
  state.set("CameraParallelProjection", 1);
  state.set("CameraParallelScale", scene.half_height);
  state.set("CameraFocalPoint", texts(scene.center));
  state.set("CenterOfRotation", texts(scene.center));
  state.set("CameraPosition", texts(scene.center + 4 * scene.radius * scene.to_eye));
  state.set("CameraViewUp", texts(scene.up));
  state.set("ViewTime", time);
  state.end();
  state.name("views", kView, "RenderView1");
  state.begin("misc", "ViewLayout", kLayout);
  state.layout_of(kView);
  state.end();
  state.name("layouts", kLayout, "Layout #1");
}

void add_time(State& state, Index levels) {
  const double last = levels;
  state.begin("misc", "TimeKeeper", kTimes);
  state.set("Time", last);
  state.link("TimeSources", {kMeshFile, kLevelsFile});
  state.link("Views", {kView});
  state.end();
  state.name("timekeeper", kTimes, "TimeKeeper1");
  state.begin("animation", "AnimationScene", kAnimation);
  state.set("AnimationTime", last);
  state.set("EndTime", last);
  state.set("PlayMode", 2);  // from level to level
  state.link("TimeKeeper", {kTimes});
  state.link("ViewModules", {kView});
  state.end();
  state.name("animation", kAnimation, "AnimationScene1");
}

}  // namespace

void write_paraview_state(const std::filesystem::path& prefix, const PipelineValues& values,
                          const std::filesystem::path& folder) {
  const detail::ParaViewScene scene = detail::paraview_scene(values);
  const std::filesystem::path whole = std::filesystem::absolute(folder).lexically_normal();
  State state;
  add_files(state, whole / prefix.filename());
  add_colors(state, scene.color, range(*values.tree, scene.color == "inaccuracy"));
  add_shown(state, scene.color);
  add_legend(state, scene.color);
  add_view(state, scene, values.tree->depth());
  add_time(state, values.tree->depth());
  write_file(with_ending(prefix, ".pvsm"), state.whole());
}

}  // namespace orchard
