#pragma once
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace orchard::apps {

// Writes rows to a file in the order of their places, 0, 1, .., in whatever order they are added: one JSON object a
// line. Rows that are too early wait in memory.
class OrderedRows {
 public:
  // Throws Error if the file cannot be written, as do the other functions.
  explicit OrderedRows(std::filesystem::path file);
  void add(std::size_t place, const nlohmann::ordered_json& row);
  void close();  // precondition: all rows up to the last one were added

 private:
  void check();

  std::filesystem::path file_;
  std::ofstream out_;
  std::size_t next_ = 0;
  std::map<std::size_t, std::string> waiting_;
};

}  // namespace orchard::apps
