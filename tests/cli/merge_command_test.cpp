// SPDX-License-Identifier: BSD-3-Clause
//
// --merge of tegl contour and tegl simplify, and --samples-are cells, run as in a shell.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include <cmath>

#include "sample_files.hpp"
#include "tegl/cells.hpp"
#include "tegl/io.hpp"
#include "tegl/merge.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class MergeCommand : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    // two balls that touch in the sample (6, 3, 3), which is the only one that equals the isovalue 0
    const auto balls = [](const std::vector<double>& x) {
      const double across = std::hypot(x[1] - 3, x[2] - 3);
      return 2.3125 - std::min(std::hypot(x[0] - 3.6875, across), std::hypot(x[0] - 8.3125, across));
    };
    balls_ = write("balls.nii", nifti_bytes(sample({13, 7, 7}, balls), {1, 1, 1}));
  }
  [[nodiscard]] static RunResult run(std::vector<std::string> arguments) { return run_tegl(arguments); }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& message) const {
    const RunResult result = run_tegl(arguments);
    EXPECT_NE(result.exit, 0);
    EXPECT_THAT(result.err, HasSubstr(message));
  }
  std::string balls_;
};

TEST_F(MergeCommand, ReportsThePinchOfTwoBalls) {
  const RunResult plain = run({"contour", balls_, "--iso", "0", "-o", path("a.ply"), "--json"});
  EXPECT_EQ(plain.exit, 0) << plain.err;
  EXPECT_TRUE(plain.json()["merge"].is_null());
  const RunResult merged = run({"contour", balls_, "--iso", "0", "--merge", "-o", path("b.ply"), "--json"});
  EXPECT_EQ(merged.exit, 0) << merged.err;
  const auto report = merged.json()["merge"];
  EXPECT_EQ(report["tolerance"], 0.0);
  EXPECT_EQ(report["pinched_vertices"], 1);
  EXPECT_THAT(report["pinched_at"][0], ElementsAre(6, 3, 3));
  EXPECT_EQ(report["pinched_faces"], 0);
  EXPECT_EQ(report["euler_before"], 2);
  EXPECT_EQ(report["euler_after"], 3);
  EXPECT_EQ(merged.json()["bad_links"], 1);
  EXPECT_EQ(merged.json()["degenerate_simplices"], 0);
  // the same for a saved contour
  const RunResult saved = run({"simplify", path("a.ply"), "--merge", "-o", path("c.ply"), "--json"});
  EXPECT_EQ(saved.exit, 0) << saved.err;
  EXPECT_EQ(saved.json()["merge"], report);
  EXPECT_EQ(read_mesh(path("b.ply")).simplices, read_mesh(path("c.ply")).simplices);
  const RunResult text = run({"contour", balls_, "--iso", "0", "--merge-within", "0.001", "-o", path("d.ply")});
  EXPECT_EQ(text.exit, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("pinched      1 vertex"));
}

TEST_F(MergeCommand, RefusesOtherOptions) {
  expect_refused({"contour", balls_, "--iso", "0", "--merge-within", "-1", "-o", path("a.ply")}, "expected 0 or more");
  expect_refused({"contour", balls_, "--iso", "0", "--merge-within", "x", "-o", path("a.ply")}, "--merge-within");
  expect_refused({"contour", balls_, "--iso", "0", "--merge", "--facets", "-o", path("a.vtu")},
                 "--merge with --facets");
  expect_refused({"contour", balls_, "--iso", "0,1", "--merge", "--one-file", "-o", path("a.ply")},
                 "--merge with --one-file");
  expect_refused({"contour", balls_, "--iso", "0", "--merge", "--stream", "-o", path("a.vtkhdf")},
                 "--merge with --stream");
  expect_refused({"simplify", balls_, "--iso", "0", "--merge", "--ratio", "0.5", "-o", path("a.ply")},
                 "--merge with --ratio");
}

TEST_F(MergeCommand, MergingEverythingIsAnEmptyResult) {
  const std::vector<std::string> all = {"contour", balls_, "--iso", "0", "--merge-within", "100", "-o", path("a.ply")};
  const RunResult refused = run(all);
  EXPECT_EQ(refused.exit, 5);
  EXPECT_THAT(refused.err, HasSubstr("leaves nothing"));
  EXPECT_TRUE(files() == std::vector<std::string>{"balls.nii"});
  std::vector<std::string> allowed = all;
  allowed.emplace_back("--allow-empty");
  const RunResult empty = run(allowed);
  EXPECT_EQ(empty.exit, 0);
  EXPECT_THAT(empty.err, HasSubstr("leaves nothing"));
  EXPECT_EQ(run({"simplify", path("a.ply"), "--merge", "--allow-empty", "-o", path("b.ply")}).exit, 0);
}

TEST_F(MergeCommand, CellsHaveTheirExactVolume) {
  const ReadImageResult input = read_image(balls_);
  const auto& image = std::get<OwnedImage<float, 3>>(std::get<AnyImageN<3>>(input.image));
  double high = 0;
  for (const float value : image.values) high += value >= 1 ? 1 : 0;
  const RunResult result =
      run({"contour", balls_, "--iso", "1", "--samples-are", "cells", "-o", path("a.ply"), "--json"});
  EXPECT_EQ(result.exit, 0) << result.err;
  EXPECT_EQ(result.json()["boundary_simplices"], 0);
  const RunResult measured = run({"measure", path("a.ply"), "--json"});
  EXPECT_NEAR(measured.json()["content"].get<double>(), high, 1e-9 * high);
  const RunResult direct = run({"measure", balls_, "--iso", "1", "--samples-are", "cells", "--json"});
  EXPECT_NEAR(direct.json()["content"].get<double>(), high, 1e-9 * high);
  const RunResult smooth = run({"contour", balls_, "--iso", "1", "--samples-are", "cells", "--positions", "relaxed",
                                "-o", path("b.ply"), "--json"});
  EXPECT_EQ(smooth.exit, 0) << smooth.err;
  EXPECT_NE(smooth.json()["simplices"], result.json()["simplices"]);
  // slices: inside of a layer of cells, at a face between two, and between the outer face and the first sample
  double in_layer = 0;
  for (std::size_t i = 3 * 91; i < 4 * 91; ++i) in_layer += image.values[i] >= 1 ? 1 : 0;
  for (const char* at : {"3.2", "2.5", "-0.4"}) {
    const RunResult slice = run({"slice", balls_, "--iso", "1", "--samples-are", "cells", "--at",
                                 std::string("z=") + at, "--allow-empty", "-o", path("s.vtkhdf"), "--json"});
    ASSERT_EQ(slice.exit, 0) << slice.err;
    EXPECT_EQ(slice.json()["boundary_simplices"], 0);
    if (std::string(at) != "3.2") continue;
    EXPECT_GT(slice.json()["simplices"].get<int>(), 0);
    const RunResult area = run({"measure", path("s.vtkhdf"), "--json"});
    EXPECT_NEAR(area.json()["content"].get<double>(), in_layer, 1e-9 * in_layer);
  }
  expect_refused({"slice", balls_, "--iso", "1", "--samples-are", "cells", "--at", "z=-0.6", "-o", path("s.ply")},
                 "-0.5");
  expect_refused({"contour", balls_, "--iso", "1", "--samples-are", "cells", "--stream", "-o", path("a.vtkhdf")},
                 "--samples-are cells with --stream");
  expect_refused({"contour", balls_, "--iso", "1", "--samples-are", "cells", "--lattice", "fcc", "-o", path("a.ply")},
                 "--samples-are cells");
  expect_refused({"contour", balls_, "--iso", "1", "--samples-are", "cells", "--normals", "-o", path("a.ply")},
                 "normals from the image");
  expect_refused({"contour", balls_, "--iso", "1", "--samples-are", "boxes", "-o", path("a.ply")}, "boxes");
}

TEST_F(MergeCommand, SamplesAreCellsIfTheFileSaysSo) {
  const Samples mask = sample({5, 5, 5}, [](const std::vector<double>& x) {
    return std::abs(x[0] - 2) + std::abs(x[1] - 2) + std::abs(x[2] - 2) < 1.5 ? 1.0 : 0.0;
  });
  for (const char* const centers : {"cell cell cell", "cell node cell", "node node node"}) {
    const std::string image = write("mask.nrrd", nrrd_bytes(mask, fmt::format("centers: {}\n", centers)));
    const bool are_cells = std::string_view(centers) == "cell cell cell";
    EXPECT_EQ(run({"info", image, "--json"}).json()["samples_are"], are_cells ? "cells" : "points");
    const RunResult run_file = run({"measure", image, "--iso", "1", "--samples-are", "file", "--json"});
    ASSERT_EQ(run_file.exit, 0) << run_file.err;
    EXPECT_EQ(std::abs(run_file.json()["content"].get<double>() - 7) < 1e-9, are_cells) << centers;
    const RunResult points = run({"measure", image, "--iso", "1", "--json"});
    EXPECT_LT(points.json()["content"].get<double>(), 6.0) << "points are the default";
    // options that cells do not have are refused for cells only
    for (const std::vector<std::string>& option :
         {std::vector<std::string>{"--pick", "2,2,2"}, {"--stream"}, {"--division", "kuhn"}, {"--facets"}}) {
      std::vector<std::string> arguments = {"contour",       image,  "--iso", "1",
                                            "--samples-are", "file", "-o",    path("b.vtkhdf")};
      arguments.insert(arguments.end(), option.begin(), option.end());
      const RunResult result = run(arguments);
      EXPECT_EQ(result.exit, are_cells ? 2 : 0) << centers << " " << option[0] << result.err;
      if (are_cells) {
        EXPECT_THAT(result.err, HasSubstr("--samples-are file with " + option[0]));
      }
    }
    // filtered cells are cells
    for (const char* const output : {"f.nrrd", "f.vti"}) {
      ASSERT_EQ(run({"filter", image, "--gaussian", "0.01", "-o", path(output), "-q"}).exit, 0);
      const RunResult of_filtered = run({"measure", path(output), "--iso", "0.9", "--samples-are", "file", "--json"});
      EXPECT_EQ(std::abs(of_filtered.json()["content"].get<double>() - 7) < 1e-9, are_cells) << centers << output;
    }
  }
}

TEST_F(MergeCommand, CellsOfRectilinearGridsHaveTheSizesOfTheFile) {
  // faces that are not midway between the centres of the cells
  const std::string image =
      write("cells.vtr",
            "<VTKFile type=\"RectilinearGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
            "<RectilinearGrid WholeExtent=\"0 4 0 3 0 3\"><Piece Extent=\"0 4 0 3 0 3\">\n"
            "<CellData Scalars=\"v\"><DataArray type=\"Float32\" Name=\"v\" format=\"ascii\">\n"
            "0 0 0 0  0 0 0 0  0 0 0 0\n0 0 0 0  0 1 1 0  0 0 0 0\n0 0 0 0  0 0 0 0  0 0 0 0\n</DataArray></CellData>\n"
            "<Coordinates><DataArray type=\"Float64\" Name=\"x\" format=\"ascii\">0 1 4 5 9</DataArray>\n"
            "<DataArray type=\"Float64\" Name=\"y\" format=\"ascii\">0 10 11 20</DataArray>\n"
            "<DataArray type=\"Float64\" Name=\"z\" format=\"ascii\">-4 -1 0.5 1</DataArray></Coordinates>\n"
            "</Piece></RectilinearGrid></VTKFile>\n");
  for (const char* const samples : {"cells", "file"}) {
    const auto measures = run({"measure", image, "--iso", "1", "--samples-are", samples, "--json"}).json();
    EXPECT_NEAR(measures["content"].get<double>(), 4 * 1 * 1.5, 1e-12);
    EXPECT_THAT(measures["lowest"], ElementsAre(1, 10, -1));
    EXPECT_THAT(measures["highest"], ElementsAre(5, 11, 0.5));
  }
  const ReadImageResult read = read_image(image);
  EXPECT_THAT(read.info.cell_faces[0], ElementsAre(0, 1, 4, 5, 9));
  const auto& cells = std::get<OwnedImage<float, 3>>(std::get<AnyImageN<3>>(read.image));
  CellFaces faces = read.info.cell_faces;
  faces[1][1] = 16;
  EXPECT_THROW((void)extract_cells(cells.view(), 1, {}, {}, faces), Error);
  faces = {{0, 1}};
  EXPECT_THROW((void)extract_cells(cells.view(), 1, {}, {}, faces), Error);
}

}  // namespace
}  // namespace tegl::test
