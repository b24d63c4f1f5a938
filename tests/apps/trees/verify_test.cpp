#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

struct Wrapped {
  const Workplace here;
  const std::string mesh, out = (here / "out").string();

  Wrapped() : mesh(here.add("open.obj", test::open_box())) {
    const Finished run = build({"--wrap=0.01", "--wrap-alpha", "0.1"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
  Finished build(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"build", mesh, "-o", out, "--method", "octree", "--depth", "2", "--no-views"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return here.run(arguments);
  }
};

TEST(Verify, FindsTheWrapBesideTheTreeAndAddsItsDistanceToEveryBound) {
  const Wrapped built;
  const double wrap_distance = json::parse(built.here.files("out").at("open.json"))["wrap_distance_over_radius"];
  for (const std::string ending : {".orchard", ".sph"}) {
    const std::string tree = built.out + "/open" + ending;
    const Finished found = built.here.run({"verify", tree, built.mesh, "--json"});
    ASSERT_EQ(found.exit_code, 0) << found.out << found.err;
    const json report = json::parse(found.out);
    EXPECT_NEAR(report["wrap"]["wrap_to_mesh_over_radius"].get<double>(), wrap_distance, 1e-3);
    const Finished alone = built.here.run({"verify", tree, built.out + "/open-wrap.obj", "--json"});
    ASSERT_EQ(alone.exit_code, 0) << alone.err;
    const json plain = json::parse(alone.out);
    EXPECT_FALSE(plain.contains("wrap"));
    for (std::size_t level = 0; level < plain["max_bound_over_radius"].size(); ++level)
      EXPECT_DOUBLE_EQ(report["max_bound_over_radius"][level].get<double>(),
                       plain["max_bound_over_radius"][level].get<double>() +
                           report["wrap"]["wrap_to_mesh_over_radius"].get<double>());
  }
}

TEST(Verify, EndsABuildOnAWrapWithALineOnWhatIsCertifiedAndHowFarThatIs) {
  const Wrapped built;
  const Finished run = built.build({"--wrap=0.01", "--wrap-alpha", "0.1"});
  const json report = json::parse(built.here.files("out").at("open.json"));
  EXPECT_EQ(report["certified_mesh"], "open-wrap.obj");
  const std::size_t begin = run.out.rfind('\n', run.out.size() - 2) + 1;
  const std::string last = run.out.substr(begin);
  EXPECT_NE(last.find("conservative: every point of the wrap, " + built.out + "/open-wrap.obj"), std::string::npos)
      << last;
  const std::string text = "is farther than ";
  const std::size_t to = last.find(text), from = last.find("no point of the mesh farther than ");
  ASSERT_NE(to, std::string::npos);
  ASSERT_NE(from, std::string::npos);
  EXPECT_NEAR(std::stod(last.substr(to + text.size())), report["wrap"]["wrap_to_input"][1].get<double>(), 1e-5);
  EXPECT_NEAR(std::stod(last.substr(from + 34)), report["wrap"]["input_to_wrap"][1].get<double>(), 1e-5);
}

// Whatever wrote it: an earlier run, another program, the user.
TEST(Verify, TakesNoMeshForTheTreesWrapThatIsNot) {
  const Wrapped built;
  const std::string wrap = built.here.files("out").at("open-wrap.obj");
  const std::string solid = built.here.add("open.obj", test::box({0, 0, 0}, {1, 1, 1}));  // now it is closed
  ASSERT_EQ(built.build({}).exit_code, 0);
  for (const std::string& other :
       {wrap, std::string("not even a mesh\n"), std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")}) {
    built.here.add("out/open-wrap.obj", other);
    for (const std::string ending : {".orchard", ".sph"}) {
      const Finished run = built.here.run({"verify", built.out + "/open" + ending, solid, "--json"});
      EXPECT_EQ(run.exit_code, 0) << ending << run.err;
      EXPECT_FALSE(json::parse(run.out).contains("wrap")) << ending;
    }
  }
}

}  // namespace
}  // namespace orchard
