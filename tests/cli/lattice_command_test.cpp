// SPDX-License-Identifier: BSD-3-Clause
//
// --lattice, and files that record the lattice of their samples.
#include <gmock/gmock.h>

#include <cmath>
#include <cstddef>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "sample_files.hpp"
#include "tegl/io.hpp"
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

TEST_F(LatticeCommand, LatticesAreClosedPeriodicAndSampledAlongTheirEdges) {
  const std::string file = path("gyroid.nrrd"), output = path("gyroid.vtkhdf");
  const auto sample = [&](const char* lattice, const char* sizes, const char* field, const std::string& to) {
    (void)run_json({"sample", field, "--lattice", lattice, "--size", sizes, "--range", "0:1", "-o", to});
  };
  const auto contour = [&](std::vector<std::string> more) {
    std::vector<std::string> all = {"contour", file, "-o", output};
    all.insert(all.end(), more.begin(), more.end());
    return run_json(all);
  };
  // a wave along x; the file says that it is on the lattice
  sample("fcc", "13,12,14", "sin(6.5*x)+0.01*y", file);
  const nlohmann::json open = contour({"--iso", "0.2"});
  EXPECT_GT(open["boundary_simplices"], 0);
  const nlohmann::json closed = contour({"--iso", "0.2", "--close"});
  EXPECT_EQ(closed["boundary_simplices"], 0);
  EXPECT_GT(closed["simplices"], open["simplices"]);
  const nlohmann::json around = contour({"--iso", "0.2", "--close", "--periodic", "x,y", "--normals"});
  EXPECT_EQ(around["boundary_simplices"], 0);
  EXPECT_EQ(run_json({"contour", file, "--iso", "0.2", "-o", output, "--periodic", "all"})["boundary_simplices"], 0);
  // attributes: the image itself, and another one on the same lattice
  sample("fcc", "13,12,14", "3*sin(6.5*x)+0.03*y+1", path("other.nrrd"));
  for (const char* const more : {"--close", "--merge", "--periodic=x"}) {
    const std::string with = path("with.vtkhdf");
    (void)run_json({"contour", file, "--iso", "0.2", "-o", with, "--attribute", path("other.nrrd"), more});
    const Mesh mesh = read_mesh(with);
    ASSERT_EQ(mesh.vertex_attributes.size(), 1u);
    EXPECT_EQ(mesh.vertex_attributes[0].name, "other");
    std::size_t at_level = 0;
    for (const double value : mesh.vertex_attributes[0].values) at_level += std::abs(value - 1.6) < 1e-5 ? 1 : 0;
    EXPECT_GE(at_level, open["vertices"].get<std::size_t>() / 2) << more;
  }
  // --pick on the lattice that the file names
  const nlohmann::json picked = contour({"--iso", "0.2", "--periodic", "x,y", "--pick", "1.3,0.5,0.5"});
  EXPECT_EQ(picked["components"], 1);
  // the period is 13/12: from x = 0.217 to the sheet at 0.031, in steps of 1/12
  EXPECT_NEAR(picked["pick"]["distance"].get<double>(), 12 * (1.3 - 13.0 / 12 - std::asin(0.2) / 6.5), 0.05);
  sample("fcc", "13,12,12", "x", path("shorter.nrrd"));
  const auto refused = [&](std::vector<std::string> arguments, const char* message) {
    const RunResult run = run_tegl(arguments);
    EXPECT_NE(run.exit, 0);
    EXPECT_THAT(run.err, HasSubstr(message));
  };
  const std::string ply = path("a.ply");
  refused({"contour", file, "--iso", "0.2", "-o", ply, "--periodic", "x", "--lattice", "cubic", "--pick", "0,0,0"},
          "--periodic x with --pick");
  refused({"contour", file, "--iso", "0.2", "-o", ply, "--attribute", path("shorter.nrrd")},
          "expected the same lattice, numbers of samples and coordinates");
  (void)run_json({"sample", "ball", "--size", "6", "-o", path("ball.nrrd")});
  refused({"contour", path("ball.nrrd"), "--iso", "0", "-o", ply, "--attribute", file},
          "an image on the lattice fcc, and the contour");
  refused({"slice", file, "--iso", "0.2", "--at", "z=0.5", "-o", ply, "--attribute", file},
          "--attribute on the lattice");
  sample("bcc", "6,6,7", "x", path("odd.nrrd"));
  refused({"contour", path("odd.nrrd"), "--iso", "0.2", "-o", ply, "--periodic", "z"},
          "has 7 layers; expected an even");
}

/// Two layers of d4 are no cells.
TEST_F(LatticeCommand, TooFewLayersAreErrors) {
  const std::string flat =
      write("flat.nrrd", nrrd_bytes(sample({4, 4, 4, 2}, [](const auto& x) { return static_cast<double>(x[3]); })));
  for (const std::vector<std::string>& command : {std::vector<std::string>{"contour", flat, "-o", path("d4.vtkhdf")},
                                                  {"measure", flat},
                                                  {"contour", flat, "--facets", "-o", path("facets.vtu")}}) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--iso", "0.5", "--lattice", "d4"});
    const RunResult run = run_tegl(arguments);
    EXPECT_EQ(run.exit, 5) << run.err;
    EXPECT_THAT(run.err, HasSubstr("has 2 layers; expected at least 3 layers on the lattice d4"));
  }
}

}  // namespace
}  // namespace tegl::test
