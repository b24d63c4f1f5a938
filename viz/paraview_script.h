#pragma once
#include <filesystem>
#include <string>

#include "orchard/viz/vtk_writer.h"

namespace orchard::detail {

// PREFIX.pvd: the levels of a tree as the steps of an animation, level k at the time k.
void write_levels_in_time(const std::filesystem::path& prefix, Index depth);

// PREFIX-view.py: what ParaView shows without a click, from the files of write_pipeline() beside it.
void write_paraview_script(const std::filesystem::path& prefix, const PipelineValues& values);

}  // namespace orchard::detail
