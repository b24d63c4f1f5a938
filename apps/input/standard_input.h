#pragma once
#include <filesystem>
#include <string>

namespace orchard::apps {

// The data from standard input, as a file that exists as long as this object, so that it can be read like any other:
// several times, and from any position.
class StandardInput {
 public:
  // Reads all of standard input. `format`: the ending of the file's name. Throws InputError if nothing arrives, and
  // Error if it cannot be kept.
  explicit StandardInput(const std::string& format);
  ~StandardInput();
  StandardInput(const StandardInput&) = delete;
  StandardInput& operator=(const StandardInput&) = delete;

  const std::filesystem::path& file() const { return file_; }
  // A message in which the file is called "standard input".
  std::string in_words(std::string message) const;

 private:
  std::filesystem::path file_;
};

// Whether a file is that of a StandardInput.
bool is_standard_input(const std::filesystem::path& file);
// What messages call a file: its path, or "standard input".
std::string shown(const std::filesystem::path& file);

}  // namespace orchard::apps
