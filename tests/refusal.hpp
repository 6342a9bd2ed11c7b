#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "rollfix/error.hpp"

/// What is said, on one line, to input that can't be taken.
template <class Action>
std::string refusal_of(const Action& action) {
  try {
    action();
  } catch (const rollfix::InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0) << message;
    return message;
  }
  return "nothing was thrown";
}
