#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "orchard/geometry/progress.h"
#include "orchard/voronoi/voronoi_build.h"

// One interface to the four algorithms that build Voronoi diagrams.
namespace orchard {

// The algorithms; bowyer.h, inagaki.h, highest_first.h and exact.h describe them.
enum class VoronoiAlgorithm : std::uint8_t { bowyer, inagaki, highest_first, exact };
inline constexpr std::array<VoronoiAlgorithm, 4> kVoronoiAlgorithms{
    VoronoiAlgorithm::bowyer, VoronoiAlgorithm::inagaki, VoronoiAlgorithm::highest_first, VoronoiAlgorithm::exact};

// Returns the name of an algorithm: "bowyer", "inagaki", "highest-first" or "exact".
std::string_view name(VoronoiAlgorithm algorithm);
// Returns the algorithm that has a name, or nullopt if there is none.
std::optional<VoronoiAlgorithm> voronoi_algorithm_named(std::string_view name);

// Builds the Voronoi diagram of points by the given algorithm. All algorithms return the same type and can replace each
// other. `exact` fills in the dimension and the duplicates of the report alone, counts only identical points as
// duplicates, and does not call `progress`. Throws as the algorithm does.
VoronoiBuild voronoi(std::span<const Point> points, VoronoiAlgorithm algorithm = VoronoiAlgorithm::highest_first,
                     const Progress& progress = {});

}  // namespace orchard
