#pragma once
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>

#include <vector>

#include "layout.h"

namespace orchard::detail {

inline constexpr int kOversampling = 2;  // pixels drawn per pixel kept, along each axis

// A picture into which parts are drawn one after another. It needs an X display.
class Canvas {
 public:
  // Keeps references to both arguments.
  Canvas(const Request& request, const Layout& layout);

  void add_title();
  void add_panels(const std::vector<Panel>& panels, const Views& views);
  void add_bar(const Panels& content);
  // Throws std::runtime_error if the file cannot be written.
  void save();

 private:
  void add_captions(const Panel& panel, double caption_print, double detail_print) const;
  void put(vtkRenderer* renderer, int width, int height, int left, int bottom);

  const Request& request_;
  const Layout& layout_;
  vtkNew<vtkImageData> picture_;
  vtkNew<vtkRenderWindow> window_;
};

}  // namespace orchard::detail
