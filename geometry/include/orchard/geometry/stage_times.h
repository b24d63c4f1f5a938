#pragma once
#include <chrono>
#include <string>
#include <utility>
#include <vector>

// Measures how long the stages of a run take.
namespace orchard {

// The names of the stages of a run in their order, each with its duration in seconds.
using StageTimes = std::vector<std::pair<std::string, double>>;

// Calls a function and appends its duration, in seconds, to `times`.
template <class Function>
void time_stage(StageTimes& times, const char* name, Function&& function) {
  const auto start = std::chrono::steady_clock::now();
  function();
  times.emplace_back(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

}  // namespace orchard
