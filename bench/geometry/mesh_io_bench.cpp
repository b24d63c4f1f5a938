// Reads one large OBJ file with orchard's reader and with its peers', in turns, and prints the best rate of each.
//   mesh_io_bench [megabytes]
#include <CGAL/IO/OBJ.h>
#include <CGAL/Simple_cartesian.h>
#include <unistd.h>
#ifdef ORCHARD_BENCH_VTK
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPolyData.h>
#endif

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/mesh_io.h"

namespace {

using orchard::Index;

// A wavy sheet of n x n quadrilaterals, cut in two: every line differs, as in a scan.
orchard::TriangleMesh sheet(Index n) {
  orchard::TriangleMesh mesh;
  for (Index i = 0; i <= n; ++i) {
    for (Index j = 0; j <= n; ++j) {
      const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
      mesh.vertices.emplace_back(x, y, 0.1 * std::sin(20 * x) * std::cos(30 * y));
    }
  }
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      const Index a = i * (n + 1) + j, b = a + n + 1;
      mesh.triangles.push_back({a, b, b + 1});
      mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }
  return mesh;
}

struct Size {
  std::size_t vertices, triangles;
  bool operator==(const Size&) const = default;
};

Size read_with_orchard(const std::string& file) {
  const orchard::TriangleMesh mesh = orchard::read_mesh(file);
  return {mesh.vertices.size(), mesh.triangles.size()};
}

Size read_with_cgal(const std::string& file) {
  std::vector<CGAL::Simple_cartesian<double>::Point_3> points;
  std::vector<std::vector<std::size_t>> polygons;
  CGAL::IO::read_OBJ(file, points, polygons);
  return {points.size(), polygons.size()};
}

#ifdef ORCHARD_BENCH_VTK
Size read_with_vtk(const std::string& file) {
  vtkNew<vtkOBJReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  return {static_cast<std::size_t>(reader->GetOutput()->GetNumberOfPoints()),
          static_cast<std::size_t>(reader->GetOutput()->GetNumberOfPolys())};
}
#endif

struct Peer {
  const char* name;
  std::function<Size(const std::string&)> read;
  double seconds = INFINITY;
};

double seconds_of(const std::function<void()>& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int main(int argc, char** argv) {
  const double wanted = argc > 1 ? std::atof(argv[1]) : 100;
  // A vertex and its two triangles take about 97 bytes.
  const auto n = static_cast<Index>(std::sqrt(std::max(wanted, 0.1) * 1e6 / 97));
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("orchard_mesh_io_bench_" + std::to_string(getpid()) + ".obj");
  const orchard::TriangleMesh mesh = sheet(n);
  const double writing = seconds_of([&] { orchard::write_obj(path, mesh); });
  const double megabytes = static_cast<double>(std::filesystem::file_size(path)) * 1e-6;
  std::printf("%zu vertices, %zu triangles, %.1f MB; written at %.0f MB/s\n", mesh.vertices.size(),
              mesh.triangles.size(), megabytes, megabytes / writing);

  std::vector<Peer> peers{{"orchard", read_with_orchard}, {"CGAL", read_with_cgal}};
#ifdef ORCHARD_BENCH_VTK
  peers.push_back({"VTK", read_with_vtk});
#endif
  bool agree = true;
  for (int round = 0; round < 3; ++round) {
    for (Peer& peer : peers) {
      Size size{};
      peer.seconds = std::min(peer.seconds, seconds_of([&] { size = peer.read(path.string()); }));
      agree = agree && size == Size{mesh.vertices.size(), mesh.triangles.size()};
    }
  }
  std::filesystem::remove(path);
  std::printf("reader,seconds,MB/s,times slower than orchard\n");
  for (const Peer& peer : peers) {
    std::printf("%s,%.3f,%.1f,%.2f\n", peer.name, peer.seconds, megabytes / peer.seconds,
                peer.seconds / peers[0].seconds);
  }
  std::printf("check_mesh,%.3f\n", seconds_of([&] { orchard::check_mesh(mesh); }));
  if (!agree) std::printf("the readers disagree about the numbers of vertices and triangles\n");
  return agree ? 0 : 1;
}
