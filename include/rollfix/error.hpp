#pragma once

#include "rollfix/cpp20.hpp"  // IWYU pragma: keep

#include <stdexcept>
#include <string>

namespace rollfix {

/// Base of everything that rollfix throws. The message is one line and names what was expected,
/// what was found, and the cure.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What the user gave can't be worked with: a file, a number, a shape. Exit code 2 on the command line.
/// A field of an options struct is named in backticks: `allow_crossing`.
class InputError : public Error {
 public:
  using Error::Error;
};

/// A computation broke a promise of its own. Exit code 4 on the command line.
class InternalError : public Error {
 public:
  using Error::Error;
};

}  // namespace rollfix
