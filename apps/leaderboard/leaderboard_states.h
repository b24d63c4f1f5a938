#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "leaderboard/leaderboard_rows.h"

namespace orchard::apps {

// Writes a state of ParaView: the axes of one model at the number of balls at which most systems have one (the largest
// of equals), side by side in its transparent mesh, with the worst places of each as balls, all in the colours of one
// range. The other rows of the model are in ParaView's list. `folder`: where the files of worst_files() are, which must
// be there already; the state itself may still be staged. Returns false and writes nothing if no row of the model was
// measured. Does nothing where the program was built without VTK.
bool write_worst_state(const std::filesystem::path& pvsm, const std::vector<LeaderboardRow>& rows,
                       const std::string& model, const std::filesystem::path& folder);

}  // namespace orchard::apps
