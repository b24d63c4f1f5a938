// How even surface points are before and after relaxation, and what it costs:  orchard_sampling_bench mesh..
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/sampling.h"

namespace orchard {
namespace {

struct Run {
  Evenness evenness;
  double seconds;
};

Run run(const Surface& surface, Index points, int iterations) {
  const auto begin = std::chrono::steady_clock::now();
  const SurfaceSampling sampling =
      sample_surface(surface, {.face_points = points, .edge_points = 0, .iterations = iterations});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return {evenness(sampling, surface), seconds};
}

void compare(const std::filesystem::path& file) {
  const Surface surface(read_mesh(file));
  for (const Index points : {5'000u, 100'000u}) {
    const Run before = run(surface, points, 0), after = run(surface, points, SamplingOptions{}.iterations);
    std::printf("%-18s %8zu %9u | %8.3f %8.3f | %8.3f %8.3f %9.2f\n", file.stem().c_str(),
                surface.mesh().triangles.size(), points, before.evenness.min, before.evenness.variation,
                after.evenness.min, after.evenness.variation, after.seconds);
  }
}

}  // namespace
}  // namespace orchard

int main(int argc, char** argv) {
  std::printf("%-18s %8s %9s | %8s %8s | %8s %8s %9s\n", "", "", "", "before", "", "relaxed", "", "");
  std::printf("%-18s %8s %9s | %8s %8s | %8s %8s %9s\n", "mesh", "trian.", "points", "least", "spread", "least",
              "spread", "seconds");
  for (int i = 1; i < argc; ++i) try {
      orchard::compare(argv[i]);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: %s\n", argv[i], error.what());
    }
}
