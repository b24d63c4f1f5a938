#pragma once
#include <string>

#include "simulation.h"

namespace orchard::simulation {

// A frame for ParaView, as the text of a .vtp file: every body's triangles, with its number, and the answer of its
// pairs (0 none, 1 no, 2 maybe, 3 yes); and a line for each pair, with the level reached, the bound and the work.
std::string bodies_vtp(const Simulation& simulation);

// Of a body's space-time bound (4.1) at a time: its middle, the radius of the parabolic horn's cross section, and half
// the edge of the hypertrapezoid's.
struct CrossSection {
  Vec3 middle;
  double horn = 0, half = 0;
};
CrossSection cross_section(const Detection::Promise& promise, double time);

// What the broad phase was promised, at the present time: for each body the cross sections of its space-time bound, the
// hypertrapezoid's as a cube, the horn's as the radius of the point in its middle.
std::string bounds_vtp(const Simulation& simulation);

// The frames of a run, as the text of a .pvd file that names them all, two parts each: prefix + frame_file().
std::string run_pvd(const std::vector<double>& times, const std::string& prefix);
std::string frame_file(std::size_t frame, const char* part);  // bodies, bounds

}  // namespace orchard::simulation
