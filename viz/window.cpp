#include "window.h"

#include <vtkCallbackCommand.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>

#include "view_parts.h"

namespace orchard::detail {
namespace {

using Eigen::Vector3d;

constexpr double kOpacityStep = 0.1;
constexpr int kStill = 3;  // in pixels: a click that moves less is not a drag
constexpr const char* kHelp =
    "up, down, 0-9: level    o, O: opacity    click: a sphere's record    r: all    s: save    q: quit";

struct Picked {
  std::size_t tree;
  vtkIdType sphere;
};

// Shows one level of the trees at a time, and handles the commands.
class Scene {
 public:
  explicit Scene(const WindowRequest& request) : request_(request), parts_(view_parts(Blocks(request.vtm))) {
    if (!parts_.any()) throw std::runtime_error(request.vtm.string() + ": this is no scene of orchard view");
    const View view = make_view(request.direction, extents_of(parts_));
    renderer_ = make_renderer(size_of(parts_));
    glass_ = add_still_parts(renderer_, parts_,
                             {.size = size_of(parts_),
                              .line_width = 1.5,
                              .opacity = request.opacity,
                              .backward = std::array{view.backward.x(), view.backward.y(), view.backward.z()}});
    opacity_ = request.opacity;
    add_text(caption_, 0.96, 18, true);
    add_text(help_, 0.02, 13, false);
    help_->SetInput(kHelp);
    const int last = parts_.levels.empty() ? -1 : parts_.levels.rbegin()->first;
    show_level(request.level < 0 ? last : request.level);
  }

  vtkRenderer* renderer() const { return renderer_; }

  void look_at_all(int width, int height) {
    aim(renderer_->GetActiveCamera(), make_view(request_.direction, extents_of(parts_)), width, height, height / 10);
    renderer_->ResetCameraClippingRange();
  }

  void step(int by) {
    const auto shown = parts_.levels.find(level_);
    if (shown == parts_.levels.end()) return;
    if (by > 0 && std::next(shown) != parts_.levels.end()) show_level(std::next(shown)->first);
    if (by < 0 && shown != parts_.levels.begin()) show_level(std::prev(shown)->first);
  }

  void show_level(int level) {
    if (parts_.levels.count(level) == 0) level = parts_.levels.empty() ? -1 : level_;
    for (const auto& actor : spheres_) renderer_->RemoveActor(actor);
    spheres_.clear();
    level_ = level;
    if (const auto trees = parts_.levels.find(level); trees != parts_.levels.end()) {
      spheres_ = level_actors(trees->second);
      for (const auto& actor : spheres_) renderer_->AddActor(actor);
    }
    say(caption_of(parts_, level) + ": " + detail_of(parts_, level));
  }

  void change_opacity(double by) {
    opacity_ = std::clamp(opacity_ + by, 0.0, 1.0);
    for (const auto& actor : glass_) actor->GetProperty()->SetOpacity(opacity_);
    char text[32];
    std::snprintf(text, sizeof text, "opacity %.2f", opacity_);
    say(text);
  }

  // Picks the front sphere at these pixels.
  void pick(int x, int y) {
    const Vector3d from = world(x, y, 0), to = world(x, y, 1);
    const std::optional<Picked> picked = first_hit(from, (to - from).normalized());
    if (picked) say(record(*picked));
  }

 private:
  void add_text(vtkTextActor* actor, double height, int size, bool bold) {
    vtkTextProperty* property = actor->GetTextProperty();
    property->SetFontFamilyToArial();
    property->SetFontSize(size);
    property->SetBold(bold ? 1 : 0);
    property->SetColor(kInk[0], kInk[1], kInk[2]);
    property->SetJustificationToCentered();
    property->SetVerticalJustificationToCentered();
    actor->GetPositionCoordinate()->SetCoordinateSystemToNormalizedViewport();
    actor->GetPositionCoordinate()->SetValue(0.5, height);
    renderer_->AddViewProp(actor);
  }

  void say(const std::string& line) {
    caption_->SetInput(line.c_str());
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  }

  Vector3d world(double x, double y, double depth) const {
    renderer_->SetDisplayPoint(x, y, depth);
    renderer_->DisplayToWorld();
    double point[4];
    renderer_->GetWorldPoint(point);
    return Vector3d(point[0], point[1], point[2]) / point[3];
  }

  std::optional<Picked> first_hit(const Vector3d& from, const Vector3d& along) const {
    std::optional<Picked> best;
    double nearest = std::numeric_limits<double>::infinity();
    const auto trees = parts_.levels.find(level_);
    for (std::size_t tree = 0; trees != parts_.levels.end() && tree < trees->second.size(); ++tree) {
      vtkPolyData* spheres = trees->second[tree].second;
      vtkDataArray* radii = spheres->GetPointData()->GetArray("radius");
      for (vtkIdType i = 0; i < spheres->GetNumberOfPoints(); ++i) {
        Vector3d center;
        spheres->GetPoint(i, center.data());
        const double middle = (center - from).dot(along), radius = radii->GetComponent(i, 0);
        const double half = radius * radius - (center - from - middle * along).squaredNorm();
        if (half < 0 || middle - std::sqrt(half) >= nearest) continue;
        nearest = middle - std::sqrt(half);
        best = Picked{tree, i};
      }
    }
    return best;
  }

  std::string record(const Picked& picked) const {
    const auto& [name, spheres] = parts_.levels.at(level_)[picked.tree];
    const auto value = [&, data = spheres.Get()](const char* array) {
      return require_array(data->GetPointData(), array, data->GetNumberOfPoints())->GetComponent(picked.sphere, 0);
    };
    double center[3];
    spheres->GetPoint(picked.sphere, center);
    char text[512];
    std::snprintf(text, sizeof text, "%s: node %.0f, level %.0f, parent %.0f, centre %.6g %.6g %.6g, radius %.6g",
                  name.c_str(), value("node"), value("level"), value("parent"), center[0], center[1], center[2],
                  value("radius"));
    std::string result = text;
    for (const auto& [array, words] : {std::pair{"error", "at most %.3g outside"}, {"inaccuracy", "inaccuracy %.3g"}}) {
      if (!std::isfinite(value(array))) continue;  // the file does not have it
      std::snprintf(text, sizeof text, words, value(array));
      result += std::string(", ") + text;
    }
    return result;
  }

  const WindowRequest request_;
  ViewParts parts_;
  vtkSmartPointer<vtkRenderer> renderer_;
  std::vector<vtkSmartPointer<vtkActor>> glass_, spheres_;
  vtkNew<vtkTextActor> caption_, help_;
  double opacity_ = 0;
  int level_ = -1;
};

void save(vtkRenderWindow* window, const std::string& png) {
  if (png.empty()) return;
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(window);
  image->ReadFrontBufferOff();
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(png.c_str());
  writer->SetInputConnection(image->GetOutputPort());
  writer->Write();
  std::printf("%s %s\n", writer->GetErrorCode() == 0 ? "saved" : "could not write", png.c_str());
  std::fflush(stdout);
}

// VTK's trackball with keys of our own instead of VTK's.
class Style : public vtkInteractorStyleTrackballCamera {
 public:
  static Style* New();
  vtkTypeMacro(Style, vtkInteractorStyleTrackballCamera)

      void use(Scene* scene, const std::string& png) {
    scene_ = scene;
    png_ = png;
  }

  void OnChar() override {}

  void OnKeyPress() override {
    const std::string key = Interactor->GetKeySym() == nullptr ? "" : Interactor->GetKeySym();
    vtkRenderWindow* window = Interactor->GetRenderWindow();
    if (key == "q" || key == "Escape") return Interactor->TerminateApp();
    if (key == "Up" || key == "plus") scene_->step(1);
    if (key == "Down" || key == "minus") scene_->step(-1);
    if (key.size() == 1 && key[0] >= '0' && key[0] <= '9') scene_->show_level(key[0] - '0');
    if (key == "o") scene_->change_opacity(Interactor->GetShiftKey() != 0 ? kOpacityStep : -kOpacityStep);
    if (key == "O") scene_->change_opacity(kOpacityStep);
    if (key == "r") scene_->look_at_all(window->GetSize()[0], window->GetSize()[1]);
    if (key == "s") save(window, png_);
    window->Render();
  }

  void OnLeftButtonDown() override {
    Interactor->GetEventPosition(pressed_);
    vtkInteractorStyleTrackballCamera::OnLeftButtonDown();
  }

  void OnLeftButtonUp() override {
    vtkInteractorStyleTrackballCamera::OnLeftButtonUp();
    const int* at = Interactor->GetEventPosition();
    if (std::abs(at[0] - pressed_[0]) > kStill || std::abs(at[1] - pressed_[1]) > kStill) return;
    scene_->pick(at[0], at[1]);
    Interactor->GetRenderWindow()->Render();
  }

 private:
  Scene* scene_ = nullptr;
  std::string png_;
  int pressed_[2] = {0, 0};
};
vtkStandardNewMacro(Style);

}  // namespace

void show_window(const WindowRequest& request) {
  Scene scene(request);
  const int width = request.width > 0 ? request.width : 1000, height = request.height > 0 ? request.height : 800;
  vtkNew<vtkRenderWindow> window;
  window->SetWindowName(request.title.empty() ? "orchard view" : request.title.c_str());
  window->SetSize(width, height);
  window->SetMultiSamples(0);
  window->AddRenderer(scene.renderer());
  scene.renderer()->UseFXAAOn();
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(window);
  vtkNew<Style> style;
  style->use(&scene, request.png);
  interactor->SetInteractorStyle(style);
  scene.look_at_all(width, height);
  window->Render();
  interactor->Initialize();
  interactor->Start();
}

}  // namespace orchard::detail
