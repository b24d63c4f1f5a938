#include "canvas.h"

#include <vtkImageShrink3D.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "labels.h"

namespace orchard::detail {
namespace {

// Adds a line of text around (x, y).
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

// Renders the scene of one renderer on a ground of one brightness, averaged down to width x height.
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

// How much of the ground is seen through a pixel is the difference between a white and a black ground. The rest is the
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
                static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(part->GetNumberOfScalarComponents()));
  }
}

}  // namespace

Canvas::Canvas(const Request& request, const Layout& layout) : request_(request), layout_(layout) {
  const int components = request.transparent ? 4 : 3;
  picture_->SetDimensions(layout.width, layout.height, 1);
  picture_->AllocateScalars(VTK_UNSIGNED_CHAR, components);
  std::memset(picture_->GetScalarPointer(), request.transparent ? 0 : 255,
              static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.height) *
                  static_cast<std::size_t>(components));
  window_->SetOffScreenRendering(1);
  window_->SetMultiSamples(0);
}

void Canvas::add_title() {
  if (layout_.title_height == 0) return;
  vtkNew<vtkRenderer> renderer;
  const double line = layout_.title_height * kOversampling, span = layout_.width * kOversampling;
  add_text(renderer, request_.title, span / 2, line / 2, fitting(request_.title, 0.5 * line, span), true);
  put(renderer, layout_.width, layout_.title_height, 0, layout_.height - layout_.title_height);
}

void Canvas::add_captions(const Panel& panel, double caption_print, double detail_print) const {
  if (!request_.captions) return;
  const double line = layout_.caption_height * kOversampling, span = layout_.panel_width * kOversampling;
  const bool on_scene = request_.look_at.has_value();  // the scene continues behind the captions
  add_text(panel.renderer, panel.caption, span / 2, 0.70 * line, caption_print, true, on_scene);
  add_text(panel.renderer, panel.detail, span / 2, 0.28 * line, detail_print, false, on_scene);
}

void Canvas::add_panels(const std::vector<Panel>& panels, const Views& views) {
  constexpr double kLabelPrint = 0.2;  // the size of numbers of places, over the height of captions
  const double line = layout_.caption_height * kOversampling, span = layout_.panel_width * kOversampling;
  double caption_print = 0.30 * line, detail_print = 0.24 * line;
  for (const Panel& panel : panels) {
    caption_print = fitting(panel.caption, caption_print, span);
    detail_print = fitting(panel.detail, detail_print, span);
  }
  const int count = static_cast<int>(panels.size());
  for (int i = 0; i < count; ++i) {
    const Panel& panel = panels[static_cast<std::size_t>(i)];
    add_captions(panel, caption_print, detail_print);
    const View& from = panel.from_behind ? views.back : views.front;
    aim(panel.renderer->GetActiveCamera(), from, layout_.panel_width, layout_.panel_height, layout_.caption_height);
    add_labels(panel.renderer, panel.labels, from, panel.from_behind ? views.front : views.back,
               {.width = layout_.panel_width * kOversampling,
                .height = layout_.panel_height * kOversampling,
                .below = layout_.caption_height * kOversampling,
                .print = kLabelPrint * line});
    const auto [left, bottom] = corner_of(layout_, i, count);
    put(panel.renderer, layout_.panel_width, layout_.panel_height, left, bottom);
  }
}

void Canvas::add_bar(const Panels& content) {
  if (layout_.bar_width == 0) return;
  const int room = layout_.height - layout_.title_height;
  put(content.color_bar(layout_.bar_width * kOversampling, room * kOversampling), layout_.bar_width, room,
      layout_.width - layout_.bar_width, 0);
}

void Canvas::save() {
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(request_.png.c_str());
  writer->SetInputData(picture_);
  writer->Write();
  if (writer->GetErrorCode() != 0)
    throw std::runtime_error(request_.png + ": cannot be written; check that its folder exists and is writable");
}

void Canvas::put(vtkRenderer* renderer, int width, int height, int left, int bottom) {
  paste(picture_, draw(window_, renderer, width, height, request_.transparent), left, bottom);
}

}  // namespace orchard::detail
