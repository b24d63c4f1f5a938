#include "leaderboard/leaderboard_states.h"

#ifdef ORCHARD_HAS_VIZ
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "orchard/viz/paraview_state.h"
#endif

namespace orchard::apps {

#ifdef ORCHARD_HAS_VIZ
namespace {

constexpr std::size_t kMostViews = 16;  // more are too small to see anything
constexpr double kStateMark = 0.025;    // of the bounding radius: the balls at worst places

bool is_shown(const LeaderboardRow& row, const std::string& model) { return row.model == model && row.refused.empty(); }

Index compared_at(const std::vector<LeaderboardRow>& rows, const std::string& model) {
  std::map<Index, int> systems;
  for (const LeaderboardRow& row : rows) systems[row.asked] += is_shown(row, model) ? 1 : 0;
  return std::max_element(
             systems.begin(), systems.end(),
             [](const auto& a, const auto& b) { return std::pair(a.second, a.first) < std::pair(b.second, b.first); })
      ->first;
}

double largest_value(const LeaderboardRow& row) {
  double largest = 0;
  for (const nlohmann::json& place : row.worst) largest = std::max(largest, place.value("value", 0.0));
  return largest;
}

class ModelScene {
 public:
  ModelScene(const std::vector<LeaderboardRow>& rows, const std::string& model, const std::filesystem::path& folder)
      : asked_(compared_at(rows, model)) {
    for (const LeaderboardRow& row : rows) {
      if (is_shown(row, model)) add(row, folder);
    }
    scene_.ranges = {{"value", {0, largest_}, "error, %"}};
  }
  const StateScene& scene() const { return scene_; }

 private:
  void look_at(const std::filesystem::path& ball) {
    std::ifstream in(ball);
    const std::vector<double> numbers = nlohmann::json::parse(in);
    scene_.center = Point(numbers.at(0), numbers.at(1), numbers.at(2));
    scene_.radius = numbers.at(3);
  }

  void add(const LeaderboardRow& row, const std::filesystem::path& folder) {
    const WorstFiles files = worst_files(row);
    if (scene_.layers.empty()) {
      look_at(folder / files.ball);
      scene_.layers.push_back({.name = "mesh", .file = files.mesh, .opacity = 0.12});
    }
    const std::string name = fmt::format("{} at {}", row.system, row.asked);
    const bool balls_alone = row.edges == 0 && row.triangles == 0;
    scene_.layers.push_back({.name = name + ": axis",
                             .file = files.axis,
                             .look = balls_alone ? StateLayer::Look::spheres : StateLayer::Look::surface,
                             .width = 2,
                             .color = {0.72, 0.78, 0.84}});
    scene_.layers.push_back({.name = name + ": worst places",
                             .file = files.places,
                             .look = StateLayer::Look::spheres,
                             .array = "value",
                             .sphere_radius = kStateMark * scene_.radius});
    if (row.asked != asked_ || scene_.views.size() == kMostViews) return;
    largest_ = std::max(largest_, largest_value(row));
    const std::size_t last = scene_.layers.size();
    scene_.views.push_back(
        {.title = fmt::format("{}, {} balls: {:.3g} % at most", row.system, row.balls, row.value("hausdorff_max")),
         .layers = {0, last - 2, last - 1}});
  }

  Index asked_;
  double largest_ = 0;
  StateScene scene_;
};

}  // namespace

bool write_worst_state(const std::filesystem::path& pvsm, const std::vector<LeaderboardRow>& rows,
                       const std::string& model, const std::filesystem::path& folder) {
  if (std::none_of(rows.begin(), rows.end(), [&](const LeaderboardRow& row) { return is_shown(row, model); }))
    return false;
  write_paraview_state(pvsm, ModelScene(rows, model, folder).scene(), folder);
  return true;
}
#else
bool write_worst_state(const std::filesystem::path&, const std::vector<LeaderboardRow>&, const std::string&,
                       const std::filesystem::path&) {
  return false;
}
#endif

}  // namespace orchard::apps
