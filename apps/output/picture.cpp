#include "output/picture.h"

#ifdef ORCHARD_HAS_VIZ
#include <fmt/core.h>

#include "command_line/interrupt.h"

namespace orchard::apps {

UpAxis parse_up(const std::string& up) { return up == "x" ? UpAxis::x : up == "z" ? UpAxis::z : UpAxis::y; }

bool is_drawn(const PictureStatus& status) {
  throw_if_interrupted();  // on a terminal the renderer is interrupted too
  if (!status) fmt::print(stderr, "orchard: no picture was made: {}\n", status.reason);
  return static_cast<bool>(status);
}

}  // namespace orchard::apps
#endif
