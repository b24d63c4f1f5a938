#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "orchard/geometry/mesh_check.h"
#include "orchard/medial/offset.h"
#include "output/promises.h"

// What `orchard offset` says about its result, for people and for programs.
namespace orchard::apps {

struct OffsetReport {
  const OffsetMesh& offset;  // of a hollow solid, its cavity
  MeshReport mesh;           // of everything that was written
  double diagonal = 0;       // of the input
  OffsetSide side = OffsetSide::outside;
  std::optional<double> wall, min_wall;  // of a hollow solid: asked for, and proven
  std::string unit;
};

Broken broken(const OffsetReport& report);
nlohmann::json to_json(const OffsetReport& report);
void print(const OffsetReport& report);

}  // namespace orchard::apps
