#include "command_line/command_line.h"

#include <fmt/core.h>

#include <optional>

#include "command_line/add_commands.h"
#include "command_line/command_list.h"
#include "command_line/help.h"
#include "command_line/list_option.h"
#include "command_line/number_validator.h"
#include "command_line/shared_options.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

void add_inspect(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand(
      "inspect", "Report what a mesh, tree, axis, sphere set or point file contains and what is wrong with it");
  InspectCommand& inspect = request.inspect;
  command
      .add_option("file", inspect.file,
                  mesh_help("Sphere-tree (.orchard, .sph), medial axis (.ma, ..), sphere set (.txt, .csv, .json, ..), "
                            "points or mesh"))
      ->required();
  request.meshes.push_back({&inspect.file, &inspect.input});
  add_mesh_input(command, inspect.input);
  add_join(command, inspect.join);
  command.add_flag("--full", inspect.full, "Search meshes of more than 500,000 triangles for self-intersections, too");
  add_output_flags(command, inspect.output);
  command.footer(
      "Examples:\n  orchard inspect data/lamp.obj --unit cm\n  orchard inspect out/lamp/lamp.orchard\n  orchard "
      "inspect scan.stl --json");
  command.callback([&request, &command] {
    request.inspect.output.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::inspect(request.inspect); };
  });
}

void add_figure(CLI::App& command, ViewCommand& view) {
  CLI::Option* color = command.add_option("--color", view.color,
                                          "Colour by an array: radius or structure of axes; radius, error, inaccuracy "
                                          "or level of trees; any array of .vtp files");
  command
      .add_option("--range", view.range,
                  "A,B: values at the ends of the colour bar (default: the smallest and largest value)")
      ->needs(color);
  command
      .add_option("--map", view.map,
                  "Map from values to colours. The lightness of each rises or falls all the way, also for colour-blind "
                  "eyes. viridis, cividis, blues and grey leave seams visible in orange; heat is pale at small values, "
                  "for errors")
      ->capture_default_str()
      ->check(CLI::IsMember({"viridis", "cividis", "blues", "heat", "grey"}));
  CLI::Option* place = command.add_option("--look-at", view.look_at, "X,Y,Z: point in the middle of the picture");
  command
      .add_option("--width", view.width,
                  "Width of the region around --look-at that fills the picture, in mesh units (default: everything)")
      ->needs(place)
      ->check(CLI::PositiveNumber);
  command.add_option("--clip", view.clip, "A,B,C,D: cut away all points with A x + B y + C z > D");
  command.add_flag("--edges", view.edges,
                   "Draw the borders (black) and seams (orange) of axes and the feature edges of .vtp files. Pictures "
                   "of lines always have them");
  command.add_flag("--balls", view.balls, "Draw the balls of axes in place of their sheets");
  command
      .add_option("--layout", view.layout,
                  "Draw the files over each other, or each in a picture of its own with the meshes around it")
      ->capture_default_str()
      ->check(CLI::IsMember({"over", "beside"}));
  command.add_flag("--captions", view.captions, "Write names and figures below the pictures");
  command.add_flag("--transparent", view.transparent, "Make the background transparent");
  command.add_option("--turn", view.turn, "Draw this many pictures of a full turn: PICTURE-001.png ..")
      ->check(CLI::Range(2, 3600));
  CLI::Option* frame =
      command.add_option("--frame", view.frame, "Time step of series (.pvd) to draw, from 1 (default: the last one)");
  frame->check(CLI::Range(1, 1'000'000));
  command
      .add_flag("--play", view.play,
                "Draw a picture for each time step of the series (.pvd), with one camera: PICTURE-001.png ..")
      ->excludes(frame);
}

void add_view(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("view", "Render meshes, medial axes and sphere-trees to a picture or an interactive window");
  ViewCommand& view = request.view;
  command
      .add_option(
          "files", view.files,
          mesh_help("Sphere-trees (.orchard, .sph), sphere sets (.txt, .csv, .json), medial axes (.ma), Voronoi "
                    "diagrams (.vor), points (.xyz), views (.vtp, .vtu), series of views, such as simulations "
                    "(.pvd), or meshes"))
      ->required();
  add_mesh_input(command, view.input);
  command.add_option("-o,--output", view.picture,
                     "Picture to write: .png, or .svg or .pdf for a picture of lines, which needs no display. With "
                     "--window, the key s saves it (.png)");
  add_list(
      command, "--level", view.levels,
      "Level of the trees to draw, 0 for the root. Several, such as 1,2,3, get a panel each (default: the deepest)", 0,
      1'000'000);
  command.add_option(
      "--camera", view.camera,
      "A,B: direction of view, A degrees from the front to the right and B degrees upward (default: 34,23)");
  command.add_option("--up", view.up, "Axis that points up")
      ->check(CLI::IsMember({"x", "y", "z"}))
      ->capture_default_str();
  command.add_option(
      "--size", view.size,
      "WIDTHxHEIGHT in pixels, or points of a picture of lines (default: fits the model; 1000x800 for a window)");
  command
      .add_option("--opacity", view.opacity,
                  "Opacity of meshes around axes, trees or points. 0 hides the meshes, 1 hides what is inside")
      ->check(NumberValidator(CLI::Range(0.0, 1.0)))
      ->capture_default_str();
  add_figure(command, view);
  command.add_flag("--window", view.window,
                   "Open a window. Keys: up, down and digits choose the level, o and O change the opacity of meshes, s "
                   "saves the picture, r resets the view, q closes. A click on a sphere prints its record");
  command.add_flag("--quiet", view.quiet, "Print errors only");
  command.footer(
      "Examples:\n  orchard view out/lamp/lamp.orchard data/lamp.obj -o out/lamp/view.png --level 1,2,3\n"
      "  orchard view out/lamp/lamp.ma data/lamp.obj -o out/lamp/lines.pdf\n"
      "  orchard view out/lamp/lamp.orchard --window");
  command.callback([&request, &command] {
    request.view.run = invocation_of(command, request.typed);
    request.run = [&request] { orchard::apps::view(request.view); };
  });
}

void add_report_command(CLI::App& app, Request& request) {
  CLI::App& command =
      *app.add_subcommand("report", "Write one page of HTML about several runs of any commands, from their reports");
  ReportCommand& report = request.report;
  command
      .add_option("reports", report.reports,
                  "Reports that commands wrote (.json), or that --json printed. A picture of the same name beside a "
                  "report is shown, too")
      ->required();
  command.add_option("-o,--output", report.page, "Page to write (.html)")->required();
  command.add_flag("--quiet", report.quiet, "Print errors only");
  command.footer(
      "Examples:\n  orchard report out/lamp/lamp.json out/lamp/lamp-medial.json -o out/lamp/page.html\n"
      "  orchard report out/lamp/lamp-medial.json out/fine/lamp-medial.json -o compared.html");
  command.callback([&request] { request.run = [&request] { orchard::apps::report(request.report); }; });
}

void add_completion(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("completion", "Print a completion script for a shell");
  command.add_option("shell", request.shell, "Shell that runs the script: bash or zsh")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh"}));
  command.footer(
      "Examples:\n  orchard completion bash > ~/.local/share/bash-completion/completions/orchard\n"
      "  orchard completion zsh > /usr/local/share/zsh/site-functions/_orchard");
  command.callback([&app, &request] {
    request.run = [&app, &request] {
      fmt::print("{}", request.shell == "bash" ? bash_completion(app) : zsh_completion(app));
    };
  });
}

// The command that makes the manual page and the page of all options. --help does not list it.
void add_reference(CLI::App& app, Request& request) {
  CLI::App& command = *app.add_subcommand("reference", "Print all commands and options")->group("");
  command.add_option("format", request.format, "Format to print")
      ->required()
      ->check(CLI::IsMember({"markdown", "man"}));
  command.callback([&app, &request] {
    request.run = [&app, &request] {
      fmt::print("{}", request.format == "man" ? manual_page(app, ORCHARD_VERSION) : markdown_reference(app));
    };
  });
}

// Refuses empty values, which usually come from an unset variable of a script. An empty value is a mistake, and not the
// same as leaving the option out.
void refuse_empty_values(CLI::App& app) {
  const CLI::Validator named([](std::string& value) { return value.empty() ? "the value is empty" : ""; }, "");
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    for (CLI::Option* option : command->get_options())
      if (option->get_expected_min() > 0) option->check(named);
}

}  // namespace

void take_standard_input(Request& request) {
  std::vector<Request::MeshArgument> all = request.meshes;
  for (std::filesystem::path& file : request.view.files) all.push_back({&file, &request.view.input});
  for (const auto& [file, input] : all) {
    if (*file != "-") continue;
    if (input->format.empty()) throw InputError("standard input: --format NAME is needed, such as --format stl");
    if (!request.standard_input) request.standard_input.emplace(input->format);
    *file = request.standard_input->file();
  }
}

void add_commands(CLI::App& app, Request& request) {
  add_build(app, request);
  add_collide(app, request);
  add_verify(app, request);
  add_inspect(app, request);
  add_sample(app, request);
  add_compare(app, request);
  add_spheres(app, request);
  add_audit(app, request);
  add_robot(app, request);
  add_voronoi(app, request);
  add_medial(app, request);
  add_leaderboard(app, request);
  add_thickness(app, request);
  add_skeleton(app, request);
  add_segment(app, request);
  add_offset(app, request);
  add_view(app, request);
  add_report_command(app, request);
  add_completion(app, request);
  add_reference(app, request);
  add_profile(app, request);
  add_simulate(app, request);
  add_batch(app, request);
  refuse_empty_values(app);
  group_options(app);
}

}  // namespace orchard::apps
