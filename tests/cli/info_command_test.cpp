// SPDX-License-Identifier: BSD-3-Clause
//
// The command tegl info: axes, values, variables, world map and suggested isovalues of image files.
#include <gmock/gmock.h>

#include <numeric>

#include "sample_files.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Info = ProgramTest;

TEST_F(Info, TellsAxesAndValuesOfAnNrrdFile) {
  const std::string file = write("ball.nrrd", nrrd_bytes(ball({7, 6, 5}, 2), "spacings: 1 0.5 2\n"));
  const RunResult run = run_tegl({"info", file, "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  const nlohmann::json info = run.json();
  EXPECT_EQ(info["format"], "NRRD");
  EXPECT_EQ(info["image_dim"], 3);
  EXPECT_EQ(info["value_type"], "float");
  EXPECT_EQ(info["samples"], 7 * 6 * 5);
  EXPECT_EQ(info["missing"], 0);
  ASSERT_EQ(info["axes"].size(), 3u);
  EXPECT_EQ(info["axes"][1]["size"], 6);
  EXPECT_EQ(info["axes"][1]["step"], 0.5);
  EXPECT_EQ(info["axes"][1]["uniform"], true);
  const auto counts = info["histogram"]["counts"].get<std::vector<int>>();
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), 7 * 6 * 5);
  EXPECT_FALSE(info["suggested"].empty());
  EXPECT_TRUE(run.err.empty()) << run.err;
}

TEST_F(Info, ShowsTheSameToPeople) {
  const std::string file = write("ball.nrrd", nrrd_bytes(ball({7, 6, 5}, 2)));
  const RunResult run = run_tegl({"info", file});
  ASSERT_EQ(run.exit, 0) << run.err;
  for (const char* part : {"3D NRRD", "axes", "6 samples", "missing", "Histogram", "#", "Suggested values", "otsu"}) {
    EXPECT_THAT(run.out, HasSubstr(part));
  }
  EXPECT_EQ(run.out.find('\x1b'), std::string::npos) << "colours without a terminal";
}

TEST_F(Info, RemarksOnAnExtensionOfOtherData) {
  const std::string file = write(
      "triangle.vts",
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"3\" NumberOfCells=\"1\"><Points>"
      "<DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0</DataArray></Points>"
      "<Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3</DataArray>"
      "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">5</DataArray></Cells><PointData>"
      "<DataArray type=\"Float32\" Name=\"v\" format=\"ascii\">0 1 1</DataArray></PointData></Piece>"
      "</UnstructuredGrid></VTKFile>");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"info", file}, {"contour", file, "--iso", "0.5", "-o", path("out.vtkhdf")}}) {
    const RunResult run = run_tegl(command);
    EXPECT_EQ(run.exit, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("triangle.vts holds UnstructuredGrid, whose extension is .vtu; .vts is for"));
  }
}

TEST_F(Info, TellsTheTimeAxisAndTheWorldOfANiftiFile) {
  const std::string file = write("balls.nii", nifti_bytes(merging_balls(9, 4), {2, 2, 3, 1.5f}));
  const RunResult run = run_tegl({"info", file, "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  const nlohmann::json info = run.json();
  EXPECT_EQ(info["format"], "NIfTI");
  EXPECT_EQ(info["image_dim"], 4);
  EXPECT_EQ(info["axes"][3]["unit"], "s");
  EXPECT_EQ(info["axes"][3]["last"], 4.5);
  EXPECT_EQ(info["world_frame"], "RAS");
}

TEST_F(Info, ShowsTheWorldMatrixInColumnsWhateverItsEntries) {
  const std::string file =
      write("tilted.nrrd", nrrd_bytes(ball({7, 6, 5}, 2),
                                      "space: left-posterior-superior\nspace origin: (117.855, -35.7229, 1e-19)\n"
                                      "space directions: (-1,-3.35736e-19,4.12774e-18) (0,0.986856,0.161604) "
                                      "(1.5e-8,-0.161604,0.986856)\n"));
  const RunResult run = run_tegl({"info", file});
  ASSERT_EQ(run.exit, 0) << run.err;
  // Entries that are only rounding errors of entries of 1 are printed with one digit, other entries with all digits.
  EXPECT_THAT(run.out, HasSubstr("  world            -1         0    1.5e-08  |   117.855  LPS\n"
                                 "               -3e-19  0.986856  -0.161604  |  -35.7229\n"
                                 "                4e-18  0.161604   0.986856  |     1e-19\n"));
  EXPECT_EQ(run_tegl({"info", file, "--json"}).json()["world"]["linear"][2][0], 4.12774e-18) << "exact for programs";
}

TEST_F(Info, ShowsTheUnitOfTheWorldCoordinateThatDiffersAlongAnAxis) {
  const auto info_of = [&](const std::string& directions) {
    return write("turned.nrrd", nrrd_bytes(ball({7, 6, 5}, 2), "space dimension: 3\nspace directions: " + directions +
                                                                   "\nspace units: \"mm\" \"km\" \"s\"\n"));
  };
  const std::string file = info_of("(0,0,1) (0,1,0) (1,0,0)");
  const RunResult run = run_tegl({"info", file});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("7 samples, 0 .. 6 s"));
  EXPECT_THAT(run.out, HasSubstr("6 samples, 0 .. 5 km"));
  EXPECT_THAT(run.out, HasSubstr("5 samples, 0 .. 4 mm"));
  EXPECT_EQ(run_tegl({"info", file, "--json"}).json()["axes"][0]["unit"], "s");
  // along a slanted axis, coordinates of several units differ
  const std::string slanted = run_tegl({"info", info_of("(1,0,1) (0,1,0) (0,0,1)")}).out;
  EXPECT_THAT(slanted, HasSubstr("7 samples, 0 .. 8.48528, step 1.41421"));
  EXPECT_THAT(slanted, HasSubstr("5 samples, 0 .. 4 s"));
}

TEST_F(Info, DescribesSavedContours) {
  const std::string image = write("balls.nii", nifti_bytes(merging_balls(9, 4), {2, 2, 3, 1.5f}));
  const RunResult made =
      run_tegl({"contour", image, "--iso", "0", "--attribute", image, "-o", path("c.vtkhdf"), "--json"});
  ASSERT_EQ(made.exit, 0) << made.err;
  const RunResult run = run_tegl({"info", path("c.vtkhdf"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  const nlohmann::json info = run.json();
  EXPECT_EQ(info["format"], "VTKHDF");
  EXPECT_EQ(info["type"], "contour");
  EXPECT_EQ(info["image_dim"], 4);
  EXPECT_EQ(info["isovalue"], 0);
  EXPECT_EQ(info["vertices"], made.json()["vertices"]);
  EXPECT_EQ(info["simplices"], made.json()["simplices"]);
  ASSERT_EQ(info["axes"].size(), 4u);
  EXPECT_EQ(info["axes"][3]["name"], "t");
  EXPECT_EQ(info["axes"][3]["unit"], "s");
  EXPECT_GE(info["axes"][3]["min"], 0);
  EXPECT_LE(info["axes"][3]["max"], 4.5);
  EXPECT_LT(info["axes"][3]["min"], info["axes"][3]["max"]);
  ASSERT_EQ(info["attributes"].size(), 1u);
  EXPECT_EQ(info["attributes"][0]["name"], "balls");
  EXPECT_EQ(info["attributes"][0]["on"], "vertices");
  EXPECT_NEAR(info["attributes"][0]["max"].get<double>(), 0, 1e-5);
  const RunResult text = run_tegl({"info", path("c.vtkhdf")});
  for (const char* part : {"a contour in 4D, VTKHDF", "isovalue", "tetrahedra", " s\n", "Attributes", "of vertices"})
    EXPECT_THAT(text.out, HasSubstr(part));
  // lines in a plane, in a format that has three coordinates
  const std::string flat = write("flat.nrrd", nrrd_bytes(ball({7, 6}, 2)));
  ASSERT_EQ(run_tegl({"contour", flat, "--iso", "0", "-o", path("flat.glb")}).exit, 0);
  const nlohmann::json lines = run_tegl({"info", path("flat.glb"), "--json"}).json();
  EXPECT_EQ(lines["format"], "glTF");
  EXPECT_EQ(lines["image_dim"], 2);
  EXPECT_EQ(lines["axes"].size(), 2u);
  const RunResult refused = run_tegl({"info", path("flat.glb"), "--var", "T"});
  EXPECT_EQ(refused.exit, 2);
  EXPECT_THAT(refused.err, HasSubstr("is a saved contour, which does not take --var"));
}

TEST_F(Info, ReadsMetaImage) {
  const std::string file = write("ball.mha", metaimage_bytes(ball({7, 6}, 2)));
  const RunResult run = run_tegl({"info", file, "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  EXPECT_EQ(run.json()["format"], "MetaImage");
  EXPECT_EQ(run.json()["image_dim"], 2);
}

TEST_F(Info, ShowsMissingSamplesAndUnevenAxesOfANetcdfFile) {
  Samples values = ball({4, 3, 5}, 2);
  values.values[0] = values.values[7] = -999;
  write_netcdf(path("sea.nc"), {"lon", "lat", "depth"}, {{0, 1, 2, 3}, {-1, 0, 1}, {0, 10, 25, 50, 100}},
               {{"TEMP", values}});
  const RunResult run = run_tegl({"info", path("sea.nc"), "--json"});
  ASSERT_EQ(run.exit, 0) << run.err;
  const nlohmann::json info = run.json();
  EXPECT_EQ(info["variable"], "TEMP");
  EXPECT_EQ(info["value_unit"], "degC");
  EXPECT_EQ(info["missing"], 2);
  EXPECT_EQ(info["axes"][2]["name"], "depth");
  EXPECT_EQ(info["axes"][2]["uniform"], false);
  EXPECT_THAT(info["axes"][2]["coordinates"], ElementsAre(0, 10, 25, 50, 100));
  EXPECT_THAT(run_tegl({"info", path("sea.nc")}).out, HasSubstr("steps 10 to 50"));
}

TEST_F(Info, NamesTheVariablesWhereThereAreSeveral) {
  const Samples values = ball({4, 3}, 1);
  write_netcdf(path("two.nc"), {"lon", "lat"}, {{0, 1, 2, 3}, {0, 1, 2}}, {{"TEMP", values}, {"SALT", values}});
  const RunResult unnamed = run_tegl({"info", path("two.nc")});
  EXPECT_EQ(unnamed.exit, 0) << unnamed.err;
  for (const char* part : {"TEMP", "SALT", "4 x 3", "degC", "--var"}) EXPECT_THAT(unnamed.out, HasSubstr(part));
  const RunResult list = run_tegl({"info", path("two.nc"), "--json"});
  EXPECT_THAT(list.json()["variables"], ElementsAre("TEMP", "SALT"));
  EXPECT_THAT(list.json()["shapes"]["SALT"], ElementsAre(4, 3));
  const RunResult contour = run_tegl({"contour", path("two.nc"), "--iso", "0", "-o", path("out.ply")});
  EXPECT_EQ(contour.exit, 2);
  for (const char* part : {"TEMP", "SALT", "--var"}) EXPECT_THAT(contour.err, HasSubstr(part));
  const RunResult named = run_tegl({"info", path("two.nc"), "--var", "SALT", "--json"});
  ASSERT_EQ(named.exit, 0) << named.err;
  EXPECT_EQ(named.json()["variable"], "SALT");
  EXPECT_EQ(named.json()["variables"].size(), 2u);
  const RunResult unknown = run_tegl({"info", path("two.nc"), "--var", "WIND"});
  EXPECT_EQ(unknown.exit, 2);
  EXPECT_THAT(unknown.err, HasSubstr("WIND"));
  EXPECT_THAT(unknown.err, HasSubstr("SALT"));
}

TEST_F(Info, ShowsAVariableOf6Axes) {
  const Samples values =
      sample({5, 4, 3, 2, 2, 2}, [](const std::vector<double>& at) { return at[0] + 100 * at[4] + 1000 * at[5]; });
  write_netcdf(path("six.nc"), {"x", "y", "z", "time", "member", "run"},
               {{0, 1, 2, 3, 4}, {0, 1, 2, 3}, {0, 1, 2}, {0, 1}, {7, 8}, {0, 1}}, {{"v", values}});
  const RunResult list = run_tegl({"info", path("six.nc")});
  ASSERT_EQ(list.exit, 0) << list.err;
  for (const char* part : {"a variable of 6 axes", "5 x 4 x 3 x 2 x 2 x 2 (x, y, z, time, member, run)", "--fix run=0"})
    EXPECT_THAT(list.out, HasSubstr(part));
  const RunResult json = run_tegl({"info", path("six.nc"), "--json"});
  EXPECT_THAT(json.json()["dimensions"]["v"], ElementsAre("x", "y", "z", "time", "member", "run"));
  const RunResult contour = run_tegl({"contour", path("six.nc"), "--iso", "2", "-o", path("out.vtkhdf")});
  EXPECT_EQ(contour.exit, 4);
  for (const char* part : {"5 x 4 x 3 x 2 x 2 x 2", "such as run=0", "--fix"})
    EXPECT_THAT(contour.err, HasSubstr(part));
}

TEST_F(Info, ReadsAVariableOf5AxesAsAWholeAndAtAFixedIndex) {
  const Samples values = sample({5, 4, 3, 2, 2}, [](const std::vector<double>& at) { return at[0] + 100 * at[4]; });
  write_netcdf(path("five.nc"), {"x", "y", "z", "time", "member"},
               {{0, 1, 2, 3, 4}, {0, 1, 2, 3}, {0, 1, 2}, {0, 1}, {7, 8}}, {{"v", values}});
  const RunResult all = run_tegl({"info", path("five.nc"), "--json"});
  ASSERT_EQ(all.exit, 0) << all.err;
  EXPECT_EQ(all.json()["image_dim"], 5);
  EXPECT_EQ(all.json()["max"], 104);
  const RunResult member = run_tegl({"info", path("five.nc"), "--fix", "member=1", "--json"});
  ASSERT_EQ(member.exit, 0) << member.err;
  EXPECT_EQ(member.json()["image_dim"], 4);
  EXPECT_EQ(member.json()["min"], 100);
  EXPECT_EQ(member.json()["max"], 104);
  const RunResult contour = run_tegl({"contour", path("five.nc"), "--iso", "2.5", "-o", path("out.vtkhdf"), "--json"});
  ASSERT_EQ(contour.exit, 0) << contour.err;
  EXPECT_EQ(contour.json()["dim"], 4);
  const std::vector<std::string> fixed = {"contour", path("five.nc"), "--iso", "102.5", "--fix", "member=1", "-o"};
  std::vector<std::string> whole = fixed;
  whole.push_back(path("whole.vtkhdf"));
  EXPECT_EQ(run_tegl(whole).exit, 0);
  std::vector<std::string> streamed = fixed;
  streamed.insert(streamed.end(), {path("streamed.vtkhdf"), "--stream"});
  EXPECT_EQ(run_tegl(streamed).exit, 0);
  for (const char* wrong : {"member", "=1", "member=-1", "member=x", "member=0.5"}) {
    const RunResult run = run_tegl({"info", path("five.nc"), "--fix", wrong});
    EXPECT_EQ(run.exit, 2) << wrong;
    EXPECT_THAT(run.err, HasSubstr("--fix is '" + std::string(wrong) + "'; expected"));
  }
  EXPECT_EQ(run_tegl({"info", path("five.nc"), "--fix", "member=2"}).exit, 2);
}

TEST_F(Info, SaysSoWhenThereAreNoValues) {
  const std::string file = write("nan.nrrd", nrrd_bytes(sample({3, 3}, [](auto&) { return NAN; })));
  const RunResult run = run_tegl({"info", file});
  EXPECT_EQ(run.exit, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("9 missing"));
  const RunResult json = run_tegl({"info", file, "--json"});
  EXPECT_TRUE(json.json()["min"].is_null());
  EXPECT_TRUE(json.json()["suggested"].empty());
}

TEST_F(Info, SuggestsIsovaluesThatHaveAContour) {
  const std::string file = write("noise.nrrd", nrrd_bytes_uint8(noise({8, 8, 8}, 1)));
  const nlohmann::json suggested = run_tegl({"info", file, "--json"}).json()["suggested"];
  ASSERT_FALSE(suggested.empty());
  for (const auto& suggestion : suggested) {
    const RunResult run =
        run_tegl({"contour", file, "--iso", suggestion["value"].dump(), "-o", path("out.ply"), "--json"});
    ASSERT_EQ(run.exit, 0) << run.err;
    // Edge points on the image border also lie in tiles, so all are counted.
    EXPECT_GE(run.json()["vertices"], suggestion["edges"]);
  }
}

}  // namespace
}  // namespace tegl::test
