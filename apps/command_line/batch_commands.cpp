// Options of the command that runs others.
#include <string_view>

#include "batch/misbehave.h"
#include "command_line/add_commands.h"
#include "command_line/number_validator.h"
#include "command_line/shared_options.h"

namespace orchard::apps {
namespace {

// What a batch must survive, for its tests; --help does not list it.
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
      .add_option(
          "source", batch.sources,
          "A folder of meshes, or a file with the path of one in each line; or: merge FOLDER.., to make one table "
          "of what batches have written")
      ->required();
  command.add_option("-o,--output", batch.folder, "Folder for the results, or, of merge, for the table");
  command
      .add_option("--shard", batch.shard,
                  "i/n: of n parts of the meshes the i-th, so that n machines share them; the folder may be the same")
      ->capture_default_str();
  command
      .add_option("--jobs", batch.jobs,
                  "Meshes at a time, each on one thread (default: as many as there are processors)")
      ->check(CLI::Range(1, 1024));
  command.add_option("--timeout", batch.timeout, "Seconds that a mesh may take (default: no limit)")
      ->check(NumberValidator(CLI::Range(0.01, 1e7)));
  command
      .add_option(
          "--memory", batch.memory,
          "MiB of resident memory that a mesh may take, looked at every few hundredths of a second (default: no "
          "limit)")
      ->check(CLI::Range(16, 1 << 24));
  command.add_flag("--resume", batch.resume,
                   "Go on where an earlier run of this shard ended: only what is missing is run");
  command.add_flag("--cost", batch.cost, "Say what the shards will cost in time and memory, and run nothing");
  command.add_option("--fault", batch.faults, "KIND=MESH: for tests")->allow_extra_args(false)->group("");
  add_output_flags(command, batch.output);
  command.footer(
      "Behind -- is what to do with every mesh: build, medial or spheres with its options, but for the mesh and -o.\n"
      "Exit code 0 if every mesh has a result or a failure of its own, 1 if some were killed from outside or could not "
      "be "
      "written.\n"
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
