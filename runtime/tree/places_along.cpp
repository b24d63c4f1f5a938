#include "tree/places_along.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace orchard::runtime::detail {
namespace {

constexpr std::size_t kFew = 64;      // so many are sorted as they are
constexpr std::size_t kPerShare = 4;  // places in each share, on average

bool before(const PlaceAlong& a, const PlaceAlong& b) { return a.at < b.at || (!(b.at < a.at) && a.number < b.number); }

}  // namespace

void sort_along(std::vector<PlaceAlong>& places, std::vector<PlaceAlong>& other) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const PlaceAlong& place : places) low = std::min(low, place.at), high = std::max(high, place.at);
  const std::size_t shares = places.size() / kPerShare;
  const double to_share = static_cast<double>(shares) / (high - low);
  // Not so where all are in one place, or so near to each other or so far that the quotient says nothing.
  if (places.size() <= kFew || !(to_share > 0 && to_share < std::numeric_limits<double>::max())) {
    std::sort(places.begin(), places.end(), before);
    return;
  }
  // Differences, products and whole numbers rise with the place, rounding included: no share begins before another
  // ends.
  const auto share_of = [&](const PlaceAlong& place) {
    return std::min(static_cast<std::size_t>((place.at - low) * to_share), shares - 1);
  };
  std::vector<std::uint32_t> ends(shares + 1, 0);
  for (const PlaceAlong& place : places) ++ends[share_of(place) + 1];
  for (std::size_t share = 0; share < shares; ++share) ends[share + 1] += ends[share];
  other.resize(places.size());
  for (const PlaceAlong& place : places) other[ends[share_of(place)]++] = place;
  std::uint32_t begin = 0;
  for (std::size_t share = 0; share < shares; ++share) {
    std::sort(other.begin() + begin, other.begin() + ends[share], before);
    begin = ends[share];
  }
  places.swap(other);
}

}  // namespace orchard::runtime::detail
