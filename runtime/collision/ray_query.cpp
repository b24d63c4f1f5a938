#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "collision/ray_walk.h"
#include "collision/segment_meets.h"
#include "math/exact_sign.h"
#include "orchard/runtime/shape_query.h"

namespace orchard::runtime {

using namespace detail;

// The triangles of a ray index, with the same functions as TreeTriangles.
struct detail::IndexTriangles {
  const RayIndex& index;

  Frame frame(const Pose& pose) const noexcept { return {index.origin_, index.bounding_radius_, pose}; }
  Ball ball() const noexcept { return {index.middle_, index.radius_}; }
  template <typename Visit>
  void along(const Line& line, Visit&& visit) const noexcept {
    const BoxTree tree{index.boxes_, index.leaves_, index.sizes_};
    const BoxRay ray(line.ray);
    const std::uint32_t first = tree.boxes.size() > 1 ? 1 : 0;  // the root's children, unless it is a leaf
    RayWalk walk(line.ray, line.begin, line.end, first);
    for (RayLeaf leaf = next_leaf(tree, ray, walk); leaf.block != nullptr; leaf = next_leaf(tree, ray, walk)) {
      walk.end = visit(leaf, walk.end);
    }
  }
  std::span<const TriangleBlock> all() const noexcept { return index.leaves_; }
};

namespace {

// The end of a ray.
struct RayEnd {
  const Direction& direction;
  double longest;

  // Returns whether the ray, which meets the triangle or its plane after `at` steps, gets so far: it does if the
  // distance that the query reports is at most `longest`. If it is longer by no more than rounding, an exact test of
  // the ray's last point decides.
  bool reaches(const RayStart& ray, const TrianglePoints& t, double at) const noexcept {
    constexpr double kExact = 1 - 0x1p-48, kPlace = 0x1p-38;  // kPlace: the error of a place, of the whole way
    if (at <= ray.end * kExact || direction.along(at) <= longest) return true;
    if (at > ray.end + kPlace * (ray.steps_to(ray.to) + one_norm(ray.from) * ray.slowness)) return false;
    const Vec3 last = settled(along(ray.from, ray.step, ray.end));
    const int begins = orientation(t[0], t[1], t[2], ray.from), ends = orientation(t[0], t[1], t[2], last);
    Vec3 common{};
    return begins == 0 && ends == 0 ? segment_meets(ray.from, last, t, common) : begins * ends <= 0;
  }
};

// The nearest triangle so far.
struct Nearest {
  double steps = std::numeric_limits<double>::infinity();
  Vec3 point{};
  std::uint32_t triangle = kNoTriangle;

  // Makes a triangle the nearest one if it is nearer or, among equally near ones, has the smaller number. Returns
  // whether it did. `sure` is whether the line certainly passes through it.
  bool offer(const RayStart& ray, const RayEnd& limit, const TrianglePoints& t, std::uint32_t number,
             bool sure) noexcept {
    Vec3 common{};
    if (!(sure ? segment_passes(ray.from, ray.to, t, common) : segment_meets(ray.from, ray.to, t, common)))
      return false;
    const double at = max(ray.steps_to(common), 0);
    if (at > steps || (at == steps && number > triangle) || !limit.reaches(ray, t, at)) return false;
    steps = at, point = common, triangle = number;
    return true;
  }
};

// Finds the first triangles along rays in the frame of a body.
template <typename Triangles>
class Caster {
 public:
  Caster(const Triangles& triangles, const Pose& pose) noexcept
      : triangles_(triangles), frame_(triangles.frame(pose)), ball_(triangles.ball()) {}

  // Casts all rays. It computes the starts of several rays at a time, and then walks along each of them.
  void cast(std::span<const Ray> rays, std::span<std::optional<RayHit>> hits) const noexcept {
    RayStarts starts;
    std::array<int, RayStarts::kCount> powers;
    std::size_t first = 0;
    for (; first + RayStarts::kCount <= rays.size(); first += RayStarts::kCount) {
      for (std::size_t i = 0; i < RayStarts::kCount; ++i) {
        const Ray& ray = rays[first + i];
        const Direction direction(ray.direction, frame_.pose.scale);
        for (std::size_t k = 0; k < 3; ++k) starts.origin[k][i] = ray.origin[k], starts.way[k][i] = direction.way[k];
        starts.steps[i] = direction.steps(ray.longest), powers[i] = direction.power;
      }
      find_starts(frame_, ball_, starts);
      for (std::size_t i = 0; i < RayStarts::kCount; ++i) {
        const Direction direction(frame_.pose.scale, powers[i]);
        hits[first + i] = cast(rays[first + i], direction, starts.at_lane(i));
      }
    }
    for (; first < rays.size(); ++first) {
      const Ray& ray = rays[first];
      const Direction direction(ray.direction, frame_.pose.scale);
      const double steps = direction.steps(ray.longest);
      hits[first] = cast(ray, direction, start_of(frame_, ball_, ray.origin, direction.way, steps));
    }
  }

 private:
  std::optional<RayHit> cast(const Ray& ray, const Direction& direction, const RayStart& start) const noexcept {
    if (std::isnan(ray.longest) || !within_reach(start.from) || !std::isfinite(start.speed)) {
      return RayHit{0, ray.origin, kNoTriangle};
    }
    if (ray.longest < 0 || start.line.misses) return std::nullopt;
    const RayEnd limit{direction, ray.longest};
    const Nearest nearest = nearest_along(start, limit);
    if (nearest.triangle == kNoTriangle) return std::nullopt;
    return RayHit{min(direction.along(nearest.steps), ray.longest), frame_.leave(nearest.point), nearest.triangle};
  }

  Nearest nearest_along(const RayStart& ray, const RayEnd& limit) const noexcept {
    Nearest nearest;
    const auto offer = [&](const TrianglePoints& points, std::uint32_t triangle, bool sure, float end) {
      if (!nearest.offer(ray, limit, points, triangle, sure) || !ray.line.in_float) return end;
      const double rounding = kRounding * (one_norm(ray.from) + frame_.bounding_radius);
      const double s = nearest.steps * ray.speed;
      const float behind = static_cast<float>(s + rounding - ray.line.at) + ray.line.ray.margin;
      return behind < end ? behind : end;
    };
    each_triangle_along(triangles_, ray.line, offer);
    return nearest;
  }

  Triangles triangles_;
  Frame frame_;
  Ball ball_;
};

template <typename Triangles>
void cast_all(const Triangles& triangles, const Pose& pose, std::span<const Ray> rays,
              std::span<std::optional<RayHit>> hits) noexcept {
  if (triangles.all().empty()) {
    std::fill_n(hits.begin(), rays.size(), std::nullopt);
  } else if (is_rigid(pose)) {
    Caster<Triangles>(triangles, pose).cast(rays, hits);
  } else {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = RayHit{0, rays[i].origin, kNoTriangle};
  }
}

template <typename Triangles>
std::optional<RayHit> cast_one(const Triangles& triangles, const Pose& pose, const Ray& ray) noexcept {
  std::optional<RayHit> hit;
  cast_all(triangles, pose, {&ray, 1}, {&hit, 1});
  return hit;
}

}  // namespace

std::optional<RayHit> cast_ray(const TreeView& tree, const Pose& pose, const std::array<double, 3>& origin,
                               const std::array<double, 3>& direction, double longest) noexcept {
  return cast_one(TreeTriangles{tree}, pose, {origin, direction, longest});
}

void cast_rays(const TreeView& tree, const Pose& pose, std::span<const Ray> rays,
               std::span<std::optional<RayHit>> hits) noexcept {
  cast_all(TreeTriangles{tree}, pose, rays, hits);
}

std::optional<RayHit> cast_ray(const RayIndex& index, const Pose& pose, const std::array<double, 3>& origin,
                               const std::array<double, 3>& direction, double longest) noexcept {
  return cast_one(IndexTriangles{index}, pose, {origin, direction, longest});
}

void cast_rays(const RayIndex& index, const Pose& pose, std::span<const Ray> rays,
               std::span<std::optional<RayHit>> hits) noexcept {
  cast_all(IndexTriangles{index}, pose, rays, hits);
}

}  // namespace orchard::runtime
