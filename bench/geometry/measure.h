#pragma once
#include <algorithm>
#include <chrono>
#include <vector>

namespace orchard {

template <class Answer>
struct Measured {
  double thousand_per_second = 0;  // the best of three rounds
  std::vector<Answer> answers;
};

// Asks every query, three times over.
template <class Answer, class Query, class Ask>
Measured<Answer> measure(const std::vector<Query>& queries, const Ask& ask) {
  Measured<Answer> result{0, std::vector<Answer>(queries.size())};
  for (int repeat = 0; repeat < 3; ++repeat) {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < queries.size(); ++i) result.answers[i] = ask(queries[i]);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    result.thousand_per_second =
        std::max(result.thousand_per_second, 1e-3 * static_cast<double>(queries.size()) / time.count());
  }
  return result;
}

}  // namespace orchard
