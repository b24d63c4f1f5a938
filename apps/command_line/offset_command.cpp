// The options of `orchard offset`.
#include <optional>

#include "command_line/add_commands.h"
#include "command_line/number_validator.h"
#include "command_line/shared_options.h"

namespace orchard::apps {
namespace {

void add_offset_options(CLI::App& command, OffsetCommand& offset) {
  constexpr double kSmallest = 1e-12;
  CLI::Option* distance =
      command
          .add_option("--distance", offset.distance, "Distance of the result from the surface, in mesh units, above 0")
          ->check(NumberValidator(CLI::Range(kSmallest, kMaxCoordinate)));
  CLI::Option* side =
      command
          .add_option_function<std::string>(
              "--side",
              [&offset](const std::string& name) {
                offset.side = name == "both"     ? OffsetSide::both
                              : name == "inside" ? OffsetSide::inside
                                                 : OffsetSide::outside;
              },
              "Grow the solid (outside, default), shrink it (inside), or make a shell that reaches this far on either "
              "side of the surface (both). Only a shell may be of an open surface")
          ->check(CLI::IsMember({"outside", "inside", "both"}))
          ->needs(distance);
  command
      .add_option("--hollow", offset.hollow,
                  "Hollow the solid, with walls of this thickness or a little more, in mesh units. Parts thinner than "
                  "two walls stay solid")
      ->check(NumberValidator(CLI::Range(kSmallest, kMaxCoordinate)))
      ->excludes(distance)
      ->excludes(side);
  command
      .add_option("--tolerance", offset.tolerance,
                  "Largest error of the distance at any place of the result, in percent of the diagonal. Half of it "
                  "takes four times as long")
      ->check(NumberValidator(CLI::Range(100 * kMinOffsetTolerance, 50.0)))
      ->capture_default_str();
}

}  // namespace

void add_offset(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand(
      "offset", "Grow, shrink, thicken or hollow a solid by an exact distance, with a proven error");
  OffsetCommand& offset = request.offset;
  add_mesh(command, request, offset.mesh, offset.reading.input);
  command
      .add_option("-o,--output", offset.folder,
                  "Folder that receives the result and the report, or a file for the result alone (.obj, .ply or .vtp)")
      ->required();
  add_offset_options(command, offset);
  offset.reading.unite = true;
  add_mesh_options(command, offset.reading);
  add_threads(command, request);
  command.add_flag("!--no-views", offset.views, "Do not write files for ParaView");
  add_report(command, offset.report);
  add_accept(command, offset.accept);
  add_force(command, offset.output);
  add_output_flags(command, offset.output);
  command.footer(
      "Examples:\n  orchard offset data/lamp.obj -o out/lamp --distance 0.05\n"
      "  orchard offset data/lamp.obj -o out/lamp-inside.obj --distance 0.02 --side inside\n"
      "  orchard offset data/faucet.obj -o out/faucet --hollow 0.03 --tolerance 0.3");
  command.callback([&request, &command] {
    request.offset.output.run = invocation_of(command, request.typed);
    request.run = [&request] { request.exit_code = orchard::apps::offset(request.offset); };
  });
}

}  // namespace orchard::apps
