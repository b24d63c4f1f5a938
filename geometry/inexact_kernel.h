#pragma once
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

namespace orchard::detail {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;

}  // namespace orchard::detail
