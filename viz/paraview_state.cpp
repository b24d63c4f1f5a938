#include "orchard/viz/paraview_state.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "orchard/geometry/atomic_file.h"
#include "palette.h"
#include "paraview_script.h"
#include "state_objects.h"

namespace orchard {

using namespace detail;

namespace {

using Object = StateObjects::Object;
constexpr Color kInk{0.1, 0.1, 0.1};

std::vector<std::string> texts(const Color& color) { return StateObjects::texts({color[0], color[1], color[2]}); }

const char* reader_of(const std::filesystem::path& file) {
  if (file.extension() == ".pvd") return "PVDReader";
  return file.extension() == ".vtu" ? "XMLUnstructuredGridReader" : "XMLPolyDataReader";
}

class SceneWriter {
 public:
  SceneWriter(const StateScene& scene, const std::filesystem::path& folder)
      : scene_(scene), folder_(std::filesystem::absolute(folder).lexically_normal()) {}

  std::string run() {
    for (const StateLayer& layer : scene_.layers) add_file(layer);
    for (const StateRange& range : scene_.ranges) add_colors(range);
    for (const StateView& view : scene_.views) add_view(view);
    objects_.link_cameras(views_);
    const Object layout = objects_.begin("misc", "ViewLayout");
    objects_.layout_of(views_);
    objects_.end();
    objects_.name("layouts", layout, "Layout #1");
    add_time();
    return objects_.whole();
  }

 private:
  void add_file(const StateLayer& layer) {
    const Object file = objects_.begin("sources", reader_of(layer.file));
    objects_.set("FileName", (folder_ / layer.file).string());
    objects_.end();
    objects_.name("sources", file, layer.name);
    files_.push_back(file);
  }

  bool has_categories(const std::string& array) const {
    return std::any_of(scene_.layers.begin(), scene_.layers.end(),
                       [&](const StateLayer& layer) { return layer.array == array && layer.categories; });
  }

  std::vector<std::string> color_points(const StateRange& range, bool categories) const {
    const double begin = range.range[0];
    // Two colours at the same value would be invalid.
    const double end = std::max(range.range[1], begin + 1e-9 * std::max(std::abs(begin), scene_.radius));
    std::vector<std::string> points;
    const auto add = [&](double value, const Color& color) {
      for (const std::string& text : StateObjects::texts({value, color[0], color[1], color[2]})) points.push_back(text);
    };
    if (categories) {
      for (int i = 0; i <= static_cast<int>(end - begin); ++i)
        add(begin + i, kDistinct[static_cast<std::size_t>(i) % kDistinct.size()]);
    } else {
      const auto& colors = kViridis.colors;
      for (std::size_t i = 0; i < colors.size(); ++i)
        add(begin + static_cast<double>(i) / static_cast<double>(colors.size() - 1) * (end - begin), colors[i]);
    }
    return points;
  }

  void add_colors(const StateRange& range) {
    const bool categories = has_categories(range.array);
    const Object opacities = objects_.begin("piecewise_functions", "PiecewiseFunction");
    objects_.set("Points", StateObjects::texts({range.range[0], 0, 0.5, 0, range.range[1], 1, 0.5, 0}));
    objects_.set("ScalarRangeInitialized", 1);
    objects_.end();
    objects_.name("piecewise_functions", opacities, range.array + ".PiecewiseFunction");
    const Object colors = objects_.begin("lookup_tables", "PVLookupTable");
    objects_.set("RGBPoints", color_points(range, categories));
    objects_.set("ColorSpace", categories ? 5 : 0);  // steps; red, green, blue
    if (categories) objects_.set("Discretize", 0);
    objects_.set("AutomaticRescaleRangeMode", scene_.last_step ? 3 : -1);  // 3: to the range of each step; -1: never
    objects_.set("ScalarRangeInitialized", 1);
    objects_.link("ScalarOpacityFunction", {opacities});
    objects_.end();
    objects_.name("lookup_tables", colors, range.array + ".PVLookupTable");
    colors_[range.array] = colors;
  }

  Object add_representation(const char* type) {
    const Object object = objects_.begin("representations", type);
    objects_.name("representations", object, std::string(type) + std::to_string(++shown_count_));
    return object;
  }

  // Adds the sphere, and the other shapes, because ParaView's list of glyphs would be incomplete without them.
  std::vector<Object> add_glyphs() {
    std::vector<Object> glyphs;
    for (const char* shape :
         {"SphereSource", "ArrowSource", "ConeSource", "CubeSource", "CylinderSource", "LineSource"}) {
      glyphs.push_back(objects_.begin("sources", shape));
      if (glyphs.size() == 1)
        for (const char* property : {"ThetaResolution", "PhiResolution"}) objects_.set(property, 32);
      objects_.end();
    }
    return glyphs;
  }

  void set_spheres(const StateLayer& layer, const std::vector<Object>& glyphs) {
    objects_.set("Representation", "3D Glyphs");
    objects_.link("GlyphType", {glyphs.front()}, glyphs);
    objects_.set("Scaling", 1);
    const bool fixed = layer.sphere_radius > 0;
    objects_.set("ScaleMode", fixed ? 0 : 1);  // 0: not scaled; 1: by magnitude
    if (!fixed) objects_.set("SelectScaleArray", "radius");
    objects_.set("ScaleFactor", fixed ? 2 * layer.sphere_radius : 2);  // ParaView's sphere has radius 1/2
  }

  Object show(std::size_t number) {
    const StateLayer& layer = scene_.layers[number];
    const bool spheres = layer.look == StateLayer::Look::spheres;
    const std::vector<Object> glyphs = spheres ? add_glyphs() : std::vector<Object>{};
    const Object shown = add_representation(layer.file.extension() == ".vtu" ? "UnstructuredGridRepresentation"
                                                                             : "GeometryRepresentation");
    objects_.link("Input", {files_[number]});
    if (spheres) {
      set_spheres(layer, glyphs);
    } else {
      objects_.set("Representation", layer.look == StateLayer::Look::edges ? "Wireframe" : "Surface");
    }
    objects_.set("LineWidth", layer.width);
    objects_.set("Opacity", layer.opacity);
    if (layer.array.empty()) {
      for (const char* property : {"AmbientColor", "DiffuseColor"}) objects_.set(property, texts(layer.color));
    } else {
      objects_.set("ColorArrayName", {"0", "0", "0", layer.of_cells ? "1" : "0", layer.array});
      objects_.link("LookupTable", {colors_.at(layer.array)});
    }
    objects_.end();
    return shown;
  }

  Object add_legend(const StateRange& range) {
    const Object legend = objects_.begin("representations", "ScalarBarWidgetRepresentation");
    for (const char* property : {"Enabled", "Visibility"}) objects_.set(property, 1);
    objects_.link("LookupTable", {colors_.at(range.array)});
    objects_.set("Title", range.title);
    objects_.set("ComponentTitle", "");
    for (const char* property : {"TitleColor", "LabelColor"}) objects_.set(property, texts(kInk));
    objects_.set("TitleFontSize", 14);
    objects_.set("LabelFontSize", 12);
    objects_.set("ScalarBarLength", 0.3);
    objects_.set("ScalarBarThickness", 12);
    for (const char* property : {"LabelFormat", "RangeLabelFormat"}) objects_.set(property, "%.3g");
    objects_.end();
    objects_.name("scalar_bars", legend, "ScalarBarWidgetRepresentation" + std::to_string(++legend_count_));
    return legend;
  }

  Object add_title(const std::string& title) {
    const Object text = objects_.begin("sources", "TextSource");
    objects_.set("Text", title);
    objects_.end();
    objects_.name("sources", text, "title: " + title);
    const Object shown = add_representation("TextSourceRepresentation");
    objects_.link("Input", {text});
    objects_.set("Color", texts(kInk));
    objects_.set("WindowLocation", 6);  // at the top, in the middle
    objects_.set("FontSize", 11);
    objects_.end();
    return shown;
  }

  // All views have the same colours, so a single legend suffices.
  bool is_last_with(const StateView& view, const std::string& array) const {
    const StateView* last = nullptr;
    for (const StateView& other : scene_.views) {
      if (std::any_of(other.layers.begin(), other.layers.end(),
                      [&](std::size_t layer) { return scene_.layers[layer].array == array; }))
        last = &other;
    }
    return last == &view;
  }

  void add_view(const StateView& view) {
    std::vector<Object> shown;
    for (const std::size_t layer : view.layers) shown.push_back(show(layer));
    for (const StateRange& range : scene_.ranges) {
      if (!range.title.empty() && is_last_with(view, range.array)) shown.push_back(add_legend(range));
    }
    if (!view.title.empty()) shown.push_back(add_title(view.title));
    const Object object = objects_.begin("views", "RenderView");
    objects_.link("Representations", shown);
    objects_.set("UseColorPaletteForBackground", 0);
    objects_.set("BackgroundColorMode", 0);  // a single colour
    objects_.set("Background", StateObjects::texts({1, 1, 1}));
    objects_.set("OrientationAxesLabelColor", texts(kInk));
    set_camera();
    if (scene_.last_step) objects_.set("ViewTime", *scene_.last_step);
    objects_.end();
    views_.push_back(object);
    objects_.name("views", object, "RenderView" + std::to_string(views_.size()));
  }

  void set_camera() {
    objects_.set("CameraParallelProjection", 1);
    // This is half of the height. Several views next to each other are narrower than high.
    const double narrow = scene_.views.size() > 1 ? 1.35 : 1;
    objects_.set("CameraParallelScale", narrow * kParaViewRoom * scene_.radius);
    for (const char* property : {"CameraFocalPoint", "CenterOfRotation"})
      objects_.set(property, StateObjects::texts(scene_.center));
    objects_.set("CameraPosition", StateObjects::texts(scene_.center + 4 * scene_.radius * towards_eye(scene_.up)));
    objects_.set("CameraViewUp", StateObjects::texts(Vector::Unit(static_cast<int>(scene_.up))));
  }

  void add_time() {
    if (!scene_.last_step) return;
    const double last = *scene_.last_step;
    const Object times = objects_.begin("misc", "TimeKeeper");
    objects_.set("Time", last);
    objects_.link("TimeSources", files_);
    objects_.link("Views", views_);
    objects_.end();
    objects_.name("timekeeper", times, "TimeKeeper1");
    const Object animation = objects_.begin("animation", "AnimationScene");
    objects_.set("AnimationTime", last);
    objects_.set("EndTime", last);
    objects_.set("PlayMode", 2);  // one step after another
    objects_.link("TimeKeeper", {times});
    objects_.link("ViewModules", views_);
    objects_.end();
    objects_.name("animation", animation, "AnimationScene1");
  }

  const StateScene& scene_;
  std::filesystem::path folder_;
  StateObjects objects_;
  std::vector<Object> files_, views_;
  std::map<std::string, Object> colors_;
  int shown_count_ = 0, legend_count_ = 0;
};

// Returns the range of the values that the colours represent, over the spheres that the last level shows.
std::array<double, 2> range_of(const SphereTree& tree, bool inaccuracy) {
  std::array<double, 2> result{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const SphereNode& node : tree.nodes) {
    if (node.level != tree.depth() && node.child_count > 0) continue;
    const double value = inaccuracy ? node.inaccuracy : node.sphere.radius;
    result = {std::min(result[0], value), std::max(result[1], value)};
  }
  return result;
}

}  // namespace

void write_paraview_state(const std::filesystem::path& pvsm, const StateScene& scene,
                          const std::filesystem::path& folder) {
  write_file(pvsm, SceneWriter(scene, folder).run());
}

void write_paraview_state(const std::filesystem::path& prefix, const PipelineValues& values,
                          const std::filesystem::path& folder) {
  const ParaViewScene seen = paraview_scene(values);
  const std::string name = prefix.filename().string();
  const StateScene scene{
      .layers = {{.name = "mesh", .file = name + "-mesh.vtp", .opacity = 0.25},
                 {.name = "levels", .file = name + ".pvd", .look = StateLayer::Look::spheres, .array = seen.color}},
      .ranges = {{seen.color, range_of(*values.tree, seen.color == "inaccuracy"), seen.color}},
      .views = {{.title = {}, .layers = {0, 1}}},
      .center = seen.center,
      .radius = seen.radius,
      .up = values.up,
      .last_step = values.tree->depth()};
  write_paraview_state(with_ending(prefix, ".pvsm"), scene, folder);
}

}  // namespace orchard
