#pragma once
#include <filesystem>
#include <string>

namespace orchard::apps {

// The data from standard input, as a file that exists as long as this object, so that it can be read like any other:
// several times, and from any position.
class StandardInput {
 public:
  // Reads all of standard input. `format` becomes the extension of the file. Throws InputError if there is no data, and
  // Error if it cannot be stored.
  explicit StandardInput(const std::string& format);
  ~StandardInput();
  StandardInput(const StandardInput&) = delete;
  StandardInput& operator=(const StandardInput&) = delete;

  const std::filesystem::path& file() const { return file_; }
  // Returns the message with "standard input" in place of the file's name.
  std::string in_words(std::string message) const;

 private:
  std::filesystem::path file_;
};

// Whether a file is that of a StandardInput.
bool is_standard_input(const std::filesystem::path& file);
// Returns the name of a file for messages: its path, or "standard input".
std::string shown(const std::filesystem::path& file);

}  // namespace orchard::apps
