#pragma once
#include <string>

#include "camera.h"
#include "panels.h"
#include "render_request.h"

// The positions of the parts of a picture, and the views of its panels.
namespace orchard::detail {

struct Layout {
  int width, height;  // of the picture, in pixels as all of these
  int columns, rows;
  int title_height, panel_width, panel_height, caption_height;
  int bar_width;  // of the colour bar, on the right of all panels
};

// The contents of a picture that determine its layout, apart from its size.
struct LayoutContent {
  int panels = 1;
  int columns = 0;  // 0 for as many as fit
  bool color_bar = false;
};

// If no width is asked for, the picture is as wide as the model and its captions need.
Layout make_layout(const Request& request, const LayoutContent& content, const View& view);

// Returns the left and the lower side of a panel. The panels of an incomplete row are centred.
std::pair<int, int> corner_of(const Layout& layout, int panel, int panels);

// Views from the front and from behind, with one scale.
struct Views {
  View front, back;
};
// `from_behind` tells whether any panel is seen from behind.
Views views_of(const Request& request, const std::vector<Extent>& extents, bool from_behind);

// Returns the largest size of print, at most `pixels`, in which `text` is at most `width` wide; all are in pixels.
double fitting(const std::string& text, double pixels, double width);

}  // namespace orchard::detail
