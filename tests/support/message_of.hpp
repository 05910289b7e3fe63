#pragma once

#include <gtest/gtest.h>

#include <string>

#include "geo/core/error.hpp"

namespace geo::test {

/// What the error says that an action ends with: one of that kind, in one line.
template <class Action>
std::string message_of(ErrorKind kind, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "one line";
    return error.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

}  // namespace geo::test
