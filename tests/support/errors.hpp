// SPDX-License-Identifier: BSD-3-Clause
//
// Expectations on errors.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "tegl/error.hpp"

namespace tegl::test {

/// Expects `work` to throw a tegl::Error with this code and a message that contains `part`.
template <class Work>
void expect_error(ErrorCode code, const std::string& part, const Work& work) {
  try {
    work();
    ADD_FAILURE() << "no error; expected " << name_of(code) << " with '" << part << "'";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

}  // namespace tegl::test
