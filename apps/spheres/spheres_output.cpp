#include "spheres/spheres_output.h"

#include <fmt/format.h>

#include "output/sphere_lists.h"
#include "spheres/particle_report.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

// What an error curve has of each set.
struct CurveRow {
  double protrusion_max, protrusion_mean, gap_max, two_sided;  // percent of the diagonal
  double outside, uncovered, volume;                           // percent of the solid's volume
};

CurveRow row_of(const SphereSetBuild& set, double diagonal) {
  const SphereAudit::BesideSolid& beside = *set.audit.beside_solid;
  const double solid = beside.volume.solid;
  return {100 * beside.protrusion.upper / diagonal,     100 * beside.mean.protrusion / diagonal,
          100 * set.audit.largest_gap.upper / diagonal, 100 * beside.mean.two_sided() / diagonal,
          100 * beside.volume.outside.value / solid,    100 * beside.volume.uncovered.value / solid,
          100 * beside.volume.balls.value / solid};
}

}  // namespace

const char* name(SphereFit fit) {
  switch (fit) {
    case SphereFit::cover:
      return "cover";
    case SphereFit::inside:
      return "inside";
    case SphereFit::balanced:
      return "balanced";
    case SphereFit::particles:
      return "particles";
  }
  return "";
}

std::string promise_in_words(const SphereSetOptions& options, const SphereSetBuild& build) {
  const std::string least =
      options.min_radius > 0 ? fmt::format("; no radius is below {:g}", options.min_radius) : std::string();
  switch (build.fit) {
    case SphereFit::cover: {
      const std::string padding =
          options.padding > 0 ? fmt::format(", with everything up to {:g} from it,", options.padding) : "";
      return fmt::format("every point of the {}{} lies in a sphere{}", options.solid ? "solid" : "surface", padding,
                         least);
    }
    case SphereFit::inside:
      return "every sphere lies in the solid" + least;
    case SphereFit::particles:
      return particle_promise(options) + least;
    case SphereFit::balanced:
      break;
  }
  const UnionVolume& volume = build.audit.beside_solid->volume;
  return fmt::format("the union has the volume of the solid within {:g} % (measured: {:+.2f} %, +- {:.2f}){}",
                     100 * kBalancedVolume, 100 * (volume.balls.value / volume.solid - 1),
                     200 * volume.balls.error / volume.solid, least);
}

Broken broken(const SphereSetOptions& options, const SphereSetBuild& build, double diagonal) {
  Broken broken;
  if (build.particles) broken.what = missed_by_particles(options, *build.particles, diagonal);
  const double least = build.spheres.back().radius - options.padding;
  if (least < options.min_radius)
    broken.what.push_back(
        fmt::format("the smallest radius is {:.4g}, where {:g} was asked for", least, options.min_radius));
  if (!build.kept && broken.none()) broken.what.push_back("it is not proven that " + promise_in_words(options, build));
  if (!build.error_reached)
    broken.what.push_back(fmt::format("{} spheres do not reach the error that was asked for", build.spheres.size()));
  if (broken.none()) return broken;
  broken.remedy = build.enough ? fmt::format("{} spheres would do: -n {}", *build.enough, *build.enough)
                               : fmt::format("no number of spheres up to {} was found that would do", kMaxSetSpheres);
  return broken;
}

std::string to_text(std::span<const Sphere> spheres, std::span<const double> masses,
                    const std::vector<std::string>& head) {
  std::string text;
  for (const std::string& line : head) text += "# " + line + "\n";
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Sphere& s = spheres[i];
    text += fmt::format("{} {} {} {}", s.center.x(), s.center.y(), s.center.z(), s.radius);
    text += masses.empty() ? "\n" : fmt::format(" {}\n", masses[i]);
  }
  return text;
}

std::string to_csv(std::span<const Sphere> spheres, std::span<const double> masses) {
  std::string text = masses.empty() ? "x,y,z,r\n" : "x,y,z,r,mass\n";
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const Sphere& s = spheres[i];
    text += fmt::format("{},{},{},{}", s.center.x(), s.center.y(), s.center.z(), s.radius);
    text += masses.empty() ? "\n" : fmt::format(",{}\n", masses[i]);
  }
  return text;
}

json to_json(std::span<const Sphere> spheres, std::span<const double> masses) {
  json centers = json::array(), radii = json::array();
  for (const Sphere& s : spheres) {
    centers.push_back({s.center.x(), s.center.y(), s.center.z()});
    radii.push_back(s.radius);
  }
  json lists{{"centers", std::move(centers)}, {"radii", std::move(radii)}};
  if (!masses.empty()) lists["masses"] = masses;
  return lists;
}

std::string to_yaml(std::span<const Sphere> spheres, const std::string& link) {
  std::string text = fmt::format("collision_spheres:\n  {}:\n", json(link).dump());
  for (const Sphere& s : spheres)
    text += fmt::format("    - center: [{}, {}, {}]\n      radius: {}\n", s.center.x(), s.center.y(), s.center.z(),
                        s.radius);
  return text;
}

std::string set_as_urdf(std::span<const Sphere> spheres, const std::string& link, const ParticleFigures* figures) {
  SphereLists lists;
  lists.levels.emplace_back(spheres.begin(), spheres.end());
  lists.carried.resize(1);
  std::string text = to_urdf(lists, 0, link);
  if (figures == nullptr) return text;
  const MassProperties& body = figures->body;
  const Eigen::Matrix3d& i = body.inertia;
  const std::string inertial = fmt::format(
      "    <inertial>\n      <origin xyz=\"{} {} {}\" rpy=\"0 0 0\"/>\n      <mass value=\"{}\"/>\n      <inertia "
      "ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>\n    </inertial>\n",
      body.center.x(), body.center.y(), body.center.z(), body.volume, i(0, 0), i(0, 1), i(0, 2), i(1, 1), i(1, 2),
      i(2, 2));
  return text.insert(text.find("    <collision>"), inertial);
}

json error_curve_json(std::span<const SphereSetBuild> sets, double diagonal) {
  json rows = json::array();
  for (const SphereSetBuild& set : sets) {
    const CurveRow row = row_of(set, diagonal);
    rows.push_back({{"spheres", set.spheres.size()},
                    {"kept", set.kept},
                    {"protrusion_max", row.protrusion_max},
                    {"protrusion_mean", row.protrusion_mean},
                    {"gap_max", row.gap_max},
                    {"two_sided_mean", row.two_sided},
                    {"outside_volume", row.outside},
                    {"uncovered_volume", row.uncovered},
                    {"union_volume", row.volume}});
  }
  return rows;
}

std::string error_curve_csv(std::span<const SphereSetBuild> sets, double diagonal) {
  std::string text =
      "spheres,kept,protrusion_max,protrusion_mean,gap_max,two_sided_mean,outside_volume,uncovered_volume,union_"
      "volume\n";
  for (const SphereSetBuild& set : sets) {
    const CurveRow row = row_of(set, diagonal);
    text += fmt::format("{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", set.spheres.size(), int{set.kept},
                        row.protrusion_max, row.protrusion_mean, row.gap_max, row.two_sided, row.outside, row.uncovered,
                        row.volume);
  }
  return text;
}

std::vector<plot::Plot> error_curve_plots(std::span<const SphereSetBuild> sets, double diagonal,
                                          const std::string& title) {
  std::vector<plot::Plot> plots;
  const auto add = [&](const std::string& what, const std::string& unit) -> plot::Plot& {
    plot::Plot& plot = plots.emplace_back();
    plot.title = title + ": " + what;
    plot.x_label = "spheres";
    plot.y_label = unit;
    plot.log_y = true;
    return plot;
  };
  const auto line = [&](plot::Plot& plot, const char* name, double CurveRow::*value) {
    plot::Series& series = plot.series.emplace_back();
    series.name = name;
    series.kind = plot::Series::Kind::line;
    for (const SphereSetBuild& set : sets) {
      const double y = row_of(set, diagonal).*value;
      if (!(y > 0)) continue;  // a logarithm has no place for it
      series.x.push_back(static_cast<double>(set.spheres.size()));
      series.y.push_back(y);
    }
    if (series.x.empty()) plot.series.pop_back();
  };
  plot::Plot& lengths = add("how far off", "% of the diagonal");
  line(lengths, "sticks out, max", &CurveRow::protrusion_max);
  line(lengths, "sticks out, mean", &CurveRow::protrusion_mean);
  line(lengths, "gap, max", &CurveRow::gap_max);
  line(lengths, "two-sided, mean", &CurveRow::two_sided);
  plot::Plot& volumes = add("volume", "% of the solid's");
  line(volumes, "outside", &CurveRow::outside);
  line(volumes, "left out", &CurveRow::uncovered);
  return plots;
}

}  // namespace orchard::apps
