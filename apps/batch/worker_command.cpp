#include "batch/worker_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <string_view>

#include "command_line/command_line.h"
#include "command_line/shared_options.h"
#include "command_line/usage_error.h"
#include "orchard/geometry/error.h"
#include "output/provenance.h"

namespace orchard::apps {
namespace {

constexpr std::array<std::string_view, 3> kCommands{"build", "medial", "spheres"};
constexpr std::array<std::string_view, 5> kOfTheBatch{"output", "json", "quiet", "force", "cost"};
constexpr std::array<std::string_view, 7> kOfOneMesh{"points", "diagram", "from-axis",     "features",
                                                     "axis",   "beside",  "vertex-weights"};

template <std::size_t N>
bool is_in(const std::array<std::string_view, N>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// the name of the mesh while a command line is checked for all meshes
constexpr const char* kAnyMesh = "MESH.obj";
constexpr const char* kAnyFolder = "FOLDER";

const CLI::App& parsed(CLI::App& app, const std::vector<std::string>& words) {
  std::vector<std::string> typed{"orchard"};
  typed.insert(typed.end(), words.begin(), words.end());
  if (const std::string fault = unknown_word(app, typed); !fault.empty()) throw InputError(fault);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // in reverse order, as the parser expects
  } catch (const CLI::Success&) {
    throw InputError("batch: --help after -- has no effect on a mesh; see \"orchard " + words.front() + " --help\"");
  } catch (const CLI::ParseError& error) {
    throw InputError(in_one_line(app, error));
  }
  return *app.get_subcommand(words.front());
}

void refuse_what_is_not_for_all(const CLI::App& command) {
  for (const std::string& name : given_of(command)) {
    if (is_in(kOfOneMesh, name))
      throw InputError("batch: --" + name + " names a file that belongs to one mesh, and a batch has many");
  }
}

void check_options(const std::string& name, const Request& request) {
  if (name == "build") check_options(request.build);
  if (name == "medial") check_options(request.medial);
  if (name == "spheres") check_options(request.spheres);
}

}  // namespace

std::vector<std::string> WorkerCommand::words(const std::filesystem::path& mesh,
                                              const std::filesystem::path& folder) const {
  std::vector<std::string> words{name};
  words.insert(words.end(), options.begin(), options.end());
  words.insert(words.end(), {"--json", "-o", folder.string()});
  // Meshes are processed in parallel, so each worker gets a single thread.
  if (!own_threads) words.insert(words.end(), {"--threads", "1"});
  words.insert(words.end(), {"--", mesh.string()});  // after "--", because the name may begin with a dash
  return words;
}

WorkerCommand parse_worker_command(const std::vector<std::string>& words) {
  if (words.empty() || !is_in(kCommands, words.front()))
    throw InputError(
        "batch: give the command for every mesh after --: build, medial or spheres and its options, such as "
        "-- build --depth 2");
  WorkerCommand worker{.name = words.front(),
                       .options = {words.begin() + 1, words.end()},
                       .decisive = {},
                       .decisive_options = {},
                       .request = {}};
  for (const std::string& word : worker.options) {
    const std::string option = word.substr(0, word.find('='));
    const std::string long_name = option == "-o" ? "output" : option.starts_with("--") ? option.substr(2) : "";
    if (word == "--" || is_in(kOfTheBatch, long_name))
      throw InputError("batch: " + option + " cannot be among the options of " + worker.name +
                       ": the batch itself says where results go and what is printed");
  }
  std::vector<std::string> whole{worker.name, kAnyMesh, "-o", kAnyFolder, "--json"};
  whole.insert(whole.end(), worker.options.begin(), worker.options.end());
  CLI::App app{"", "orchard"};
  app.require_subcommand(1);
  const auto request = std::make_shared<Request>();
  add_commands(app, *request);
  const CLI::App& command = parsed(app, whole);
  refuse_what_is_not_for_all(command);
  check_options(worker.name, *request);
  worker.request = request;
  const Invocation run = invocation_of(command, {});
  worker.decisive = run.command_line;
  worker.decisive_options = run.options;
  const std::vector<std::string> given = given_of(command);
  worker.own_threads = std::find(given.begin(), given.end(), "threads") != given.end();
  return worker;
}

}  // namespace orchard::apps
