// Rays against one body, one by one and many in a call, against Embree's single rays in the same run:
//   rays_bench [-n rays] body.obj|body.orchard ..
// Means in microseconds of one thread, each over the best of a few passes through all rays.
#include <embree3/rtcore.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bodies.h"
#include "orchard/runtime/shape_query.h"
#include "support.h"

namespace {

using namespace orchard::bench;
using namespace orchard::runtime;

constexpr int kPasses = 15;

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

  float along(const Ray& ray) const {  // of the first hit, or infinite
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray.org_x = static_cast<float>(ray.origin[0]), query.ray.org_y = static_cast<float>(ray.origin[1]);
    query.ray.org_z = static_cast<float>(ray.origin[2]), query.ray.dir_x = static_cast<float>(ray.direction[0]);
    query.ray.dir_y = static_cast<float>(ray.direction[1]), query.ray.dir_z = static_cast<float>(ray.direction[2]);
    query.ray.tfar = static_cast<float>(ray.longest);
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &query);
    return query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : query.ray.tfar;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

// From 2 R into the bounding sphere.
std::vector<Ray> rays_at(const TreeView& tree, std::size_t count) {
  const SiblingBlock& root = tree.blocks[0];
  const double radius = double{root.radius[0]};
  const std::array<double, 3> middle = {tree.origin[0] + double{root.x[0]}, tree.origin[1] + double{root.y[0]},
                                        tree.origin[2] + double{root.z[0]}};
  std::vector<Ray> rays(count);
  for (std::size_t i = 0; i < count; ++i) {
    test::Draw draw(i);
    const auto from = draw.direction(), to = draw.direction();
    const double depth = draw.uniform(0, 1);
    for (std::size_t k = 0; k < 3; ++k) {
      rays[i].origin[k] = middle[k] + 2 * radius * from[k];
      rays[i].direction[k] = 2 * (middle[k] + depth * radius * to[k] - rays[i].origin[k]);
    }
    rays[i].longest = 1;
  }
  return rays;
}

void measure(const char* name, const TreeView& tree, std::size_t count) {
  const std::vector<Ray> rays = rays_at(tree, count);
  std::vector<std::optional<RayHit>> singles(count), hits(count);
  std::vector<float> theirs(count), robust(count);
  const EmbreeScene fast(tree, RTC_SCENE_FLAG_NONE), careful(tree, RTC_SCENE_FLAG_ROBUST);
  const std::function<void()> engines[] = {[&] {
                                             for (std::size_t i = 0; i < count; ++i) {
                                               singles[i] = cast_ray(tree, {}, rays[i].origin, rays[i].direction,
                                                                     rays[i].longest);
                                             }
                                           },
                                           [&] { cast_rays(tree, {}, rays, hits); },
                                           [&] {
                                             for (std::size_t i = 0; i < count; ++i) theirs[i] = fast.along(rays[i]);
                                           },
                                           [&] {
                                             for (std::size_t i = 0; i < count; ++i) robust[i] = careful.along(rays[i]);
                                           }};
  double best[4] = {1e300, 1e300, 1e300, 1e300};
  for (int pass = 0; pass < kPasses; ++pass) {
    for (std::size_t e = 0; e < 4; ++e) {
      const auto start = std::chrono::steady_clock::now();
      engines[e]();
      const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
      best[e] = std::min(best[e], time.count() / static_cast<double>(count));
    }
  }
  std::size_t hit = 0, differ = 0;
  for (std::size_t i = 0; i < count; ++i) {
    hit += hits[i].has_value();
    differ += hits[i].has_value() != (robust[i] <= 1) || singles[i].has_value() != hits[i].has_value();
  }
  std::printf("%-20s %9zu %6.0f %% %9.3f %9.3f %9.3f %9.3f   %5.2f   %5.2f   %5.2f  %zu\n", name, tree.triangles.size(),
              100.0 * static_cast<double>(hit) / static_cast<double>(count), best[0], best[1], best[2], best[3],
              best[0] / best[2], best[0] / best[3], best[1] / best[3], differ);
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t count = 5000;
  bool any = false;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "-n" && i + 1 < argc) {
      count = static_cast<std::size_t>(std::atoi(argv[++i]));
      continue;
    }
    if (!any) {
      std::printf("%-20s %9s %8s %9s %9s %9s %9s   ratios: one by one to Embree, to robust; in a call; %s\n", "body",
                  "triangles", "hit", "one", "in a call", "Embree", "robust", "differ");
    }
    any = true;
    const PackedSphereTree tree = read_body(argument);
    measure(argument.substr(argument.rfind('/') + 1).c_str(), tree, count);
    std::fflush(stdout);
  }
  if (!any) std::fprintf(stderr, "usage: rays_bench [-n rays] body.obj|body.orchard ..\n");
  return any ? 0 : 2;
}
