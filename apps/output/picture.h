#pragma once
#ifdef ORCHARD_HAS_VIZ
#include <string>

#include "orchard/viz/render.h"

// What the commands that draw have in common.
namespace orchard::apps {

// Of --up: x, y or z.
UpAxis parse_up(const std::string& up);

// Whether a picture was drawn; if not, a line on stderr says why. After a signal it throws Cancelled.
bool is_drawn(const PictureStatus& status);

}  // namespace orchard::apps
#endif
