#pragma once
#include <sys/types.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"

// Runs the built program in a folder of its own, as a user would.
namespace orchard::test {

struct Finished {
  int exit_code = -1;
  std::string out, err;
};

// A new, empty folder that goes when this does.
class Workplace {
 public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  std::string add(const std::string& name, const TriangleMesh& mesh) const;  // an .obj; returns its path
  std::string add(const std::string& name, const std::string& text) const;
  // With `out` for standard output, as a shell takes it ("/dev/full", or "&-": closed); empty: returned.
  Finished run(const std::vector<std::string>& arguments, const std::string& out = {}) const;
  std::map<std::string, std::string> files(const std::string& folder) const;  // name, content; empty if there is none

 private:
  std::filesystem::path folder_;
};

// The arguments for the quick way to a tree: an octree of two levels, without views.
std::vector<std::string> quick_build(const std::string& mesh, const std::string& folder,
                                     const std::vector<std::string>& more = {});

// The program in a process group of its own, as a shell starts it, with its errors in a file.
class Running {
 public:
  // variables: "NAME=VALUE", beside those of the test.
  Running(const std::vector<std::string>& arguments, const std::vector<std::string>& variables,
          const std::filesystem::path& err);
  ~Running();  // kills the group
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  pid_t pid() const { return pid_; }
  void send(int signal) const;           // to the program alone
  void send_to_group(int signal) const;  // as a terminal does
  // The exit code, or -1 if a signal ended it or it still runs after half a minute.
  int wait();
  bool ended();  // without waiting
  // Waits until it catches SIGINT, half a minute at most; whether it does.
  bool listens() const;

 private:
  pid_t pid_ = -1;
  std::optional<int> status_;
};

// Waits until there is such a file, half a minute at most; whether there is.
bool appears(const std::filesystem::path& file);

// A table or medial mesh without the line, which must be the last one, that says where it comes from.
std::string without_provenance(const std::string& text);

// One line "orchard: ..." and nothing else.
bool is_one_line_error(const std::string& err);

}  // namespace orchard::test
