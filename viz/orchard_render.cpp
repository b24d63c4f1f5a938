// orchard-render FOLDER PICTURE.png WIDTH HEIGHT UP [TITLE]: draws the files of write_pipeline() in FOLDER, on the
// display of $DISPLAY. A program of its own because VTK aborts where there is no display (see orchard/viz/render.h).
#include <vtkAutoInit.h>
#include <vtkCamera.h>
#include <vtkImageData.h>
#include <vtkImageShrink3D.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkRenderWindow.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <stdexcept>

#include "panels.h"

namespace {

using Eigen::Vector3d;
using namespace orchard::detail;

constexpr int kOversampling = 2;                      // pixels drawn per pixel kept, along each axis
constexpr double kAzimuth = 0.62, kElevation = 0.40;  // radians: a three-quarter view from the front right, from above

constexpr double kMargin = 1.06;      // around what is drawn
constexpr double kWidestPanel = 1.6;  // of its height

struct Layout {
  int columns, rows, title_height, panel_width, panel_height, caption_height;
};

struct View {
  Vector3d right, up, backward;  // the picture's axes; backward: towards the eye
  Vector3d center = Vector3d::Zero();
  double width = 1, height = 1;  // of what must be seen
  double depth = 1;              // half of it
};

View make_view(char up_axis, const std::vector<Extent>& extents) {
  const int axis = up_axis - 'x';
  const Vector3d up = Vector3d::Unit(axis);
  // z up: the front is -y, as CAD has it; y up: the front is z.
  const Vector3d front = axis == 2 ? Vector3d(-Vector3d::UnitY()) : Vector3d(Vector3d::Unit((axis + 1) % 3));
  const Vector3d side = up.cross(front);
  View view;
  view.backward =
      std::cos(kElevation) * (std::cos(kAzimuth) * front + std::sin(kAzimuth) * side) + std::sin(kElevation) * up;
  view.right = up.cross(view.backward).normalized();
  view.up = view.backward.cross(view.right);

  Eigen::AlignedBox3d box;
  for (const Extent& extent : extents) {
    const Vector3d center(extent.center.data());
    const Vector3d seen(center.dot(view.right), center.dot(view.up), center.dot(view.backward));
    box.extend(seen - Vector3d::Constant(extent.radius));
    box.extend(seen + Vector3d::Constant(extent.radius));
  }
  if (box.isEmpty()) throw std::runtime_error("nothing to draw");
  const Vector3d middle = box.center();
  view.center = middle.x() * view.right + middle.y() * view.up + middle.z() * view.backward;
  view.width = box.sizes().x();
  view.height = box.sizes().y();
  view.depth = 0.5 * box.sizes().norm();
  return view;
}

void aim(vtkCamera* camera, const View& view, const Layout& layout) {
  const double free_height = layout.panel_height - layout.caption_height;
  const double unit = kMargin * std::max(view.height / free_height, view.width / layout.panel_width);  // per pixel
  camera->ParallelProjectionOn();
  camera->SetParallelScale(0.5 * unit * layout.panel_height);
  const Vector3d focus = view.center - 0.5 * unit * layout.caption_height * view.up;
  const Vector3d eye = focus + 3 * view.depth * view.backward;
  camera->SetFocalPoint(focus.x(), focus.y(), focus.z());
  camera->SetPosition(eye.x(), eye.y(), eye.z());
  camera->SetViewUp(view.up.x(), view.up.y(), view.up.z());
  camera->SetClippingRange(1.5 * view.depth, 4.5 * view.depth);
}

// A line of text around (x, y), in smaller print if it would be wider than `width`; all in pixels.
void add_text(vtkRenderer* renderer, const std::string& text, double x, double y, int pixels, bool bold, double width) {
  constexpr double kLetter = 0.6;  // width of a letter, of its height: a little too much
  pixels = std::min(pixels, static_cast<int>(width / kLetter / std::max(1.0, static_cast<double>(text.size()))));
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  vtkTextProperty* property = actor->GetTextProperty();
  property->SetFontFamilyToArial();
  property->SetFontSize(pixels);
  property->SetBold(bold ? 1 : 0);
  property->SetColor(bold ? 0.13 : 0.38, bold ? 0.16 : 0.41, bold ? 0.20 : 0.45);
  property->SetJustificationToCentered();
  property->SetVerticalJustificationToCentered();
  actor->SetPosition(x, y);
  renderer->AddViewProp(actor);
}

// What one renderer shows, averaged down to width x height.
vtkSmartPointer<vtkImageData> draw(vtkRenderWindow* window, vtkRenderer* renderer, int width, int height) {
  window->SetSize(width * kOversampling, height * kOversampling);
  window->AddRenderer(renderer);
  window->Render();
  vtkNew<vtkImageData> pixels;
  pixels->SetDimensions(width * kOversampling, height * kOversampling, 1);
  pixels->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  auto* array = vtkUnsignedCharArray::SafeDownCast(pixels->GetPointData()->GetScalars());
  window->GetPixelData(0, 0, width * kOversampling - 1, height * kOversampling - 1, 0, array);
  window->RemoveRenderer(renderer);
  vtkNew<vtkImageShrink3D> shrink;
  shrink->SetInputData(pixels);
  shrink->SetShrinkFactors(kOversampling, kOversampling, 1);
  shrink->AveragingOn();
  shrink->Update();
  return shrink->GetOutput();
}

void paste(vtkImageData* picture, vtkImageData* part, int left, int bottom) {
  const int* size = part->GetDimensions();
  for (int y = 0; y < size[1]; ++y) {
    std::memcpy(picture->GetScalarPointer(left, bottom + y, 0), part->GetScalarPointer(0, y, 0),
                static_cast<std::size_t>(size[0]) * 3);
  }
}

// width 0: as wide as the model needs, and its captions.
Layout make_layout(int width, int height, int panels, bool titled, const View& view) {
  Layout layout{};
  layout.columns = panels <= 4 ? panels : (panels + 1) / 2;
  layout.rows = (panels + layout.columns - 1) / layout.columns;
  layout.title_height = titled ? height / 14 : 0;
  layout.panel_height = (height - layout.title_height) / layout.rows;
  layout.caption_height = layout.panel_height / 5;
  if (width > 0) {
    layout.panel_width = width / layout.columns;
    layout.caption_height = std::min(layout.caption_height, layout.panel_width / 5);
  } else {
    const double needed = (layout.panel_height - layout.caption_height) * view.width / view.height;
    layout.panel_width =
        static_cast<int>(std::clamp(needed, 5.0 * layout.caption_height, kWidestPanel * layout.panel_height));
  }
  return layout;
}

void render(const std::filesystem::path& folder, const char* png, int width, int height, char up,
            const std::string& title) {
  Panels content = make_panels(folder, 1.5 * kOversampling);
  const View view = make_view(up, content.extents);
  const Layout layout = make_layout(width, height, static_cast<int>(content.panels.size()), !title.empty(), view);
  if (width == 0) width = layout.panel_width * layout.columns;

  vtkNew<vtkImageData> picture;
  picture->SetDimensions(width, height, 1);
  picture->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  std::memset(picture->GetScalarPointer(), 255, static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);

  if (layout.title_height > 0) {
    vtkNew<vtkRenderer> renderer;
    renderer->SetBackground(1, 1, 1);
    add_text(renderer, title, width * kOversampling / 2.0, layout.title_height * kOversampling / 2.0,
             layout.title_height * kOversampling / 2, true, width * kOversampling);
    paste(picture, draw(window, renderer, width, layout.title_height), 0, height - layout.title_height);
  }
  const int count = static_cast<int>(content.panels.size());
  for (int i = 0; i < count; ++i) {
    const Panel& panel = content.panels[static_cast<std::size_t>(i)];
    const int row = i / layout.columns, column = i % layout.columns;
    const int in_row = std::min(layout.columns, count - row * layout.columns);
    const double line = layout.caption_height * kOversampling;
    const double middle = layout.panel_width * kOversampling / 2.0;
    add_text(panel.renderer, panel.caption, middle, 0.70 * line, static_cast<int>(0.30 * line), true, 2 * middle);
    add_text(panel.renderer, panel.detail, middle, 0.28 * line, static_cast<int>(0.24 * line), false, 2 * middle);
    aim(panel.renderer->GetActiveCamera(), view, layout);
    const int left = (width - in_row * layout.panel_width) / 2 + column * layout.panel_width;
    const int bottom = height - layout.title_height - (row + 1) * layout.panel_height;
    paste(picture, draw(window, panel.renderer, layout.panel_width, layout.panel_height), left, bottom);
  }
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(png);
  writer->SetInputData(picture);
  writer->Write();
  if (writer->GetErrorCode() != 0) throw std::runtime_error(std::string("cannot write ") + png);
}

bool is_size(const char* text, bool or_zero) {
  const int value = std::atoi(text);
  return (value >= 64 && value <= 8192) || (or_zero && std::strcmp(text, "0") == 0);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 6 || argc > 7 || std::strlen(argv[5]) != 1 || std::strchr("xyz", argv[5][0]) == nullptr ||
      !is_size(argv[3], true) || !is_size(argv[4], false)) {
    std::fputs(
        "usage: orchard-render FOLDER PICTURE.png WIDTH HEIGHT x|y|z [TITLE]\n"
        "Draws the .vtp files that orchard wrote into FOLDER; WIDTH and HEIGHT: 64 to 8192 pixels;\n"
        "WIDTH 0: as wide as the model needs.\n",
        stderr);
    return 2;
  }
  try {
    render(argv[1], argv[2], std::atoi(argv[3]), std::atoi(argv[4]), argv[5][0], argc == 7 ? argv[6] : "");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "orchard-render: %s\n", error.what());
    return 1;
  }
  return 0;
}
