#pragma once
#include <CLI/CLI.hpp>

#include <cmath>
#include <string>

namespace orchard::apps {

// A range of doubles without what is not a number: that passes every range of CLI's, for it is neither below nor above.
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
