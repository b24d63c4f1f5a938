// Rays against one body, one by one and many in a call, by its tree and by a ray index, against Embree in the same run:
//   rays_bench [-n rays] [-every-machine] body.obj|body.orchard ..
// Means in microseconds of one thread, each over the best of a few passes through all rays, of all engines in turn.
#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bodies.h"
#include "orchard/runtime/shape_query.h"
#include "simd/machine.h"
#include "support.h"

namespace {

using namespace orchard::bench;
using namespace orchard::runtime;

constexpr int kPasses = 10;
#ifdef ORCHARD_NO_VECTORS
constexpr const char* kBaseName = "plain";
#else
constexpr const char* kBaseName = "SSE2";
#endif

// The triangles that the tree stores.
class EmbreeScene {
 public:
  EmbreeScene(const TreeView& tree, RTCSceneFlags flags)
      : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_)) {
    rtcSetSceneFlags(scene_, flags);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
    const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), tree.vertices.size()));
    for (const auto& v : tree.vertices) {
      for (std::size_t k = 0; k < 3; ++k) *points++ = static_cast<float>(double{v[k]} + tree.origin[k]);
    }
    auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), tree.triangles.size()));
    for (const auto& t : tree.triangles) {
      for (const std::uint32_t corner : t) *corners++ = corner;
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  ~EmbreeScene() { rtcReleaseScene(scene_), rtcReleaseDevice(device_); }

  static RTCRayHit query_of(const Ray& ray) {
    RTCRayHit query{};
    query.ray.org_x = static_cast<float>(ray.origin[0]), query.ray.org_y = static_cast<float>(ray.origin[1]);
    query.ray.org_z = static_cast<float>(ray.origin[2]), query.ray.dir_x = static_cast<float>(ray.direction[0]);
    query.ray.dir_y = static_cast<float>(ray.direction[1]), query.ray.dir_z = static_cast<float>(ray.direction[2]);
    query.ray.tfar = static_cast<float>(ray.longest);
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return query;
  }
  static float along(const RTCRayHit& query) {  // of the first hit, or infinite
    return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : query.ray.tfar;
  }
  float cast(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query = query_of(ray);
    rtcIntersect1(scene_, &context, &query);
    return along(query);
  }
  void cast(const std::vector<Ray>& rays, bool coherent, std::vector<RTCRayHit>& queries,
            std::vector<float>& hits) const {
    for (std::size_t i = 0; i < rays.size(); ++i) queries[i] = query_of(rays[i]);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcIntersect1M(scene_, &context, queries.data(), static_cast<unsigned>(queries.size()), sizeof(RTCRayHit));
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = along(queries[i]);
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

struct RaySet {
  const char* name;
  bool coherent;
  std::vector<Ray> rays;
};

// From 2 R into the bounding sphere; from within half of R every way; and a camera's, 3 R away, line by line.
std::vector<RaySet> ray_sets(const TreeView& tree, std::size_t count) {
  const SiblingBlock& root = tree.blocks[0];
  const double radius = double{root.radius[0]};
  const std::array<double, 3> middle = {tree.origin[0] + double{root.x[0]}, tree.origin[1] + double{root.y[0]},
                                        tree.origin[2] + double{root.z[0]}};
  std::vector<RaySet> sets = {{"outside", false, {}}, {"inside", false, {}}, {"camera", true, {}}};
  for (RaySet& set : sets) set.rays.resize(count);
  const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(static_cast<double>(count))));
  for (std::size_t i = 0; i < count; ++i) {
    test::Draw draw(i);
    const auto from = draw.direction(), to = draw.direction();
    const double depth = draw.uniform(0, 1);
    const double x = 2.0 * static_cast<double>(i % side) / static_cast<double>(side) - 1;
    const double y = 2.0 * static_cast<double>(i / side) / static_cast<double>(side) - 1;
    const std::array<double, 3> pixel = {x, y, 2.4};
    for (std::size_t k = 0; k < 3; ++k) {
      Ray &outside = sets[0].rays[i], &inside = sets[1].rays[i], &camera = sets[2].rays[i];
      outside.origin[k] = middle[k] + 2 * radius * from[k];
      outside.direction[k] = 2 * (middle[k] + depth * radius * to[k] - outside.origin[k]);
      outside.longest = 1;
      inside.origin[k] = middle[k] + 0.5 * depth * radius * to[k];
      inside.direction[k] = from[k];
      camera.origin[k] = middle[k] + (k == 2 ? -3 * radius : 0.1 * radius);
      camera.direction[k] = pixel[k];
    }
  }
  return sets;
}

void measure(const char* name, const TreeView& tree, std::size_t count) {
  const RayIndex index(tree);
  const EmbreeScene fast(tree, RTC_SCENE_FLAG_NONE), careful(tree, RTC_SCENE_FLAG_ROBUST);
  std::vector<std::optional<RayHit>> hits[4];
  for (auto& of : hits) of.resize(count);
  std::vector<float> theirs(count), robust(count), stream(count);
  std::vector<RTCRayHit> queries(count);
  for (const RaySet& set : ray_sets(tree, count)) {
    const std::vector<Ray>& rays = set.rays;
    const auto one_by_one = [&](const auto& body, std::vector<std::optional<RayHit>>& to) {
      for (std::size_t i = 0; i < count; ++i) {
        to[i] = cast_ray(body, {}, rays[i].origin, rays[i].direction, rays[i].longest);
      }
    };
    const auto by_embree = [&](const EmbreeScene& scene, std::vector<float>& to) {
      for (std::size_t i = 0; i < count; ++i) to[i] = scene.cast(rays[i]);
    };
    const std::function<void()> engines[] = {[&] { one_by_one(tree, hits[0]); },
                                             [&] { cast_rays(tree, {}, rays, hits[1]); },
                                             [&] { one_by_one(index, hits[2]); },
                                             [&] { cast_rays(index, {}, rays, hits[3]); },
                                             [&] { by_embree(fast, theirs); },
                                             [&] { by_embree(careful, robust); },
                                             [&] { fast.cast(rays, set.coherent, queries, stream); }};
    constexpr std::size_t kEngines = std::size(engines);
    double best[kEngines];
    std::fill_n(best, kEngines, 1e300);
    for (int pass = 0; pass < kPasses; ++pass) {
      for (std::size_t turn = 0; turn < 2 * kEngines; ++turn) {  // twice each: the first time fills the caches
        const std::size_t e = turn / 2;
        const std::clock_t start = std::clock();  // processor time, for machines that are not idle
        engines[e]();
        const double time = 1e6 / CLOCKS_PER_SEC * static_cast<double>(std::clock() - start);
        best[e] = std::min(best[e], time / static_cast<double>(count));
      }
    }
    std::size_t hit = 0, differ = 0;
    for (std::size_t i = 0; i < count; ++i) {
      hit += hits[0][i].has_value();
      bool same =
          hits[0][i].has_value() == (robust[i] <= static_cast<float>(rays[i].longest) && std::isfinite(robust[i]));
      for (const auto& of : hits) {
        same = same && of[i].has_value() == hits[0][i].has_value() &&
               (!of[i] || (of[i]->along == hits[0][i]->along && of[i]->triangle == hits[0][i]->triangle));
      }
      differ += !same;
    }
    std::printf("%-18s %6zu %-8s %3.0f%%", name, tree.triangles.size(), set.name,
                100.0 * static_cast<double>(hit) / static_cast<double>(count));
    for (const double time : best) std::printf(" %6.3f", time);
    std::printf("   %4.2f  %4.2f  %4.2f  %4.2f  %zu\n", best[2] / best[4], best[2] / best[5], best[3] / best[4],
                best[3] / best[6], differ);
    std::fflush(stdout);
  }
}

void print_head() {
  std::printf("%-18s %6s %-8s %4s %6s %6s %6s %6s %6s %6s %6s   ratios; differ\n", "body", "tri", "rays", "hit", "tree",
              "call", "index", "call", "Embree", "robust", "call");
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t count = 5000;
  bool any = false, every = false;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "-n" && i + 1 < argc) {
      count = static_cast<std::size_t>(std::atoi(argv[++i]));
      continue;
    }
    if (argument == "-every-machine") {
      every = true;
      continue;
    }
    if (!any) print_head();
    any = true;
    const PackedSphereTree tree = read_body(argument);
    const std::string name = argument.substr(argument.rfind('/') + 1);
    const char* const names[] = {"", kBaseName, "AVX2", "AVX-512"};
    const detail::Machine best = detail::best_machine();
    for (detail::Machine m = every ? detail::Machine::base : best; m <= best;
         m = static_cast<detail::Machine>(static_cast<int>(m) + 1)) {
      detail::use_machine(m);
      if (every) std::printf("%s\n", names[static_cast<int>(m)]);
      measure(name.c_str(), tree, count);
    }
  }
  if (!any) std::fprintf(stderr, "usage: rays_bench [-n rays] [-every-machine] body.obj|body.orchard ..\n");
  return any ? 0 : 2;
}
