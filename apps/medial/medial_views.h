#pragma once
#include <optional>
#include <string>
#include <vector>

#include "command_line/commands.h"
#include "medial/axis_importance.h"
#include "orchard/medial/build.h"
#include "orchard/medial/quality.h"
#include "orchard/medial/segments.h"
#include "output/outputs.h"

// What `orchard medial` shows: files for ParaView, and a picture.
namespace orchard::apps {

// What is wrong where, in the units of medial_measures(): percent of the diagonal, and of the radius for centredness.
struct MedialErrors {
  BallErrors vertices;  // of the medial mesh, of which the axis's come first
  BallErrors faces;     // of the balls at the middles of the axis's faces, then of its topology faces; no centredness
  SurfaceErrors points, mesh;  // at the surface points, and at the vertices of the mesh
};
// Of an axis that was built here.
MedialErrors medial_errors(const Surface& surface, const MedialBuild& build, const MedialMesh& mesh,
                           const QualityOptions& options);

// Every name that they may have.
std::vector<std::string> view_names(const std::filesystem::path& model);

struct MedialViews {
  const Surface& surface;
  const MedialBuild& build;
  const MedialSegments& segments;
  const StructureGraph& graph;
  const MedialMesh& mesh;
  const MedialErrors* errors = nullptr;  // null: not measured
  std::vector<ImportanceArray> importance = {};
  std::vector<WorstPlace> worst = {};
};
// Where the program was built with VTK.
void write_views(const MedialCommand& command, const MedialViews& views, Outputs& outputs);

// An axis of a picture, and where it is worst.
struct PicturedAxis {
  std::string name;  // of axes beside the first one
  const MedialMesh* mesh = nullptr;
  std::vector<WorstPlace> worst = {};  // empty: not measured
};

// A picture of where axes are worst, as `name`, with the places of each numbered from 1 on: with --picture, and for the
// page of --report unless there are no views. Coverage is shown at `sampling`, or at points of its own if that is null.
// Returns the bytes; empty if nothing was drawn. On a machine that cannot draw, a line says why.
std::string write_picture(const MedialCommand& command, const Surface& surface, const std::vector<PicturedAxis>& axes,
                          const SurfaceSampling* sampling, const std::string& name, Outputs& outputs);

}  // namespace orchard::apps
