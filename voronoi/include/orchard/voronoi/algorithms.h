#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "orchard/geometry/progress.h"
#include "orchard/voronoi/voronoi_build.h"

namespace orchard {

// The four algorithms behind one interface; see bowyer.h, inagaki.h, highest_first.h and exact.h.
enum class VoronoiAlgorithm : std::uint8_t { bowyer, inagaki, highest_first, exact };
inline constexpr std::array<VoronoiAlgorithm, 4> kVoronoiAlgorithms{
    VoronoiAlgorithm::bowyer, VoronoiAlgorithm::inagaki, VoronoiAlgorithm::highest_first, VoronoiAlgorithm::exact};

// "bowyer", "inagaki", "highest-first", "exact", and back.
std::string_view name(VoronoiAlgorithm algorithm);
std::optional<VoronoiAlgorithm> voronoi_algorithm_named(std::string_view name);

// The same result type from each, so that they can stand in for one another. `exact` inserts with no report but the
// dimension, the duplicates, which are identical points only, and does not call progress.
VoronoiBuild voronoi(std::span<const Point> points, VoronoiAlgorithm algorithm = VoronoiAlgorithm::highest_first,
                     const Progress& progress = {});

}  // namespace orchard
