#include "orchard/geometry/mesh.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "orchard/geometry/error.h"

namespace orchard {
namespace {

TEST(ValidateMesh, NamesTheFirstFault) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::vector<Point> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const struct {
    TriangleMesh mesh;
    const char* message;
  } cases[] = {
      {{points, {{0, 1, 3}}}, "triangle 0 names vertex 3, but the mesh has 3 vertices"},
      {{points, {{0, 1, 2}, {0, kNone, 1}}}, "triangle 1 names vertex 4294967295"},
      {{{{0, 0, 0}, {0, nan, 0}, {1, 0, 0}}, {{0, 1, 2}}}, "vertex 1 "},
      {{{{0, 0, 0}, {0, 0, 0}, {1, 0, -inf}}, {{0, 1, 2}}}, "vertex 2 "},
      {{points, {}}, "no triangles"},
  };
  for (const auto& [mesh, message] : cases) {
    try {
      validate(mesh);
      ADD_FAILURE() << message;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
  EXPECT_NO_THROW(validate({points, {{0, 1, 2}}}));
}

}  // namespace
}  // namespace orchard
