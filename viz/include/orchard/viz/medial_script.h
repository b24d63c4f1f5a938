#pragma once
#include <filesystem>
#include <string>

#include "orchard/geometry/mesh.h"
#include "orchard/viz/vtk_writer.h"

namespace orchard {

// What a script for a medial axis shows.
struct MedialScript {
  std::string name = {};          // The beginning of the names of the files beside it, such as "lamp-medial".
  Sphere ball{Point::Zero(), 1};  // A ball around the solid.
  UpAxis up = UpAxis::y;          // The axis that points up.
  Index balls = 0;                // The number of balls of the axis.
  Index light_balls = 0;          // Of these, in NAME-light.vtp; 0: there is no such file.
};

// Writes a script that shows a medial axis in ParaView: in its window (paraview --script=FILE) or as a picture
// (pvbatch FILE --preset NAME -o PICTURE.png). Its presets are `radius`, `sheets`, `importance`, `lines` and `balls`.
// It reads NAME.vtu, NAME-mesh.vtp, NAME-skeleton.vtp, and NAME-vertices.vtp or NAME-light.vtp in its own folder. The
// file is written completely or not at all. Throws Error if it cannot be written.
void write_medial_script(const std::filesystem::path& py, const MedialScript& script);

}  // namespace orchard
