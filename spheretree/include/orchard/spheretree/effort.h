#pragma once

// How long the builders of sphere-trees and sphere sets search.
namespace orchard {

// The length of a search. TightenOptions, annealing_options() and SphereSetOptions describe what each builder does at
// each effort, and how the times compare.
enum class Effort { low, standard, high };

}  // namespace orchard
