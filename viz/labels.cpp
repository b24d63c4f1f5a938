#include "labels.h"

#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "actors.h"
#include "label_layout.h"
#include "screen_shapes.h"

namespace orchard::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

void add_dot(vtkRenderer* renderer, const Vector2d& middle, double radius, const Color& color) {
  constexpr int kCorners = 16;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> polygon;
  polygon->InsertNextCell(kCorners);
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    polygon->InsertCellPoint(
        points->InsertNextPoint(middle.x() + radius * std::cos(angle), middle.y() + radius * std::sin(angle), 0));
  }
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetPolys(polygon);
  add_screen_shape(renderer, data, color, 1);
}

void add_word(vtkRenderer* renderer, const std::string& text, const Vector2d& middle, double print) {
  vtkNew<vtkTextActor> actor;
  actor->SetInput((" " + text + " ").c_str());
  vtkTextProperty* property = actor->GetTextProperty();
  property->SetFontFamilyToArial();
  property->SetFontSize(std::max(1, static_cast<int>(print)));
  property->SetBold(1);
  property->SetColor(1, 1, 1);
  property->SetBackgroundColor(kInk[0], kInk[1], kInk[2]);
  property->SetBackgroundOpacity(1);
  property->SetJustificationToCentered();
  property->SetVerticalJustificationToCentered();
  actor->SetPosition(middle.x(), middle.y());
  renderer->AddViewProp(actor);
}

}  // namespace

void add_labels(vtkRenderer* renderer, const std::vector<Label>& labels, const View& view, const View& other,
                const LabelRoom& room) {
  // The width and height of a letter in bold print, over the size of the print.
  constexpr double kLetter = 0.62, kHeight = 1.25;
  const Projection projection = projection_of(view, room.width, room.height, room.below);
  std::vector<PlacedWord> words;
  std::vector<std::string> texts;
  for (const Label& label : labels) {
    if (Vector3d(label.outward.data()).dot(view.backward - other.backward) < 0) continue;
    const double letters = static_cast<double>(label.text.size()) + 1;  // half a blank is added on both sides
    words.push_back({.anchor = projection(Vector3d(label.position.data())).head<2>(),
                     .size = room.print * Vector2d(kLetter * letters, kHeight)});
    texts.push_back(label.text);
  }
  place_words(words, {0, room.below}, {room.width, room.height}, projection(view.center).head<2>());
  const double width = std::max(1.0, room.print / 12);
  for (const PlacedWord& word : words) {
    add_screen_line(renderer, word.anchor, word.middle, {1, 1, 1}, 2.5 * width);
    add_screen_line(renderer, word.anchor, word.middle, kInk, width);
    add_dot(renderer, word.anchor, 0.24 * room.print, {1, 1, 1});
    add_dot(renderer, word.anchor, 0.16 * room.print, kInk);
  }
  for (std::size_t i = 0; i < words.size(); ++i) add_word(renderer, texts[i], words[i].middle, room.print);
}

}  // namespace orchard::detail
