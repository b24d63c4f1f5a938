// Draws the files of write_pipeline() on the display of $DISPLAY. This is a separate program because VTK aborts if
// there is no display (see orchard/viz/render.h). Pictures of lines need no display.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "camera.h"
#include "canvas.h"
#include "layout.h"
#include "panels.h"
#include "render_request.h"
#include "vector_picture.h"
#include "window.h"

namespace {

using namespace orchard::detail;

void render(const Request& request) {
  const Eigen::Vector3d backward = looking(request.direction).backward;
  const Panels content = make_panels(request.vtm, {.line_width = 1.5 * kOversampling,
                                                   .backward = {backward.x(), backward.y(), backward.z()},
                                                   .opacity = request.opacity,
                                                   .whole = request.whole,
                                                   .figure = request.figure});
  const bool from_behind =
      std::any_of(content.panels.begin(), content.panels.end(), [](const Panel& panel) { return panel.from_behind; });
  const Views views = views_of(request, content.extents, from_behind);
  const Layout layout = make_layout(request,
                                    {.panels = static_cast<int>(content.panels.size()),
                                     .columns = content.columns,
                                     .color_bar = static_cast<bool>(content.color_bar)},
                                    views.front);
  Canvas canvas(request, layout);
  canvas.add_title();
  canvas.add_panels(content.panels, views);
  canvas.add_bar(content);
  canvas.save();
}

void show(const Request& request) {
  show_window({.vtm = request.vtm,
               .png = request.png,
               .title = request.title,
               .width = request.width,
               .height = request.height,
               .direction = request.direction,
               .level = request.level,
               .opacity = request.opacity});
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
    if (request.window)
      show(request);
    else if (is_vector_file(request.png))
      draw_vector_picture(request);
    else
      render(request);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "orchard-render: %s\n", error.what());
    return 1;
  }
  return 0;
}
