#include "orchard/viz/render.h"

#include "drawing.h"
#include "orchard/viz/medial_writer.h"

namespace orchard {

namespace fs = std::filesystem;

PictureStatus draw_pipeline(const fs::path& png, const PipelinePicture& picture) {
  return detail::draw(png, picture, {}, [&](const fs::path& prefix) { write_pipeline(prefix, picture.values); });
}

PictureStatus draw_medial_errors(const fs::path& png, const MedialErrorsPicture& errors,
                                 const PipelinePicture& picture) {
  return detail::draw(png, picture, {}, [&](const fs::path& prefix) {
    std::vector<NamedFile> files;
    const auto add = [&](const std::string& name, const std::string& ending) {
      fs::path file = with_ending(prefix, ending);
      files.push_back({name, file.filename()});
      return file;
    };
    write_mesh(add("mesh", "-mesh.vtp"), *errors.surface);
    for (std::size_t i = 0; i < errors.axes.size(); ++i) {
      const MedialErrorsOfAxis& axis = errors.axes[i];
      const std::string count = std::to_string(i + 1), number = i == 0 ? "" : " " + count;
      const std::string name = i == 0 ? "" : ": " + axis.name, ending = count + ".vtp";
      write_points(add("surface points" + number, "-points-" + ending), *errors.sampling,
                   {{"coverage", axis.coverage}});
      write_medial_mesh(add(std::string("medial mesh").append(number).append(name), "-medial-" + ending), *axis.mesh,
                        {{"protrusion", axis.protrusion}});
      write_worst_places(add("worst places" + number, "-worst-" + ending), axis.worst);
    }
    write_multiblock(with_ending(prefix, ".vtm"), files);
  });
}

}  // namespace orchard
