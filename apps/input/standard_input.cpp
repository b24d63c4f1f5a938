#include "input/standard_input.h"

#include <stdlib.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <string_view>
#include <system_error>

#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kFolder = "orchard-standard-input-";

}  // namespace

StandardInput::StandardInput(const std::string& format) {
  std::error_code error;
  const fs::path temporary = fs::temp_directory_path(error);
  std::string folder = ((error ? fs::path("/tmp") : temporary) / kFolder).string() + "XXXXXX";
  if (mkdtemp(folder.data()) == nullptr)
    throw Error(folder + ": the folder for standard input cannot be made; set TMPDIR to another place");
  file_ = fs::path(folder) / ("standard-input." + format);
  std::ofstream out(file_, std::ios::binary);
  std::array<char, 65536> piece{};
  std::size_t total = 0, count = 0;
  while ((count = std::fread(piece.data(), 1, piece.size(), stdin)) > 0) {
    out.write(piece.data(), static_cast<std::streamsize>(count));
    total += count;
  }
  out.close();
  const bool broken = std::ferror(stdin) != 0, kept = static_cast<bool>(out);
  if (kept && !broken && total > 0) return;
  fs::remove_all(file_.parent_path(), error);
  if (broken) throw InputError("standard input: reading failed");
  if (!kept) throw Error(file_.string() + ": standard input cannot be stored there; the disk may be full");
  throw InputError("standard input: it is empty; check the program that writes to it");
}

StandardInput::~StandardInput() {
  std::error_code ignored;
  fs::remove_all(file_.parent_path(), ignored);
}

std::string StandardInput::in_words(std::string message) const {
  const std::string path = file_.string();
  for (std::size_t at = message.find(path); at != std::string::npos; at = message.find(path, at))
    message.replace(at, path.size(), "standard input");
  return message;
}

bool is_standard_input(const fs::path& file) {
  return file.stem() == "standard-input" && file.parent_path().filename().string().starts_with(kFolder);
}

std::string shown(const fs::path& file) { return is_standard_input(file) ? "standard input" : file.string(); }

}  // namespace orchard::apps
