#pragma once
#include <stdexcept>
#include <string>

namespace orchard {

// Root of everything orchard's construction throws. Not converging is a report, not an error.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A file, mesh or option of the user's that cannot be used. The message names the place, the fault and a remedy.
class InputError : public Error {
 public:
  using Error::Error;
};

// A Progress callback returned false.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace orchard
