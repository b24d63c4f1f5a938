#include "orchard/geometry/atomic_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include "orchard/geometry/error.h"

namespace orchard {
namespace {

namespace fs = std::filesystem;

class AtomicFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("orchard_atomic_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  static std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  std::ptrdiff_t entries() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }

  fs::path folder_;
};

TEST_F(AtomicFile, WritesBytesAsTheyAre) {
  const std::string bytes("a\nb\r\n\0c", 7);
  write_file(folder_ / "file", bytes);
  EXPECT_EQ(contents(folder_ / "file"), bytes);
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicFile, ReplacesAnExistingFile) {
  write_file(folder_ / "file", "old and long");
  write_file(folder_ / "file", "new");
  EXPECT_EQ(contents(folder_ / "file"), "new");
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicFile, KeepsTheOldFileIfWritingFails) {
  write_file(folder_ / "file", "old");
  EXPECT_THROW(write_file(folder_ / "file",
                          [](std::ostream& stream) {
                            stream << "half";
                            stream.setstate(std::ios::failbit);
                          }),
               Error);
  EXPECT_EQ(contents(folder_ / "file"), "old");
  EXPECT_EQ(entries(), 1);
}

TEST_F(AtomicFile, LeavesNothingBehindIfTheWriterThrows) {
  EXPECT_THROW(write_file(folder_ / "file", [](std::ostream&) { throw std::logic_error("writer"); }), std::logic_error);
  EXPECT_EQ(entries(), 0);
}

TEST_F(AtomicFile, RefusesAFolderThatIsNotThere) {
  EXPECT_THROW(write_file(folder_ / "none" / "file", "text"), Error);
  EXPECT_EQ(entries(), 0);
}

TEST_F(AtomicFile, RefusesToReplaceAFolder) {
  fs::create_directories(folder_ / "file" / "inner");
  EXPECT_THROW(write_file(folder_ / "file", "text"), Error);
  EXPECT_EQ(entries(), 1);
  EXPECT_TRUE(fs::is_directory(folder_ / "file" / "inner"));
}

TEST_F(AtomicFile, LeavesAWholeFileWhicheverOfManyThreadsComesLast) {
  std::vector<std::thread> threads;
  for (char letter = 'a'; letter < 'e'; ++letter) {
    threads.emplace_back([&, letter] {
      for (int i = 0; i < 20; ++i) write_file(folder_ / "file", std::string(100000, letter));
    });
  }
  for (std::thread& thread : threads) thread.join();
  const std::string result = contents(folder_ / "file");
  EXPECT_EQ(result, std::string(100000, result.at(0)));
  EXPECT_EQ(entries(), 1);
}

}  // namespace
}  // namespace orchard
