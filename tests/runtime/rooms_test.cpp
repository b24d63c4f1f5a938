#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

// The folders of runtime/ are rooms of a house: each is understood with those below it alone. This test reads what the
// files include and fails on an arrow back up.
namespace orchard::runtime {
namespace {

namespace fs = std::filesystem;

struct Room {
  const char* name;                         // folder of runtime/
  std::vector<std::string> may_include;     // rooms, all of them above in this list
  std::vector<std::string> public_headers;  // of include/orchard/runtime
};

const std::vector<Room> kRooms = {
    {"execution", {}, {"execution.h", "version.h"}},
    {"simd", {}, {}},
    {"math", {"simd"}, {"pose.h"}},
    {"tree", {"execution", "math"}, {"packed_tree.h", "tree_file.h"}},
    {"collision/kernels", {"simd", "math", "tree"}, {}},
    {"collision",
     {"execution", "simd", "math", "tree", "collision/kernels"},
     {"collide.h", "contacts.h", "distance.h", "narrow_phase.h", "shape_query.h", "time_of_impact.h"}},
    {"broad_phase", {"execution", "simd", "math"}, {"broad_phase.h", "broad_queries.h", "motion.h"}},
    {"detector",
     {"execution", "simd", "math", "tree", "collision/kernels", "collision", "broad_phase"},
     {"detector.h", "motion_monitor.h"}},
    {"extras",
     {"execution", "math", "tree", "collision", "broad_phase"},
     {"flexible_tree.h", "frame_pacer.h", "motion_helpers.h", "self_collision.h"}},
    {"c",
     {"execution", "math", "tree", "collision", "broad_phase", "detector", "extras"},
     {"orchard.h", "orchard_broad_phase.h", "orchard_detector.h"}},
};

const fs::path kRuntime = ORCHARD_RUNTIME_DIR;
const std::string kPublic = "orchard/runtime/";

struct Source {
  std::string room;
  std::vector<std::string> includes;  // by their names in includes: "tree/tree_nodes.h", "orchard/runtime/pose.h"
};

std::vector<std::string> includes_of(const fs::path& file) {
  std::vector<std::string> includes;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::string begin = "#include \"";
    if (line.rfind(begin, 0) == 0) includes.push_back(line.substr(begin.size(), line.rfind('"') - begin.size()));
  }
  return includes;
}

std::string room_of_public(const std::string& name) {
  for (const Room& room : kRooms) {
    for (const std::string& header : room.public_headers) {
      if (header == name) return room.name;
    }
  }
  return "";
}

// Every file of the run-time by its name in includes.
std::map<std::string, Source> sources() {
  std::map<std::string, Source> all;
  for (const auto& entry : fs::recursive_directory_iterator(kRuntime)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".h" && extension != ".cpp") continue;
    const fs::path below = entry.path().lexically_relative(kRuntime);
    const bool is_public = *below.begin() == "include";
    const std::string name = is_public ? kPublic + below.filename().string() : below.generic_string();
    const std::string room =
        is_public ? room_of_public(below.filename().string()) : below.parent_path().generic_string();
    all[name] = {room, includes_of(entry.path())};
  }
  return all;
}

TEST(Rooms, AreListedFromTheGroundFloorUp) {
  std::set<std::string> below;
  for (const Room& room : kRooms) {
    for (const std::string& other : room.may_include) EXPECT_TRUE(below.count(other)) << room.name << ": " << other;
    below.insert(room.name);
  }
}

TEST(Rooms, HoldEveryFile) {
  std::map<std::string, int> files;
  for (const auto& [name, source] : sources()) ++files[source.room];
  for (const Room& room : kRooms) EXPECT_GT(files[room.name], 0) << room.name;
  std::set<std::string> known;
  for (const Room& room : kRooms) known.insert(room.name);
  for (const auto& [name, source] : sources()) {
    EXPECT_TRUE(known.count(source.room)) << name << " is in no room: list it in this test";
  }
}

TEST(Rooms, HoldNoFileLongerThanFourHundredLines) {
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kRuntime)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".h" && extension != ".cpp") continue;
    std::ifstream in(entry.path());
    std::size_t lines = 0;
    for (std::string line; std::getline(in, line);) ++lines;
    EXPECT_LE(lines, 400u) << entry.path() << ": split it";
    ++files;
  }
  EXPECT_GT(files, 100u);
}

// Those that begin in the first column.
TEST(Rooms, HoldNoFunctionLongerThanSixtyLines) {
  std::size_t functions = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kRuntime)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".h" && extension != ".cpp") continue;
    std::ifstream in(entry.path());
    std::size_t number = 0, begin = 0;
    for (std::string line; std::getline(in, line);) {
      ++number;
      if (!line.empty() && std::isalpha(static_cast<unsigned char>(line[0])) && line.back() == '{') begin = number;
      if (line == "};") begin = 0;  // of a class
      if (line != "}" || begin == 0) continue;
      EXPECT_LE(number - begin + 1, 60u) << entry.path() << ":" << begin << ": divide it";
      ++functions, begin = 0;
    }
  }
  EXPECT_GT(functions, 500u);
}

TEST(Rooms, OfTheCoreHaveAtMostSixteenPublicHeaders) {
  std::size_t headers = 0;
  for (const Room& room : kRooms) {
    const std::string name = room.name;
    if (name == "extras" || name == "c") continue;
    for (const std::string& header : room.public_headers) headers += header != "version.h";  // which has no types
  }
  EXPECT_LE(headers, 16u);
}

TEST(Rooms, IncludeOnlyWhatIsBelowThem) {
  const auto all = sources();
  ASSERT_GT(all.size(), 100u);
  std::map<std::string, std::set<std::string>> allowed;
  for (const Room& room : kRooms) {
    allowed[room.name].insert(room.may_include.begin(), room.may_include.end());
    allowed[room.name].insert(room.name);
  }
  for (const auto& [name, source] : all) {
    for (const std::string& include : source.includes) {
      const auto found = all.find(include);
      ASSERT_NE(found, all.end()) << name << " includes " << include
                                  << ", which is not the name of a file with its folder";
      EXPECT_TRUE(allowed[source.room].count(found->second.room))
          << name << " (" << source.room << ") includes " << include << " (" << found->second.room << ")";
    }
  }
}

void visit(const std::string& name, const std::map<std::string, Source>& all, std::set<std::string>& open,
           std::set<std::string>& done) {
  if (done.count(name)) return;
  ASSERT_TRUE(open.insert(name).second) << name << " includes itself by way of others";
  for (const std::string& include : all.at(name).includes) {
    if (all.count(include)) visit(include, all, open, done);
  }
  open.erase(name);
  done.insert(name);
}

TEST(Rooms, HaveNoCircleOfFiles) {
  const auto all = sources();
  std::set<std::string> open, done;
  for (const auto& [name, source] : all) visit(name, all, open, done);
}

}  // namespace
}  // namespace orchard::runtime
