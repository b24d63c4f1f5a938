#include "view.h"

#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCubeSource.h>
#include <vtkDoubleArray.h>
#include <vtkGlyph3D.h>
#include <vtkMatrix4x4.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkSphereSource.h>
#include <vtkTextProperty.h>
#include <vtkWindowToImageFilter.h>

#include <algorithm>

namespace orchard::window {
namespace {

using simulation::Vec3;

vtkSmartPointer<vtkPolyData> mesh_of(const runtime::TreeView& tree) {
  vtkNew<vtkPoints> points;
  for (const auto& v : tree.vertices)
    points->InsertNextPoint(v[0] + tree.origin[0], v[1] + tree.origin[1], v[2] + tree.origin[2]);
  vtkNew<vtkCellArray> triangles;
  for (const auto& t : tree.triangles) {
    const vtkIdType corners[] = {t[0], t[1], t[2]};
    triangles->InsertNextCell(3, corners);
  }
  auto mesh = vtkSmartPointer<vtkPolyData>::New();
  mesh->SetPoints(points);
  mesh->SetPolys(triangles);
  return mesh;
}

struct Ball {
  double x, y, z, radius;
};

// A level's balls, and the leaves above it that stand for their part there.
void collect(const runtime::TreeView& tree, std::uint32_t block, std::uint32_t lane, int levels,
             std::vector<Ball>& balls) {
  const runtime::SiblingBlock& b = tree.blocks[block];
  if (b.radius[lane] < 0) return;
  const std::uint32_t link = b.link[lane];
  if (levels == 0 || (link & runtime::kLeafBit) != 0) {
    balls.push_back(
        {b.x[lane] + tree.origin[0], b.y[lane] + tree.origin[1], b.z[lane] + tree.origin[2], double{b.radius[lane]}});
    return;
  }
  const runtime::Children children = runtime::children_of(tree.branching, link);
  for (std::uint32_t i = 0; i < children.count; ++i)
    collect(tree, children.first + i / runtime::kBlockWidth, i % runtime::kBlockWidth, levels - 1, balls);
}

vtkSmartPointer<vtkPolyData> ball_surfaces(const runtime::TreeView& tree, int level) {
  std::vector<Ball> balls;
  collect(tree, 0, 0, level, balls);
  vtkNew<vtkPoints> points;
  vtkNew<vtkDoubleArray> radii;
  for (const Ball& ball : balls) {
    points->InsertNextPoint(ball.x, ball.y, ball.z);
    radii->InsertNextValue(ball.radius);
  }
  vtkNew<vtkPolyData> centers;
  centers->SetPoints(points);
  centers->GetPointData()->SetScalars(radii);
  vtkNew<vtkSphereSource> sphere;
  sphere->SetRadius(1);
  sphere->SetThetaResolution(16);
  sphere->SetPhiResolution(10);
  vtkNew<vtkGlyph3D> glyphs;
  glyphs->SetInputData(centers);
  glyphs->SetSourceConnection(sphere->GetOutputPort());
  glyphs->SetScaleModeToScaleByScalar();
  glyphs->SetColorModeToColorByScale();
  glyphs->Update();
  auto surfaces = vtkSmartPointer<vtkPolyData>::New();
  surfaces->ShallowCopy(glyphs->GetOutput());
  return surfaces;
}

vtkSmartPointer<vtkActor> actor_of(vtkPolyData* data, double opacity) {
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetOpacity(opacity);
  return actor;
}

template <class Source>
vtkSmartPointer<vtkActor> wireframe_of(vtkNew<Source>& source) {
  source->Update();
  auto actor = actor_of(source->GetOutput(), 0.5);
  actor->GetProperty()->SetRepresentationToWireframe();
  return actor;
}

void place(vtkActor* actor, const runtime::Pose& pose) {
  vtkNew<vtkMatrix4x4> matrix;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      matrix->SetElement(
          row, column,
          pose.scale * pose.rotation[3 * static_cast<std::size_t>(row) + static_cast<std::size_t>(column)]);
    matrix->SetElement(row, 3, pose.translation[static_cast<std::size_t>(row)]);
  }
  actor->SetUserMatrix(matrix);
}

}  // namespace

View::View(const simulation::Simulation& simulation, int width, int height) : simulation_(simulation) {
  for (const simulation::Shape& shape : simulation.world().shapes) {
    meshes_.push_back(mesh_of(shape.tree));
    spheres_.emplace_back();
  }
  renderer_->SetBackground(0.07, 0.08, 0.11);
  window_->AddRenderer(renderer_);
  window_->SetSize(width, height);
  window_->SetWindowName("orchard-fly");
  hud_->GetTextProperty()->SetFontSize(15);
  hud_->GetTextProperty()->SetFontFamilyToCourier();
  hud_->GetTextProperty()->SetColor(0.9, 0.95, 0.9);
  hud_->GetTextProperty()->SetVerticalJustificationToTop();
  hud_->SetDisplayPosition(12, height - 12);
  renderer_->AddViewProp(hud_);
  update({}, "");
  renderer_->GetActiveCamera()->SetPosition(0.6, 0.5, 1);
  renderer_->GetActiveCamera()->SetFocalPoint(0, 0, 0);
  renderer_->ResetCamera();
}

vtkPolyData* View::spheres_of(std::uint32_t shape, int level) {
  auto& levels = spheres_[shape];
  const auto at = static_cast<std::size_t>(level);
  if (levels.size() <= at) levels.resize(at + 1);
  if (!levels[at]) levels[at] = ball_surfaces(simulation_.world().shapes[shape].tree, level);
  return levels[at];
}

View::BodyActors& View::actors_of(std::uint32_t body) {
  while (bodies_.size() <= body) {
    const std::uint32_t shape = simulation_.world().bodies[bodies_.size()].shape;
    vtkNew<vtkSphereSource> ball;
    ball->SetRadius(1);
    ball->SetThetaResolution(24);
    ball->SetPhiResolution(12);
    vtkNew<vtkCubeSource> cube;
    cube->SetXLength(2);
    cube->SetYLength(2);
    cube->SetZLength(2);
    BodyActors actors{actor_of(meshes_[shape], 1), actor_of(meshes_[shape], 0.35), wireframe_of(ball),
                      wireframe_of(cube)};
    actors.spheres->GetProperty()->SetColor(0.55, 0.75, 1);
    actors.horn->GetProperty()->SetColor(0.9, 0.8, 0.3);
    actors.cube->GetProperty()->SetColor(0.8, 0.5, 0.9);
    for (const auto& actor : {actors.mesh, actors.spheres, actors.horn, actors.cube}) renderer_->AddActor(actor);
    bodies_.push_back(actors);
  }
  return bodies_[body];
}

void View::show_bounds(std::uint32_t index, bool shown) {
  BodyActors& actors = bodies_[index];
  const simulation::World& world = simulation_.world();
  shown = shown && !world.bodies[index].fixed;
  actors.horn->SetVisibility(shown);
  actors.cube->SetVisibility(shown);
  if (!shown) return;
  const simulation::CrossSection section = simulation::cross_section(world.detection.promises()[index], world.time);
  for (const auto& [actor, size] : {std::pair{actors.horn, section.horn}, std::pair{actors.cube, section.half}}) {
    actor->SetPosition(section.middle[0], section.middle[1], section.middle[2]);
    actor->SetScale(size, size, size);
  }
}

void View::update(const Shown& shown, const std::string& hud) {
  const simulation::World& world = simulation_.world();
  std::vector<int> answers(world.bodies.size(), 0);
  for (const simulation::PairOutcome& pair : simulation_.pairs())
    for (const std::uint32_t body : {pair.a, pair.b})
      answers[body] = std::max(answers[body], static_cast<int>(pair.verdict.answer) + 1);
  constexpr double colors[][3] = {{0.75, 0.75, 0.75}, {0.3, 0.8, 0.4}, {0.95, 0.6, 0.15}, {0.95, 0.2, 0.2}};
  for (std::uint32_t i = 0; i < world.bodies.size(); ++i) {
    BodyActors& actors = actors_of(i);
    const simulation::Body& body = world.bodies[i];
    actors.mesh->SetVisibility(body.there);
    actors.spheres->SetVisibility(body.there && shown.level >= 0);
    const runtime::Pose pose = simulation::pose_of(body, world.shapes[body.shape]);
    place(actors.mesh, pose);
    place(actors.spheres, pose);
    const double* color = colors[answers[i]];
    if (i == 0 && answers[i] == 0)
      actors.mesh->GetProperty()->SetColor(0.3, 0.5, 1);
    else
      actors.mesh->GetProperty()->SetColor(color[0], color[1], color[2]);
    if (shown.level >= 0)
      static_cast<vtkPolyDataMapper*>(actors.spheres->GetMapper())->SetInputData(spheres_of(body.shape, shown.level));
    show_bounds(i, shown.bounds && body.there);
  }
  hud_->SetInput(hud.c_str());
}

void View::write_png(const std::string& file) {
  window_->Render();
  vtkNew<vtkWindowToImageFilter> image;
  image->SetInput(window_);
  image->ReadFrontBufferOff();
  image->Update();
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(file.c_str());
  writer->SetInputConnection(image->GetOutputPort());
  writer->Write();
}

}  // namespace orchard::window
