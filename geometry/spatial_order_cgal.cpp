#include <CGAL/Simple_cartesian.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/property_map.h>

#include <numeric>

#include "orchard/geometry/spatial_order.h"

namespace orchard {

std::vector<std::size_t> spatial_order(std::span<const Point> points) {
  using Kernel = CGAL::Simple_cartesian<double>;
  std::vector<Kernel::Point_3> places;
  places.reserve(points.size());
  for (const Point& point : points) places.emplace_back(point.x(), point.y(), point.z());
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  using PointOf = CGAL::Pointer_property_map<Kernel::Point_3>::type;
  CGAL::hilbert_sort(order.begin(), order.end(),
                     CGAL::Spatial_sort_traits_adapter_3<Kernel, PointOf>(CGAL::make_property_map(places)));
  return order;
}

}  // namespace orchard
