// SPDX-License-Identifier: BSD-3-Clause
//
// --lattice, and files that record the lattice of their samples.
#include <gmock/gmock.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::HasSubstr;

class LatticeCommand : public ProgramTest {
 protected:
  static nlohmann::json run_json(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 0) << run.err;
    return run.json();
  }
};

TEST_F(LatticeCommand, FilesThatDoNotRecordTheLatticeAreRemarked) {
  const RunResult run = run_tegl({"sample", "ball", "--lattice", "fcc", "--size", "6", "-o", path("ball.vti")});
  EXPECT_EQ(run.exit, 0);
  EXPECT_THAT(run.err, HasSubstr("does not record the lattice; contour it with --lattice fcc"));
  EXPECT_EQ(run_tegl({"sample", "ball", "--lattice", "fcc", "--size", "6", "-o", path("ball.nrrd")}).err, "");
  EXPECT_THAT(run_tegl({"info", path("ball.nrrd")}).out, HasSubstr("edges along the axes"));
}

TEST_F(LatticeCommand, LatticeCubicReadsFilesWhoseAxesCannotHaveTheirLattice) {
  const std::string moving = path("moving.nc"), flat = path("flat.nrrd"), output = path("cut.ply");
  (void)run_json({"sample", "ball", "--lattice", "fcc_in_time", "--size", "9", "-o", moving});
  const auto cubic_only = [&](std::vector<std::string> arguments, const std::string& message) {
    const RunResult run = run_tegl(arguments);
    EXPECT_NE(run.exit, 0);
    EXPECT_THAT(run.err, HasSubstr(message));
    arguments.insert(arguments.end(), {"--lattice", "cubic"});
    return run_json(arguments);
  };
  const std::string one_index = "one index of a dimension of samples on the lattice fcc_in_time";
  EXPECT_EQ(cubic_only({"info", moving, "--fix", "z=4"}, one_index)["lattice"], "cubic");
  EXPECT_GT(cubic_only({"contour", moving, "--fix", "z=4", "--iso", "0", "-o", output}, one_index)["vertices"], 0);
  EXPECT_GT(cubic_only({"measure", moving, "--fix", "z=4", "--iso", "0"}, one_index)["size"], 0);
  // a flat file, whose lattice has more axes
  std::ofstream(flat) << "NRRD0005\ntype: uchar\ndimension: 2\nsizes: 3 3\nencoding: ascii\n"
                         "sample_lattice:=fcc\n\n0 0 0 0 9 0 0 0 0\n";
  const std::string axes = "has the lattice fcc, and is read as an image of 2 axes; expected 3";
  EXPECT_EQ(cubic_only({"info", flat}, axes)["lattice"], "cubic");
  EXPECT_EQ(cubic_only({"contour", flat, "--iso", "5", "-o", path("flat.vtkhdf")}, axes)["vertices"], 4);
  EXPECT_THAT(run_tegl({"info", path("flat.vtkhdf"), "--lattice", "cubic"}).err,
              HasSubstr("which is a contour; expected it with an image"));
}

TEST_F(LatticeCommand, TheLatticeIsAPropertyOfTheImage) {
  const auto json_of = [&](std::vector<std::string> arguments) { return run_json(std::move(arguments)); };
  const std::string output = path("ball.ply");
  for (const char* const name : {"ball.nrrd", "ball.nc"}) {
    const std::string ball = path(name);
    (void)json_of({"sample", "ball", "--lattice", "fcc", "--size", "14", "-o", ball});
    EXPECT_EQ(json_of({"info", ball})["lattice"], "fcc");
    EXPECT_THAT(run_tegl({"info", ball}).out, HasSubstr("fcc: odd layers are shifted"));
    const nlohmann::json own = json_of({"contour", ball, "--iso", "0", "-o", output});
    EXPECT_EQ(own["tiles"], json_of({"contour", ball, "--iso", "0", "--lattice", "fcc", "-o", output})["tiles"]);
    const nlohmann::json cubic = json_of({"contour", ball, "--iso", "0", "--lattice", "cubic", "-o", output});
    EXPECT_NE(own["tiles"], cubic["tiles"]);
    EXPECT_NE(own["tiles"], json_of({"contour", ball, "--iso", "0", "--lattice", "bcc", "-o", output})["tiles"]);
    // others that contour an image
    EXPECT_EQ(json_of({"measure", ball, "--iso", "0"})["content"],
              json_of({"measure", ball, "--iso", "0", "--lattice", "fcc"})["content"]);
    EXPECT_NE(json_of({"measure", ball, "--iso", "0"})["content"],
              json_of({"measure", ball, "--iso", "0", "--lattice", "cubic"})["content"]);
    const nlohmann::json slice = json_of({"slice", ball, "--iso", "0", "--at", "z=0.05", "-o", output});
    EXPECT_EQ(slice["simplices"],
              json_of({"slice", ball, "--iso", "0", "--lattice", "fcc", "--at", "z=0.05", "-o", output})["simplices"]);
    // and those that do not know lattices
    const auto refused = [&](std::vector<std::string> arguments, const std::string& message) {
      const RunResult run = run_tegl(arguments);
      EXPECT_NE(run.exit, 0);
      EXPECT_THAT(run.err, HasSubstr(message));
    };
    refused({"filter", ball, "--median", "1", "-o", path("f.nrrd")}, "is on the lattice fcc, which this command");
    refused({"index", ball, "-o", path("i.tindex")}, "is on the lattice fcc, which this command");
    refused({"scale-space", ball, "--sigmas", "1:2:3", "-o", path("s.nrrd")}, "lattice fcc");
    refused({"elements", ball, "--iso", "0", "--per", "cell", "-o", path("e.txt")}, "--per cell on the lattice fcc");
    for (const std::vector<std::string>& more :
         std::vector<std::vector<std::string>>{{"--division", "kuhn", "-o", output},
                                               {"--samples-are", "cells", "-o", output},
                                               {"--positions", "gravitation", "-o", output},
                                               {"--scale-space", "1:2:3", "-o", path("s.vtkhdf")}}) {
      std::vector<std::string> arguments = {"contour", ball, "--iso", "0"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      refused(arguments, "is on the lattice fcc; expected it without this, or --lattice cubic");
    }
    const auto facets = [&](const std::vector<std::string>& more) {
      std::vector<std::string> arguments = {"contour", ball, "--iso", "0", "--facets", "-o", path("s.vtkhdf")};
      arguments.insert(arguments.end(), more.begin(), more.end());
      return run_json(arguments)["tiles"];
    };
    EXPECT_EQ(json_of({"contour", ball, "--iso", "0", "--pick", "0,0,0", "-o", output})["pick"]["components"], 1);
    EXPECT_NE(facets({}), facets({"--lattice", "cubic"}));
    EXPECT_EQ(facets({}), facets({"--lattice", "fcc"}));
    EXPECT_LT(facets({}), facets({"--periodic", "x,y"}));
  }
}

}  // namespace
}  // namespace tegl::test
