#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "../fuzz/reader_entry.h"
#include "orchard/geometry/random.h"
#include "support/corpus.h"

namespace orchard {
namespace {

namespace fs = std::filesystem;

// How one reader is fed; `name` is its folder of the corpus.
struct Format {
  const char* name;
  test::Reader reader;
  bool (*read)(test::Reader, const std::uint8_t*, std::size_t) = test::read_bytes;
};

const Format kFormats[] = {{"obj", read_obj},
                           {"ply", read_ply},
                           {"stl", read_stl},
                           {"off", read_off},
                           {"vtp", read_vtk_xml},
                           {"vtk", read_legacy_vtk},
                           {"msh", read_gmsh},
                           {"mesh", read_medit},
                           {"meshb", read_binary_medit},
                           {"obj", read_obj_or_points, test::read_point_bytes},
                           {"ply", read_ply_or_points, test::read_point_bytes},
                           {"xyz", read_xyz, test::read_point_bytes}};

using test::Bytes;

std::vector<std::pair<std::string, Bytes>> corpus(const Format& format) {
  return test::corpus(fs::path(ORCHARD_FUZZ_CORPUS) / format.name);
}

TEST(FuzzCorpus, GivesAMeshOrAnInputError) {
  for (const Format& format : kFormats) {
    const auto files = corpus(format);
    EXPECT_GE(files.size(), 5u) << format.name;
    int accepted = 0;
    for (const auto& [name, bytes] : files) {
      EXPECT_NO_THROW(accepted += format.read(format.reader, bytes.data(), bytes.size())) << format.name << name;
    }
    EXPECT_GE(accepted, 2) << format.name;
  }
}

TEST(FuzzCorpus, SurvivesBeingCutAnywhere) {
  for (const Format& format : kFormats) {
    for (const auto& [name, bytes] : corpus(format)) {
      for (std::size_t size = 0; size < bytes.size(); size += size < 2000 ? 1 : 7) {
        // A copy, so that the sanitizers see a reader that reads on.
        const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        ASSERT_NO_THROW(format.read(format.reader, cut.data(), cut.size())) << format.name << name << " at " << size;
      }
    }
  }
}

TEST(FuzzCorpus, SurvivesRandomDamage) {
  for (const Format& format : kFormats) {
    std::uint64_t item = 0;
    for (const auto& [name, bytes] : corpus(format)) {
      for (int trial = 0; trial < 200; ++trial) {
        Random random(1, 2, item++);
        const Bytes damaged = test::damaged(bytes, random);
        ASSERT_NO_THROW(format.read(format.reader, damaged.data(), damaged.size()))
            << format.name << name << " item " << item - 1;
      }
    }
  }
}

TEST(FuzzCorpus, SurvivesEveryFormatReadAsEveryOther) {
  for (const Format& format : kFormats) {
    for (const Format& other : kFormats) {
      for (const auto& [name, bytes] : corpus(other)) {
        EXPECT_NO_THROW(format.read(format.reader, bytes.data(), bytes.size())) << format.name << name;
      }
    }
  }
}

}  // namespace
}  // namespace orchard
