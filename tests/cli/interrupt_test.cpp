// SPDX-License-Identifier: BSD-3-Clause
//
// Ctrl-C while several outputs are written: no output appears, existing files stay, and no temporary file is left. The
// signal arrives at a defined call of the program (interrupt_at.cpp), not after some time.
#include <gmock/gmock.h>

#include <chrono>
#include <fstream>
#include <iterator>

#include "sample_files.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

class Interrupt : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer's library has to be loaded first";
#endif
    if (!has_terminals()) GTEST_SKIP() << "no pseudo-terminals here";
    const Samples samples = ball({12, 12, 12}, 4);
    ball_ = write("ball.nrrd", nrrd_bytes(samples));
    for (std::size_t k = 0; k < 12; ++k) {
      const auto begin = samples.values.begin() + static_cast<std::ptrdiff_t>(144 * k);
      frames_.push_back(
          write("frame_" + std::to_string(10 + k) + ".nrrd", nrrd_bytes({{12, 12}, {begin, begin + 144}})));
    }
  }

  /// Runs `tegl contour` at three isovalues with SIGINT at the last of these events.
  [[nodiscard]] static RunResult interrupted(const std::string& events, const std::vector<std::string>& files,
                                             const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"contour", "--iso", "0,1,2"};
    arguments.insert(arguments.end(), files.begin(), files.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tegl_on_terminal(arguments, {"LD_PRELOAD=" TEGL_INTERRUPT_AT_LIBRARY, "TEGL_INTERRUPT_AT=" + events});
  }

  /// Also expects all files to be unchanged, both with and without existing files at `outputs`.
  void expect_untouched(const std::string& events, const std::vector<std::string>& inputs,
                        const std::vector<std::string>& more, const std::vector<std::string>& outputs) {
    for (const bool there : {false, true}) {
      if (there)
        for (const std::string& output : outputs) write(output, "what was there before");
      const auto before = files();
      const RunResult run = interrupted(events, inputs, more);
      EXPECT_EQ(run.exit, 130) << run.out;
      EXPECT_THAT(run.out, HasSubstr("cancelled"));
      EXPECT_EQ(files(), before);
      for (const std::string& output : outputs) {
        EXPECT_EQ(text_of(output), there ? "what was there before" : "") << output;
        std::filesystem::remove(path(output));
      }
    }
    // Without the signal the same command succeeds.
    const RunResult run = interrupted("no such file", inputs, more);
    EXPECT_EQ(run.exit, 0) << run.out;
    for (const std::string& output : outputs) {
      EXPECT_GT(text_of(output).size(), 100U) << output;
      std::filesystem::remove(path(output));
    }
  }

  [[nodiscard]] std::string text_of(const std::string& name) const {
    std::ifstream in(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  std::string ball_;
  std::vector<std::string> frames_;
};

TEST_F(Interrupt, WhileTheSecondOfSeveralContoursIsWrittenLeavesAllAsItWas) {
  for (const std::string extension : {".ply", ".glb", ".vtkhdf"})
    expect_untouched("out_0" + extension + "|out_1" + extension, {ball_}, {"-o", path("out" + extension)},
                     {"out_0" + extension, "out_1" + extension, "out_2" + extension});
  expect_untouched("out_0.vtu|out_1.vtu", {ball_}, {"--facets", "-o", path("out.vtu")},
                   {"out_0.vtu", "out_1.vtu", "out_2.vtu"});
}

TEST_F(Interrupt, WhileTheSecondOfSeveralContoursForOneFileIsMadeLeavesAllAsItWas) {
  expect_untouched("contour |contour ", {ball_}, {"--one-file", "-o", path("out.vtkhdf")}, {"out.vtkhdf"});
}

// All three files are open, and five of twelve layers are written.
TEST_F(Interrupt, InTheMidstOfAStreamLeavesAllAsItWas) {
  expect_untouched("out_2.vtkhdf|frame_15", frames_, {"--stream", "-o", path("out.vtkhdf")},
                   {"out_0.vtkhdf", "out_1.vtkhdf", "out_2.vtkhdf"});
}

// A stage that reports no progress, as in other libraries, does not prevent the program from ending.
TEST_F(Interrupt, InAStageWithoutProgressEndsTheProgramAtOnce) {
  for (const std::string extension : {".ply", ".vtkhdf"}) {
    const auto before = files();
    const auto start = std::chrono::steady_clock::now();
    const RunResult run = run_tegl_on_terminal({"contour", ball_, "--iso", "0,1,2", "-o", path("out" + extension)},
                                               {"LD_PRELOAD=" TEGL_INTERRUPT_AT_LIBRARY, "TEGL_STALL=300",
                                                "TEGL_INTERRUPT_AT=out_0" + extension + "|out_1" + extension});
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(280));
    EXPECT_EQ(run.exit, 128 + SIGINT) << run.out;
    EXPECT_THAT(run.out, HasSubstr("cancelled"));
    EXPECT_EQ(files(), before) << "pending outputs are removed";
  }
}

TEST_F(Interrupt, ByASecondSignalEndsTheProgramAtOnceAndLeavesNothing) {
  const auto before = files();
  const RunResult run = run_tegl_on_terminal(
      {"contour", ball_, "--iso", "0,1,2", "-o", path("out.ply")},
      {"LD_PRELOAD=" TEGL_INTERRUPT_AT_LIBRARY, "TEGL_SIGNALS=2", "TEGL_INTERRUPT_AT=out_0.ply|out_1.ply"});
  EXPECT_EQ(run.exit, 128 + SIGINT) << run.out;
  EXPECT_EQ(files(), before);
}

}  // namespace
}  // namespace tegl::test
