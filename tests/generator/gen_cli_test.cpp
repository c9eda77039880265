// SPDX-License-Identifier: BSD-3-Clause
//
// The program `gen` as its users meet it: run as a process, judged by exit status, output and messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace {

using nlohmann::json;
using testing::HasSubstr;

struct Outcome {
  int status = -1;
  std::string out;
  std::string err;
};

/// Runs gen with these arguments; `redirect` is appended to the shell command as it is.
Outcome gen(std::initializer_list<std::string_view> arguments, const std::string& redirect = "") {
  const std::string messages =
      testing::TempDir() + "gen_" + testing::UnitTest::GetInstance()->current_test_info()->name() + ".txt";
  std::string command = "'" TEGL_GEN_PROGRAM "'";
  for (const std::string_view argument : arguments) {
    command.append(" '").append(argument).append("'");
  }
  command.append(" 2>'").append(messages).append("' ").append(redirect);
  Outcome run;
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) {
    ADD_FAILURE() << "cannot run " << command;
    return run;
  }
  std::array<char, 4096> buffer{};
  for (std::size_t got = 0; (got = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
    run.out.append(buffer.data(), got);
  }
  const int result = pclose(pipe);
  run.status = WIFEXITED(result) ? WEXITSTATUS(result) : -1;
  std::ifstream file(messages);
  run.err.assign(std::istreambuf_iterator<char>(file), {});
  (void)std::remove(messages.c_str());
  return run;
}

/// A refused command line: status 2, nothing on standard output, and a message that has all these texts.
void expect_refused(std::initializer_list<std::string_view> arguments, std::initializer_list<const char*> texts) {
  const Outcome run = gen(arguments);
  EXPECT_EQ(run.status, 2) << run.err;
  EXPECT_EQ(run.out, "");
  for (const char* const text : texts) {
    EXPECT_THAT(run.err, HasSubstr(text));
  }
}

TEST(GenCli, CountsTheClassesOfEveryGroupAsJson) {
  struct Expected {
    const char* dim;
    const char* group;
    bool inversion;
    int order;
    int orbits;
  };
  for (const Expected& expected : {Expected{"2", "full", false, 8, 6}, Expected{"2", "rotations", false, 4, 6},
                                   Expected{"3", "full", false, 48, 22}, Expected{"3", "rotations", false, 24, 23},
                                   Expected{"3", "rotations", true, 48, 15}, Expected{"3", "full", true, 96, 14},
                                   Expected{"4", "full", false, 384, 402}, Expected{"4", "rotations", true, 384, 272},
                                   Expected{"5", "full", false, 3840, 1228158}}) {
    const Outcome run =
        expected.inversion ? gen({"--dim", expected.dim, "--count", "--group", expected.group, "--inversion", "--json"})
                           : gen({"--dim", expected.dim, "--count", "--group", expected.group, "--json"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(json::parse(run.out), (json{{"dim", std::stoi(expected.dim)},
                                          {"group", expected.group},
                                          {"inversion", expected.inversion},
                                          {"order", expected.order},
                                          {"orbits", expected.orbits}}));
  }
}

TEST(GenCli, CountIsExactBeyondWhatAFloatingPointNumberHolds) {
  const Outcome run = gen({"--dim", "8", "--count", "--json"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out,
              HasSubstr("\"orbits\": 11218076601767519586965281984173341005925142853855481024470471657123840}"));
  EXPECT_TRUE(json::parse(run.out).at("orbits").is_number());
}

TEST(GenCli, CountForPeopleSaysHowItWasCounted) {
  const Outcome enumerated = gen({"--count", "--dim=3"});
  EXPECT_EQ(enumerated.status, 0) << enumerated.err;
  EXPECT_THAT(enumerated.out, testing::AllOf(HasSubstr("22"), HasSubstr("order 48"), HasSubstr("by enumeration")));
  const Outcome burnside = gen({"--count", "--dim=6"});
  EXPECT_EQ(burnside.status, 0) << burnside.err;
  EXPECT_THAT(burnside.out, testing::AllOf(HasSubstr("400507806843728"), testing::Not(HasSubstr("enumeration"))));
}

TEST(GenCli, OptionsMayComeInAnyOrderAndWithEqualsSigns) {
  EXPECT_EQ(gen({"--json", "--group=rotations", "--dim=3", "--inversion", "--count"}).out,
            gen({"--dim", "3", "--count", "--group", "rotations", "--inversion", "--json"}).out);
}

TEST(GenCli, HelpListsCommandsExamplesAndExitCodesAndWinsOverTheRest) {
  const Outcome run = gen({"--help"});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.err, "");
  for (const char* const text : {"--count", "--classes", "--certify", "--out DIR", "--group full|rotations", "examples",
                                 "exit status", "--layout class|flat|auto"}) {
    EXPECT_THAT(run.out, HasSubstr(text));
  }
  EXPECT_EQ(gen({"-h"}).out, run.out);
  EXPECT_EQ(gen({"--dim", "3", "--count", "--help"}).out, run.out);
}

TEST(GenCli, VersionNamesProgramAndContract) {
  const Outcome run = gen({"--version"});
  EXPECT_EQ(run.status, 0);
  EXPECT_THAT(run.out, testing::MatchesRegex("gen [0-9]+\\.[0-9]+\\.[0-9]+ \\(table contract [0-9]+\\)\n"));
}

TEST(GenCli, RefusesNoCommandAndSeveral) {
  expect_refused({}, {"no command", "--count", "--help"});
  expect_refused({"--dim", "3"}, {"no command"});
  expect_refused({"--dim", "3", "--count", "--classes"}, {"--count and --classes", "expected one command"});
  expect_refused({"--dim", "3", "--count", "--out", "tables"}, {"--count and --out"});
}

TEST(GenCli, RefusesWhatItDoesNotKnow) {
  expect_refused({"--dim", "3", "--count", "--colour"}, {"unknown option '--colour'", "--inversion"});
  expect_refused({"--dim", "3", "--count", "tables"}, {"unknown option 'tables'"});
  expect_refused({"--dim", "3", "--count", ""}, {"unknown option ''"});
}

TEST(GenCli, RefusesMissingAndInvalidValues) {
  expect_refused({"--count"}, {"--count without --dim"});
  expect_refused({"--count", "--dim"}, {"--dim has no value"});
  expect_refused({"--dim", "--count"}, {"--dim has no value"});
  expect_refused({"--count", "--dim="}, {"--dim has no value"});
  expect_refused({"--count", "--dim", "three"}, {"--dim three", "whole number"});
  expect_refused({"--count", "--dim", "3x"}, {"--dim 3x", "whole number"});
  expect_refused({"--count", "--dim", "99999999999"}, {"--dim 99999999999", "whole number"});
  expect_refused({"--count", "--dim", "3", "--group", "half"}, {"--group half", "full or rotations"});
  expect_refused({"--classes", "--dim", "3", "--alternative", "middle"}, {"--alternative middle", "low or high"});
  expect_refused({"--dim", "3", "--out"}, {"--out has no value"});
  expect_refused({"--dim", "3", "--out", "t", "--layout", "tree"}, {"--layout tree", "class or flat or auto"});
  expect_refused({"--dim", "3", "--out", "t", "--triangulation", "fan"},
                 {"--triangulation fan", "barycentric or compact or all"});
  expect_refused({"--dim", "3", "--count", "--json=yes"}, {"--json takes no value", "'yes'"});
}

TEST(GenCli, RefusesDimensionsOutsideOfTheCommandsRange) {
  for (const char* const dim : {"-1", "0", "9"}) {
    expect_refused({"--dim", dim, "--count"}, {"--count expects 1 to 8"});
  }
  for (const char* const dim : {"1", "5"}) {
    expect_refused({"--dim", dim, "--classes"}, {"--classes expects 2 to 4"});
    expect_refused({"--dim", dim, "--certify"}, {"--certify expects 2 to 4"});
    expect_refused({"--dim", dim, "--out", "tables"}, {"--out expects 2 to 4"});
  }
}

TEST(GenCli, RefusesOptionsThatTheCommandWouldIgnore) {
  expect_refused({"--dim", "3", "--classes", "--inversion"}, {"--inversion does not go with --classes", "--json"});
  expect_refused({"--dim", "3", "--certify", "--group", "full"}, {"--group does not go with --certify"});
  expect_refused({"--dim", "3", "--count", "--layout", "flat"}, {"--layout does not go with --count"});
  expect_refused({"--dim", "3", "--out", "tables", "--json"}, {"--json does not go with --out"});
  expect_refused({"--version", "--dim", "3"}, {"--dim does not go with --version", "nothing else"});
}

TEST(GenCli, RefusesRepeatedOptions) {
  expect_refused({"--dim", "3", "--dim", "4", "--count"}, {"--dim was given more than once"});
  expect_refused({"--dim", "3", "--count", "--count"}, {"--count was given more than once"});
}

TEST(GenCli, FailsWhenItsOutputCannotBeWritten) {
  if (!std::ifstream("/dev/full")) {
    GTEST_SKIP() << "no /dev/full on this system";
  }
  const Outcome run = gen({"--dim", "3", "--count"}, ">/dev/full");
  EXPECT_EQ(run.status, 5);
  EXPECT_THAT(run.err, HasSubstr("standard output"));
}

}  // namespace
