#pragma once

// How long the builders of sphere-trees and sphere sets search.
namespace orchard {

// The length of a search. What a builder does at each effort, and how the times compare, is told where it takes one:
// TightenOptions, annealing_options(), SphereSetOptions.
enum class Effort { low, standard, high };

}  // namespace orchard
