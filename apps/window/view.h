#pragma once
#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextActor.h>

#include <string>
#include <vector>

#include "paraview.h"
#include "simulation.h"

namespace orchard::window {

// What is shown beside the bodies.
struct Shown {
  int level = -1;       // the spheres of this level of every body's tree; -1: none
  bool bounds = false;  // the space-time bounds' cross sections: horns as spheres, hypertrapezoids as cubes
};

// A simulation as actors in a window: blue is the steered ship, green, orange and red are bodies in pairs that are
// apart, undecided and touching.
class View {
 public:
  View(const simulation::Simulation& simulation, int width, int height);

  void update(const Shown& shown, const std::string& hud);
  vtkRenderWindow* window() { return window_; }
  void write_png(const std::string& file);

 private:
  struct BodyActors {
    vtkSmartPointer<vtkActor> mesh, spheres, horn, cube;
  };
  vtkPolyData* spheres_of(std::uint32_t shape, int level);
  BodyActors& actors_of(std::uint32_t body);
  void show_bounds(std::uint32_t body, bool shown);

  const simulation::Simulation& simulation_;
  std::vector<vtkSmartPointer<vtkPolyData>> meshes_;                // by shape
  std::vector<std::vector<vtkSmartPointer<vtkPolyData>>> spheres_;  // by shape and level
  std::vector<BodyActors> bodies_;
  vtkNew<vtkRenderer> renderer_;
  vtkNew<vtkRenderWindow> window_;
  vtkNew<vtkTextActor> hud_;
};

}  // namespace orchard::window
