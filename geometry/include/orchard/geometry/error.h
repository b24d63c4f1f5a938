#pragma once
#include <stdexcept>
#include <string>

// The exceptions of the construction libraries.
namespace orchard {

// The base class of all exceptions that the construction libraries throw. An iteration that does not converge is
// reported in a result and does not throw.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// A file, mesh or option of the user that cannot be used. The message names the place, the fault and a remedy.
class InputError : public Error {
 public:
  using Error::Error;
};

// The exception that a stage throws if its Progress callback returned false.
class Cancelled : public Error {
 public:
  Cancelled() : Error("cancelled") {}
};

}  // namespace orchard
