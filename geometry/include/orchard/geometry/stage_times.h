#pragma once
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace orchard {

// The stages of a run in their order, each with the seconds that it took.
using StageTimes = std::vector<std::pair<std::string, double>>;

// Calls the function, and notes how long that took.
template <class Function>
void time_stage(StageTimes& times, const char* name, Function&& function) {
  const auto start = std::chrono::steady_clock::now();
  function();
  times.emplace_back(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

}  // namespace orchard
