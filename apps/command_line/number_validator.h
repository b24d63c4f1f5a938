#pragma once
#include <CLI/CLI.hpp>

#include <cmath>
#include <string>

namespace orchard::apps {

// A range of doubles that refuses NaN. CLI's own ranges accept it, because it is neither below nor above them.
class NumberValidator : public CLI::Validator {
 public:
  explicit NumberValidator(const CLI::Validator& range) : Validator(range) {
    func_ = [range](std::string& input) {
      double value = 0;
      const bool number = CLI::detail::lexical_cast(input, value) && !std::isnan(value);
      return number ? range(input) : "Value " + input + " is not a number";
    };
  }
};

}  // namespace orchard::apps
