#pragma once
#ifdef ORCHARD_HAS_VIZ
#include <filesystem>
#include <optional>
#include <vector>

#include "input/mesh_input.h"
#include "orchard/viz/view.h"

// What `orchard view` draws, read from files.
namespace orchard::apps {

// One moment of a series.
struct TimeStep {
  double time = 0;
  std::vector<std::filesystem::path> files;  // .vtp and .vtu
};

// Reads a ParaView collection (.pvd): the moments in the order of time, each with all of its parts. Throws InputError
// if the file is no collection, if it is empty, or if it names a file that is missing or cannot be drawn.
std::vector<TimeStep> read_series(const std::filesystem::path& pvd);

using SeriesList = std::vector<std::vector<TimeStep>>;

// The number of time steps of the longest series.
std::size_t length_of(const SeriesList& all);

// Puts the files of a time step behind the first `still` views of the scene, which are there in all of them. A series
// that is shorter stays at its end.
void show_step(std::size_t step, const SeriesList& all, std::size_t still, Scene& scene);

// A box around all time steps, for one camera; nothing if there is no point in them.
std::optional<Box> room_of(const SeriesList& all);

// Adds the contents of a file to the scene by its ending. `input`: how meshes are read. `talk`: print what reading a
// mesh changed. Throws InputError.
void add_file(const std::filesystem::path& file, const MeshInput& input, Scene& scene, bool talk);

}  // namespace orchard::apps
#endif
