#include "screen_shapes.h"

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>

#include <array>

namespace orchard::detail {

void add_screen_shape(vtkRenderer* renderer, vtkPolyData* shape, const Color& color, double width) {
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(shape);
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(color[0], color[1], color[2]);
  actor->GetProperty()->SetLineWidth(static_cast<float>(width));
  renderer->AddViewProp(actor);
}

void add_screen_line(vtkRenderer* renderer, const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Color& color,
                     double width) {
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(from.x(), from.y(), 0);
  points->InsertNextPoint(to.x(), to.y(), 0);
  vtkNew<vtkCellArray> line;
  const std::array<vtkIdType, 2> ends{0, 1};
  line->InsertNextCell(2, ends.data());
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(line);
  add_screen_shape(renderer, data, color, width);
}

}  // namespace orchard::detail
