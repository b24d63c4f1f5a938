#include <algorithm>
#include <tuple>

#include "quality_parts.h"

namespace orchard::detail {

std::vector<WorstPlace> worst_of(std::vector<WorstPlace> places, Index count, double apart) {
  // Among equal values the position decides, so that the order of the input does not matter.
  std::sort(places.begin(), places.end(), [](const WorstPlace& a, const WorstPlace& b) {
    const auto key = [](const WorstPlace& place) {
      return std::tuple(-place.value, place.position.x(), place.position.y(), place.position.z());
    };
    return key(a) < key(b);
  });
  std::vector<WorstPlace> chosen;
  for (const WorstPlace& place : places) {
    if (chosen.size() == count) break;
    const bool new_one = std::none_of(chosen.begin(), chosen.end(), [&](const WorstPlace& other) {
      return (other.position - place.position).norm() < apart;
    });
    if (new_one) chosen.push_back(place);
  }
  return chosen;
}

}  // namespace orchard::detail
