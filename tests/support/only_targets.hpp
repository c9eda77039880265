// SPDX-License-Identifier: BSD-3-Clause
//
// Restricts the library to some instruction sets, for tests that compare them. The test must link hwy::hwy.
#pragma once

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cstdint>

namespace tegl::test {

/// During its lifetime, the library uses the best of the given instruction sets.
class OnlyTargets {
 public:
  explicit OnlyTargets(std::int64_t targets) { choose(targets); }
  ~OnlyTargets() { choose(0); }
  OnlyTargets(const OnlyTargets&) = delete;
  OnlyTargets& operator=(const OnlyTargets&) = delete;

 private:
  static void choose(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);  // 0: all again
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

/// Calls test() with each instruction set, the best one first. For a set that the library disables, as SSSE3, the test
/// runs with the best one below it.
template <class Test>
void with_all_targets(const Test& test) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(testing::Message() << "at most " << hwy::TargetName(target));
    const OnlyTargets only(target);
    test();
  }
}

}  // namespace tegl::test
