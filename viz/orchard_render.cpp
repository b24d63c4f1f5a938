// Draws the files of write_pipeline() on the display of $DISPLAY. A program of its own because VTK aborts where there
// is none (see orchard/viz/render.h).
#include <vtkCoordinate.h>
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
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "camera.h"
#include "panels.h"
#include "render_request.h"
#include "window.h"

namespace {

using Eigen::Vector3d;
using namespace orchard::detail;

constexpr int kOversampling = 2;  // pixels drawn per pixel kept, along each axis

constexpr double kWidestPanel = 1.3;  // of its height
constexpr double kLabelPrint = 0.2;   // of numbers of places, of the height of captions
constexpr int kWidestBar = 160;       // pixels
constexpr int kRowHeight = 560;       // pixels, where no height is asked for

struct Layout {
  int width, height;  // of the picture, in pixels as all of these
  int columns, rows;
  int title_height, panel_width, panel_height, caption_height;
  int bar_width;  // of the colours', on the right of all panels
};

// The size of print, at most `pixels`, in which `text` is not wider than `width`; all in pixels.
double fitting(const std::string& text, double pixels, double width) {
  constexpr double kLetter = 0.54;  // width of a letter, of the size of print: on the safe side
  return std::min(pixels, width / kLetter / static_cast<double>(std::max<std::size_t>(text.size(), 1)));
}

// A line of text around (x, y).
void add_text(vtkRenderer* renderer, const std::string& text, double x, double y, double pixels, bool bold,
              bool on_scene = false) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput(text.c_str());
  vtkTextProperty* property = actor->GetTextProperty();
  property->SetFontFamilyToArial();
  property->SetFontSize(std::max(1, static_cast<int>(pixels)));
  property->SetBold(bold ? 1 : 0);
  property->SetColor(bold ? 0.13 : 0.38, bold ? 0.16 : 0.41, bold ? 0.20 : 0.45);
  property->SetJustificationToCentered();
  property->SetVerticalJustificationToCentered();
  if (on_scene) {
    property->SetBackgroundColor(1, 1, 1);
    property->SetBackgroundOpacity(0.8);
  }
  actor->SetPosition(x, y);
  renderer->AddViewProp(actor);
}

// On top of what is there, if it faces this eye more than the other.
void add_label(vtkRenderer* renderer, const Label& label, const View& view, const View& other, double pixels) {
  if (Vector3d(label.outward.data()).dot(view.backward - other.backward) < 0) return;
  vtkNew<vtkTextActor> actor;
  actor->SetInput((" " + label.text + " ").c_str());
  actor->GetPositionCoordinate()->SetCoordinateSystemToWorld();
  actor->GetPositionCoordinate()->SetValue(label.position[0], label.position[1], label.position[2]);
  vtkTextProperty* property = actor->GetTextProperty();
  property->SetFontFamilyToArial();
  property->SetFontSize(std::max(1, static_cast<int>(pixels)));
  property->SetBold(1);
  property->SetColor(1, 1, 1);
  property->SetBackgroundColor(0.13, 0.16, 0.20);
  property->SetBackgroundOpacity(0.85);
  property->SetJustificationToCentered();
  property->SetVerticalJustificationToCentered();
  renderer->AddViewProp(actor);
}

// What one renderer shows on a ground of one brightness, averaged down to width x height.
vtkSmartPointer<vtkImageData> draw_on(double ground, vtkRenderWindow* window, vtkRenderer* renderer, int width,
                                      int height) {
  renderer->SetBackground(ground, ground, ground);
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

// How much of the ground is seen through each pixel is what a white ground adds to a black one; without it remains the
// pixel's own colour.
vtkSmartPointer<vtkImageData> without_ground(vtkImageData* on_white, vtkImageData* on_black) {
  const int* size = on_white->GetDimensions();
  auto result = vtkSmartPointer<vtkImageData>::New();
  result->SetDimensions(size[0], size[1], 1);
  result->AllocateScalars(VTK_UNSIGNED_CHAR, 4);
  const auto* white = static_cast<const unsigned char*>(on_white->GetScalarPointer());
  const auto* black = static_cast<const unsigned char*>(on_black->GetScalarPointer());
  auto* pixel = static_cast<unsigned char*>(result->GetScalarPointer());
  for (std::ptrdiff_t i = 0; i < std::ptrdiff_t{size[0]} * size[1]; ++i, white += 3, black += 3, pixel += 4) {
    const int through = std::clamp((white[0] - black[0] + white[1] - black[1] + white[2] - black[2]) / 3, 0, 255);
    const int own = 255 - through;
    for (int c = 0; c < 3; ++c)
      pixel[c] = static_cast<unsigned char>(own == 0 ? 0 : std::min(255, (255 * black[c] + own / 2) / own));
    pixel[3] = static_cast<unsigned char>(own);
  }
  return result;
}

vtkSmartPointer<vtkImageData> draw(vtkRenderWindow* window, vtkRenderer* renderer, int width, int height,
                                   bool transparent) {
  auto on_white = draw_on(1, window, renderer, width, height);
  if (!transparent) return on_white;
  return without_ground(on_white, draw_on(0, window, renderer, width, height));
}

void paste(vtkImageData* picture, vtkImageData* part, int left, int bottom) {
  const int* size = part->GetDimensions();
  for (int y = 0; y < size[1]; ++y) {
    std::memcpy(picture->GetScalarPointer(left, bottom + y, 0), part->GetScalarPointer(0, y, 0),
                static_cast<std::size_t>(size[0] * part->GetNumberOfScalarComponents()));
  }
}

// Where no width is asked for, as wide as the model needs, and its captions.
Layout make_layout(const Request& request, const Panels& content, const View& view) {
  const int panels = static_cast<int>(content.panels.size());
  Layout layout{};
  layout.columns = panels <= 4 ? panels : (panels + 1) / 2;
  layout.rows = (panels + layout.columns - 1) / layout.columns;
  layout.height = request.height > 0 ? request.height : kRowHeight * layout.rows;
  layout.title_height = request.title.empty() ? 0 : layout.height / (7 * layout.rows);
  layout.panel_height = (layout.height - layout.title_height) / layout.rows;
  layout.caption_height = request.captions ? layout.panel_height / 5 : 0;
  layout.bar_width = content.color_bar ? std::min(layout.panel_height / 4, kWidestBar) : 0;
  if (request.width > 0) {
    layout.width = request.width;
    layout.bar_width = std::min(layout.bar_width, layout.width / 5);
    layout.panel_width = (layout.width - layout.bar_width) / layout.columns;
    layout.caption_height = std::min(layout.caption_height, layout.panel_width / 5);
  } else {
    const double needed = (layout.panel_height - layout.caption_height) * view.width / view.height;
    layout.panel_width =
        static_cast<int>(std::clamp(needed, 5.0 * layout.caption_height, kWidestPanel * layout.panel_height));
    layout.width = layout.panel_width * layout.columns + layout.bar_width;
  }
  return layout;
}

// From where the panels are seen: from the front and from behind, at one scale.
struct Views {
  View front, back;
};

Views views_of(const Request& request, const Panels& content) {
  Direction behind = request.direction;
  behind.azimuth += 180;
  Views views{make_view(request.direction, content.extents), make_view(behind, content.extents)};
  if (std::any_of(content.panels.begin(), content.panels.end(), [](const Panel& panel) { return panel.from_behind; })) {
    views.front.width = views.back.width = std::max(views.front.width, views.back.width);
    views.front.height = views.back.height = std::max(views.front.height, views.back.height);
  }
  if (request.steady) views.front = steady(views.front, content.extents);
  if (request.look_at) {
    const double all = std::max(views.front.width, views.front.height);
    views.front = look_at(views.front, Vector3d(request.look_at->data()), request.span > 0 ? request.span : all);
  }
  return views;
}

// The picture, into which its parts are drawn one after the other.
class Sheet {
 public:
  Sheet(const Request& request, const Layout& layout) : request_(request), layout_(layout) {
    const int components = request.transparent ? 4 : 3;
    picture_->SetDimensions(layout.width, layout.height, 1);
    picture_->AllocateScalars(VTK_UNSIGNED_CHAR, components);
    std::memset(picture_->GetScalarPointer(), request.transparent ? 0 : 255,
                static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height) *
                    static_cast<std::size_t>(components));
    window_->SetOffScreenRendering(1);
    window_->SetMultiSamples(0);
  }

  void add_title() {
    if (layout_.title_height == 0) return;
    vtkNew<vtkRenderer> renderer;
    const double line = layout_.title_height * kOversampling, span = layout_.width * kOversampling;
    add_text(renderer, request_.title, span / 2, line / 2, fitting(request_.title, 0.5 * line, span), true);
    put(renderer, layout_.width, layout_.title_height, 0, layout_.height - layout_.title_height);
  }

  void add_panels(const std::vector<Panel>& panels, const Views& views) {
    const double line = layout_.caption_height * kOversampling, span = layout_.panel_width * kOversampling;
    double caption_print = 0.30 * line, detail_print = 0.24 * line;
    for (const Panel& panel : panels) {
      caption_print = fitting(panel.caption, caption_print, span);
      detail_print = fitting(panel.detail, detail_print, span);
    }
    const int count = static_cast<int>(panels.size());
    for (int i = 0; i < count; ++i) {
      const Panel& panel = panels[static_cast<std::size_t>(i)];
      if (request_.captions) {
        const bool on_scene = request_.look_at.has_value();  // which goes on behind them
        add_text(panel.renderer, panel.caption, span / 2, 0.70 * line, caption_print, true, on_scene);
        add_text(panel.renderer, panel.detail, span / 2, 0.28 * line, detail_print, false, on_scene);
      }
      const View& from = panel.from_behind ? views.back : views.front;
      aim(panel.renderer->GetActiveCamera(), from, layout_.panel_width, layout_.panel_height, layout_.caption_height);
      for (const Label& label : panel.labels)
        add_label(panel.renderer, label, from, panel.from_behind ? views.front : views.back, kLabelPrint * line);
      const int row = i / layout_.columns, column = i % layout_.columns;
      const int in_row = std::min(layout_.columns, count - row * layout_.columns);
      const int room = layout_.width - layout_.bar_width;
      put(panel.renderer, layout_.panel_width, layout_.panel_height,
          (room - in_row * layout_.panel_width) / 2 + column * layout_.panel_width,
          layout_.height - layout_.title_height - (row + 1) * layout_.panel_height);
    }
  }

  void add_bar(const Panels& content) {
    if (layout_.bar_width == 0) return;
    const int room = layout_.height - layout_.title_height;
    put(content.color_bar(layout_.bar_width * kOversampling, room * kOversampling), layout_.bar_width, room,
        layout_.width - layout_.bar_width, 0);
  }

  void save() {
    vtkNew<vtkPNGWriter> writer;
    writer->SetFileName(request_.png.c_str());
    writer->SetInputData(picture_);
    writer->Write();
    if (writer->GetErrorCode() != 0) throw std::runtime_error("cannot write " + request_.png);
  }

 private:
  void put(vtkRenderer* renderer, int width, int height, int left, int bottom) {
    paste(picture_, draw(window_, renderer, width, height, request_.transparent), left, bottom);
  }

  const Request& request_;
  const Layout& layout_;
  vtkNew<vtkImageData> picture_;
  vtkNew<vtkRenderWindow> window_;
};

void render(const Request& request) {
  const Vector3d backward = looking(request.direction).backward;
  const Panels content = make_panels(request.vtm, {.line_width = 1.5 * kOversampling,
                                                   .backward = {backward.x(), backward.y(), backward.z()},
                                                   .opacity = request.opacity,
                                                   .whole = request.whole,
                                                   .figure = request.figure});
  const Views views = views_of(request, content);
  const Layout layout = make_layout(request, content, views.front);
  Sheet sheet(request, layout);
  sheet.add_title();
  sheet.add_panels(content.panels, views);
  sheet.add_bar(content);
  sheet.save();
}

}  // namespace

int main(int argc, char** argv) {
  Request request;
  try {
    request = parse_request({argv + 1, argv + argc});
  } catch (const std::logic_error&) {
    std::fputs(usage(), stderr);
    return 2;
  }
  try {
    if (request.window) {
      show_window({.vtm = request.vtm,
                   .png = request.png,
                   .title = request.title,
                   .width = request.width,
                   .height = request.height,
                   .direction = request.direction,
                   .level = request.level,
                   .opacity = request.opacity});
    } else {
      render(request);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "orchard-render: %s\n", error.what());
    return 1;
  }
  return 0;
}
