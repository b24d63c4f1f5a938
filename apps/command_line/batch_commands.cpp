// Options of the command that runs other commands.
#include <string_view>

#include "batch/misbehave.h"
#include "command_line/add_commands.h"
#include "command_line/number_validator.h"
#include "command_line/shared_options.h"

namespace orchard::apps {
namespace {

// A command that fails in ways that a batch must survive, for tests. --help does not list it.
void add_misbehave(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("misbehave", "Crash, hang or take memory, for tests")->group("");
  command.add_option("kind", request.misbehavior, "crash, killed, hang, memory or chatter")
      ->required()
      ->check(CLI::IsMember({"crash", "killed", "hang", "memory", "chatter"}));
  command.callback([&request] { request.run = [&request] { misbehave(request.misbehavior); }; });
}

}  // namespace

int take_worker_words(int argc, const char* const* argv, Request& request) {
  if (argc < 2 || std::string_view(argv[1]) != "batch") return argc;
  for (int i = 2; i < argc; ++i) {
    if (std::string_view(argv[i]) != "--") continue;
    request.batch.worker.assign(argv + i + 1, argv + argc);
    return i;
  }
  return argc;
}

void add_batch(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand(
      "batch", "Run build, medial or spheres on every mesh of a folder, each in a process of its own");
  BatchCommand& batch = request.batch;
  command
      .add_option("source", batch.sources,
                  "Folder of meshes, or a file with the path of a mesh in each line. Or: merge FOLDER.., to join the "
                  "results of "
                  "batches in one table")
      ->required();
  command.add_option("-o,--output", batch.folder, "Folder that receives the results or, with merge, the table");
  command
      .add_option("--shard", batch.shard,
                  "i/n: process only the i-th of n parts of the meshes, so that n machines can share them. They may "
                  "write to the "
                  "same folder")
      ->capture_default_str();
  command
      .add_option("--jobs", batch.jobs,
                  "Number of meshes that are processed at a time, each on one thread (default: one per processor)")
      ->check(CLI::Range(1, 1024));
  command.add_option("--timeout", batch.timeout, "Largest time of a mesh, in seconds (default: no limit)")
      ->check(NumberValidator(CLI::Range(0.01, 1e7)));
  command
      .add_option(
          "--memory", batch.memory,
          "Largest resident memory of a mesh, in MiB, measured every few hundredths of a second (default: no limit)")
      ->check(CLI::Range(16, 1 << 24));
  command.add_flag("--resume", batch.resume,
                   "Continue an earlier run of this shard: process only the meshes without a result");
  command.add_flag("--cost", batch.cost, "Print the expected time and memory of the shards and run nothing");
  command.add_option("--fault", batch.faults, "KIND=MESH: for tests")->allow_extra_args(false)->group("");
  add_output_flags(command, batch.output);
  command.footer(
      "After --, write the command for every mesh, build, medial or spheres, with its options but without\n"
      "the mesh and -o. The exit code is 0 if every mesh has a result or failed on its own, and 1 if meshes\n"
      "were killed from outside or could not be written.\n"
      "Examples:\n  orchard batch data -o out/batch --timeout 600 --memory 2000 -- build --depth 2 --no-views\n"
      "  orchard batch data -o out/shards --shard 1/2 --resume -- medial --samples 1500 --raw --no-views\n"
      "  orchard batch merge out/batch -o out/batch/table\n"
      "  orchard batch data --cost --shard 1/4 -- build");
  command.callback([&request, &command] {
    request.batch.output.run = invocation_of(command, request.typed);
    request.batch.given = given_of(command);
    request.run = [&request] { request.exit_code = orchard::apps::batch(request.batch); };
  });
  add_misbehave(app, request);
}

}  // namespace orchard::apps
