#pragma once
#include <gtest/gtest.h>

#include <string>

#include "orchard/geometry/error.h"

namespace orchard::test {

// `action` must throw InputError whose message is one line and has every part in it.
template <typename Action>
void expect_input_error(const Action& action, std::initializer_list<std::string> parts) {
  try {
    action();
    ADD_FAILURE() << "accepted, instead of: " << *parts.begin();
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& part : parts)
      EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
  }
}

}  // namespace orchard::test
