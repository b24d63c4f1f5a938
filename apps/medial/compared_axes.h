#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "command_line/commands.h"
#include "medial/medial_measures.h"
#include "orchard/geometry/progress.h"
#include "orchard/medial/read_axis.h"
#include "output/outputs.h"

// Axes of other systems, each beside one of orchard with as many balls: the work of `orchard compare` for axes.
namespace orchard::apps {

struct ComparedAxis {
  std::string name;  // the file without its folder, or "orchard"
  bool own = false;  // orchard's
  MedialMesh mesh;   // as measured
  Index whole = 0;   // balls of the file
  bool simplified = false;
  std::vector<std::string> notes = {};
  MedialJudgement judgement = {};
};

// Each axis of a file, simplified to at most command.vertices balls where that is asked for, followed by orchard's with
// as many balls, which axes of the same size share. An axis that cannot be simplified is measured as it is, and a note
// says so. Where orchard cannot have as few balls, a note says so. Throws InputError for an axis that is none of the
// solid.
std::vector<ComparedAxis> compared_axes(const CompareCommand& command, const Surface& surface,
                                        std::vector<ForeignAxis> files, const Progress& progress);

// A table of all measures of all axes.
std::string compared_csv(const std::vector<ComparedAxis>& axes, const std::string& model);
// The lines of such a table in a file that are about other models; none if there is no file. Throws InputError, which
// names file and line, if the file is another table.
std::vector<std::string> rows_of_others(const std::filesystem::path& file, const std::string& model);
// A table with these lines, too, in the order of the models' names.
std::string with_other_rows(const std::string& table, std::vector<std::string> others);

// The axes in the transparent solid, side by side, as a picture. Without VTK there is none. `up`: x, y or z.
void draw_compared(const std::string& name, const std::string& up, const Surface& surface,
                   const std::vector<ComparedAxis>& axes, Outputs& outputs);

}  // namespace orchard::apps
