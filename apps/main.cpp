#include <fmt/core.h>
#include <tbb/global_control.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "command_line/add_commands.h"
#include "command_line/command_line.h"
#include "command_line/freed_memory.h"
#include "command_line/help.h"
#include "command_line/interrupt.h"
#include "command_line/renamed_options.h"
#include "command_line/standard_streams.h"
#include "command_line/usage_error.h"
#include "orchard/geometry/error.h"

namespace {

using namespace orchard::apps;

// Prints a message in one line, even if the name of a file contains line breaks.
int fail(int code, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  fmt::print(stderr, "orchard: {}\n", message);
  return code;
}

// Returns the code if everything that was printed has been written, and otherwise that of a failure.
int printed(int code) {
  if (flush_standard_output()) return code;
  const std::string reason = errno != 0 ? std::strerror(errno) : "it could not be written to";
  return code == kSucceeded || code == kPromiseNotKept ? fail(kFailed, "standard output: " + reason) : code;
}

// Without the program's name and in reverse order, as the parser expects.
std::vector<std::string> reversed_arguments(const std::vector<std::string>& words) {
  return {words.rbegin(), words.empty() ? words.rend() : words.rend() - 1};
}

int run(Request& request) {
  std::optional<tbb::global_control> limit;
  if (request.threads > 0)
    limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(request.threads));
  take_standard_input(request);
  request.run();
  return request.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  catch_interrupts();
  occupy_standard_streams();
  CLI::App app{"Turn triangle meshes into medial axes, certified sphere-trees, sphere sets and collision answers",
               "orchard"};
  app.formatter(std::make_shared<HelpFormatter>());
  app.require_subcommand(1);
  app.set_version_flag("--version", ORCHARD_VERSION);
  app.footer(
      "Examples:\n  orchard medial data/lamp.obj -o out/lamp\n  orchard build data/lamp.obj -o out/lamp\n"
      "  orchard spheres data/lamp.obj -o out/lamp -n 20\n\"orchard COMMAND --help\" explains a command.");
  Request request;
  request.typed = app.get_name();
  for (int i = 1; i < argc; ++i) request.typed += std::string(" ") + argv[i];
  argc = take_worker_words(argc, argv, request);
  add_commands(app, request);
  try {
    std::vector<std::string> words(argv, argv + argc);
    for (const std::string& warning : rename_options(words)) fmt::print(stderr, "orchard: warning: {}\n", warning);
    if (const std::string fault = unknown_word(app, words); !fault.empty()) return fail(kBadInput, fault);
    app.parse(reversed_arguments(words));
  } catch (const orchard::InputError& error) {
    return fail(kBadInput, error.what());
  } catch (const CLI::Success& asked) {  // --help, --version
    return printed(app.exit(asked));
  } catch (const CLI::ParseError& error) {
    return fail(kBadInput, in_one_line(app, error));
  }
  const auto in_words = [&request](const std::exception& error) {
    return request.standard_input ? request.standard_input->in_words(error.what()) : std::string(error.what());
  };
  try {
    return printed(run(request));
  } catch (const orchard::InputError& error) {
    return fail(kBadInput, in_words(error));
  } catch (const std::bad_alloc&) {
    return fail(kFailed, "out of memory");
  } catch (const std::exception& error) {
    return fail(kFailed, in_words(error));
  }
}
