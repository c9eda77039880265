// SPDX-License-Identifier: BSD-3-Clause
//
// Several files as one image, in every command that reads an image.
#include <gmock/gmock.h>

#include <cstring>
#include <filesystem>
#include <set>

#include "sample_files.hpp"
#include "tegl/io.hpp"
#include "tegl_program.hpp"

namespace tegl::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// Layer k of samples along their last axis.
Samples layer(const Samples& samples, std::size_t k) {
  Samples result;
  result.sizes.assign(samples.sizes.begin(), samples.sizes.end() - 1);
  const std::size_t size = samples.values.size() / samples.sizes.back();
  const auto begin = samples.values.begin() + static_cast<std::ptrdiff_t>(k * size);
  result.values.assign(begin, begin + static_cast<std::ptrdiff_t>(size));
  return result;
}

/// A DICOM element, explicit VR, little endian.
std::string element(unsigned group, unsigned number, const std::string& type, std::string value) {
  if (value.size() % 2 == 1) value += type == "UI" ? '\0' : ' ';
  const auto bytes = [](std::size_t integer, int count) {
    std::string text;
    for (int i = 0; i < count; ++i) text += static_cast<char>(integer >> (8 * i) & 0xff);
    return text;
  };
  const std::string length = type == "OW" ? bytes(0, 2) + bytes(value.size(), 4) : bytes(value.size(), 2);
  return bytes(group, 2) + bytes(number, 2) + type + length + value;
}

std::string short_value(unsigned value) { return {static_cast<char>(value & 0xff), static_cast<char>(value >> 8)}; }

/// A slice of `size` x `size` samples at z: at least `inside` in the middle and 0 at its border; 0 everywhere if
/// `inside` is 0.
std::string dicom_bytes(double z, unsigned size, const std::string& series = "1.2.3", unsigned frames = 1,
                        unsigned told_size = 0, unsigned inside = 100) {
  std::string pixels;
  for (unsigned y = 0; y < size; ++y)
    for (unsigned x = 0; x < size; ++x)
      pixels += short_value(inside > 0 && x > 0 && y > 0 && x + 1 < size && y + 1 < size ? inside + x + 7 * y : 0);
  const std::string told = short_value(told_size == 0 ? size : told_size);
  return std::string(128, '\0') + "DICM" + element(2, 0, "UL", std::string("\x1c\0\0\0", 4)) +
         element(2, 0x10, "UI", "1.2.840.10008.1.2.1") + element(8, 0x60, "CS", "MR") +
         element(0x20, 0xe, "UI", series) + element(0x20, 0x32, "DS", "0\\0\\" + std::to_string(z)) +
         element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0") + element(0x28, 2, "US", short_value(1)) +
         element(0x28, 4, "CS", "MONOCHROME2") + element(0x28, 8, "IS", std::to_string(frames)) +
         element(0x28, 0x10, "US", told) + element(0x28, 0x11, "US", told) + element(0x28, 0x30, "DS", "1\\1") +
         element(0x28, 0x100, "US", short_value(16)) + element(0x28, 0x101, "US", short_value(16)) +
         element(0x28, 0x102, "US", short_value(15)) + element(0x28, 0x103, "US", short_value(0)) +
         element(0x7fe0, 0x10, "OW", pixels);
}

/// True if `tegl` was built with DICOM.
bool reads_dicom(const std::string& file) { return run_tegl({"info", file}).err.find("DCMTK") == std::string::npos; }

class SeriesCommand : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    balls_ = merging_balls(10, 12);
    whole_ = write("whole.nrrd", nrrd_bytes(balls_));
    for (std::size_t k = 0; k < 12; ++k)
      frames_.push_back(write("frame_" + std::to_string(k) + ".nrrd", nrrd_bytes(layer(balls_, k))));
  }

  /// A command with the frames in numerical order, and further arguments.
  [[nodiscard]] std::vector<std::string> of_frames(std::vector<std::string> command,
                                                   const std::vector<std::string>& more) const {
    command.insert(command.end(), frames_.begin(), frames_.end());
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  /// Sorts as shells do: frame_10 before frame_2.
  void sort_as_shells_do() { std::sort(frames_.begin(), frames_.end()); }

  /// Runs the command, expects success, and returns the JSON.
  static nlohmann::json run(std::vector<std::string> arguments) {
    arguments.emplace_back("--json");
    const RunResult result = run_tegl(arguments);
    EXPECT_EQ(result.exit, 0) << result.err;
    return result.json();
  }
  static void expect_refused(int exit, const std::vector<std::string>& arguments,
                             const std::vector<std::string>& parts) {
    const RunResult result = run_tegl(arguments);
    EXPECT_EQ(result.exit, exit) << result.err;
    for (const std::string& part : parts) EXPECT_THAT(result.err, HasSubstr(part));
  }
  void expect_same_mesh(const std::string& a, const std::string& b) const {
    const Mesh x = read_mesh(path(a));
    const Mesh y = read_mesh(path(b));
    EXPECT_EQ(x.coordinates, y.coordinates);
    EXPECT_EQ(x.simplices, y.simplices);
    EXPECT_EQ(x.axis_names, y.axis_names);
  }

  Samples balls_;
  std::string whole_;
  std::vector<std::string> frames_;
};

// DICOM planes contain their positions, so the order of their names does not matter.
TEST_F(SeriesCommand, TakesDicomFilesInTheOrderOfAShell) {
  std::filesystem::create_directory(path("scan"));
  std::vector<std::string> arguments = {"contour"};
  for (const int k : {0, 1, 10, 11, 2, 3, 4, 5, 6, 7, 8, 9})
    arguments.push_back(write("scan/a" + std::to_string(k) + ".dcm", dicom_bytes(2.5 * k, 6)));
  if (!reads_dicom(arguments[1])) GTEST_SKIP() << "built without DICOM";
  arguments.insert(arguments.end(), {"--iso", "50", "-o", path("files.ply")});
  const nlohmann::json files = run(arguments);
  EXPECT_EQ(files["image_dim"], 3);
  EXPECT_GT(files["simplices"], 0);
  run({"contour", path("scan"), "--iso", "50", "-o", path("folder.ply")});
  expect_same_mesh("files.ply", "folder.ply");
}

TEST_F(SeriesCommand, NumbersTheSeriesOfAFolder) {
  std::filesystem::create_directory(path("scan"));
  for (int k = 0; k < 4; ++k) {
    write("scan/a" + std::to_string(k) + ".dcm", dicom_bytes(k, 6, "1.2.3"));
    write("scan/b" + std::to_string(k) + ".dcm", dicom_bytes(k, 8, "1.2.4"));
  }
  if (!reads_dicom(path("scan/a0.dcm"))) GTEST_SKIP() << "built without DICOM";
  const RunResult list = run_tegl({"info", path("scan")});
  EXPECT_THAT(list.out, testing::ContainsRegex("1 +1\\.2\\.3 .*\n.*2 +1\\.2\\.4 "));
  EXPECT_EQ(run({"info", path("scan")})["variables"][1], "1.2.4");
  EXPECT_EQ(run({"info", path("scan"), "--series", "2"})["axes"][0]["size"], 8);
  expect_refused(2, {"info", path("scan"), "--var", "2"}, {"--var 2", "DICOM", "expected --series"});
  expect_refused(2, {"info", path("scan/a0.dcm"), "--var", "2"}, {"--var 2", "DICOM", "expected --series"});
}

TEST_F(SeriesCommand, LeavesAsideColoursAndFilesOfTheFinder) {
  std::filesystem::create_directory(path("scan"));
  for (int k = 0; k < 4; ++k) write("scan/a" + std::to_string(k) + ".dcm", dicom_bytes(k, 6));
  std::string colours = dicom_bytes(0, 6, "1.2.4");
  colours.replace(colours.find("MONOCHROME2"), 11, "PALETTE    ");
  const std::string screenshot = write("scan/b.dcm", colours);
  write("scan/._a0.dcm", "Mac OS X");
  if (!reads_dicom(path("scan/a0.dcm"))) GTEST_SKIP() << "built without DICOM";
  EXPECT_EQ(run({"info", path("scan")})["axes"][2]["size"], 4);
  expect_refused(4, {"info", screenshot}, {"b.dcm", "PALETTE"});
}

TEST_F(SeriesCommand, SaysWhatItLeavesOutOfAFolder) {
  std::filesystem::create_directory(path("scan"));
  for (int k = 0; k < 4; ++k) write("scan/a" + std::to_string(k) + ".dcm", dicom_bytes(k, 6));
  const std::string notes = write("scan/notes.dcm", "Dear colleague, these are the slices.");
  if (!reads_dicom(path("scan/a0.dcm"))) GTEST_SKIP() << "built without DICOM";
  const RunResult info = run_tegl({"info", path("scan"), "--json"});
  EXPECT_EQ(info.json()["axes"][2]["size"], 4);
  EXPECT_THAT(info.json()["remarks"][0], HasSubstr("notes.dcm"));
  EXPECT_THAT(info.err, HasSubstr("tegl: skipped: " + notes));
  const std::vector<std::string> contour = {"contour", path("scan"), "--iso", "50", "-o", path("out.ply")};
  EXPECT_THAT(run_tegl(contour).err, HasSubstr(notes));
  std::vector<std::string> streamed = contour;
  streamed.back() = path("out.vtkhdf");
  streamed.emplace_back("--stream");
  EXPECT_THAT(run_tegl(streamed).err, HasSubstr(notes));
  std::vector<std::string> quiet = contour;
  quiet.emplace_back("--quiet");
  EXPECT_EQ(run_tegl(quiet).err, "");
  expect_refused(4, {"info", notes}, {"notes.dcm"});
}

// Uneven spacing of the slices in the middle of an object does not change its contour's measures.
TEST_F(SeriesCommand, PutsUnevenSlicesOfDicomWhereTheyLie) {
  const auto scan = [&](const std::string& name, const std::vector<double>& places) {
    std::filesystem::create_directory(path(name));
    for (std::size_t k = 0; k < places.size(); ++k) {
      const bool empty = k == 0 || k + 1 == places.size();  // the contour is closed
      write(name + "/a" + std::to_string(k) + ".dcm", dicom_bytes(places[k], 6, "1.2.3", 1, 0, empty ? 0 : 100));
    }
    return path(name);
  };
  const std::string even = scan("even", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  const std::string uneven = scan("uneven", {0, 1, 3, 5, 7, 9, 10});
  if (!reads_dicom(even + "/a0.dcm")) GTEST_SKIP() << "built without DICOM";
  EXPECT_THAT(run_tegl({"info", uneven}).err, HasSubstr("uneven distances, 1 to 2 mm"));
  EXPECT_EQ(run_tegl({"info", even}).err, "");
  const double expected = run({"measure", even, "--iso", "50"})["content"];
  EXPECT_GT(expected, 100);
  EXPECT_NEAR(run({"measure", uneven, "--iso", "50"})["content"], expected, 1e-6 * expected);
  std::filesystem::remove(uneven + "/a3.dcm");
  expect_refused(4, {"measure", uneven, "--iso", "50"}, {"a4.dcm: lies 4 mm from", "missing"});
}

TEST_F(SeriesCommand, RefusesDicomHeadersThatPromiseMoreThanTheFileHas) {
  const std::string sound = write("sound.dcm", dicom_bytes(0, 6));
  if (!reads_dicom(sound)) GTEST_SKIP() << "built without DICOM";
  const std::string huge = write("huge.dcm", dicom_bytes(0, 6, "1.2.3", 100000, 60000));
  expect_refused(4, {"info", huge}, {"huge.dcm", "60000 x 60000 x 100000"});
}

TEST_F(SeriesCommand, GivesTheContourOfTheWholeImage) {
  run({"contour", whole_, "--iso", "0.1", "-o", path("whole.vtkhdf")});
  const nlohmann::json report = run(of_frames({"contour"}, {"--iso", "0.1", "-o", path("series.vtkhdf")}));
  EXPECT_EQ(report["image_dim"], 4);
  EXPECT_EQ(report["input"].size(), 12U);
  EXPECT_EQ(report["input"][1], frames_[1]);
  expect_same_mesh("whole.vtkhdf", "series.vtkhdf");
  run(of_frames({"contour"}, {"--iso", "0.1", "--stream", "-o", path("streamed.vtkhdf")}));
  expect_same_mesh("whole.vtkhdf", "streamed.vtkhdf");
}

TEST_F(SeriesCommand, IsReadByEveryCommandThatReadsAnImage) {
  EXPECT_EQ(run(of_frames({"info"}, {}))["axes"][3]["size"], 12);
  EXPECT_EQ(run(of_frames({"measure"}, {"--iso", "0.1"}))["size"], run({"measure", whole_, "--iso", "0.1"})["size"]);
  EXPECT_EQ(run(of_frames({"components"}, {"--iso", "0.1"}))["input"].size(), 12U);
  EXPECT_EQ(run(of_frames({"track"}, {"--iso", "0.1"}))["image_dim"], 4);
  EXPECT_EQ(run(of_frames({"slice"}, {"--iso", "0.1", "--at", "t=5.5", "-o", path("cut.ply")}))["simplices"],
            run({"slice", whole_, "--iso", "0.1", "--at", "t=5.5", "-o", path("whole.ply")})["simplices"]);
  for (const char* const command : {"elements", "project", "simplify"}) {
    std::vector<std::string> more = {"--iso", "0.1", "-o", path("out.vtkhdf")};
    if (command == std::string("elements")) more.back() = path("out.dat");
    if (command == std::string("simplify")) more.insert(more.end(), {"--ratio", "0.5"});
    EXPECT_EQ(run(of_frames({command}, more))["input"].size(), 12U) << command;
  }
  EXPECT_EQ(run(of_frames({"index"}, {"-o", path("series.tindex")}))["image_dim"], 4);
  run(of_frames({"contour"}, {"--iso", "0.1", "--index", path("series.tindex"), "-o", path("indexed.vtkhdf")}));
}

TEST_F(SeriesCommand, IsOneContourEachInAPageUnlessOneImageIsAskedFor) {
  const RunResult each = run_tegl({"view", frames_[0], frames_[1], "--iso", "0.1", "-o", path("a.html"), "--json"});
  if (each.exit == 6) GTEST_SKIP() << "no viewer in this build";
  EXPECT_EQ(each.json()["files"].size(), 2U);
  const nlohmann::json one = run(of_frames({"view"}, {"--one-image", "--iso", "0.1", "-o", path("b.html")}));
  ASSERT_EQ(one["files"].size(), 1U);
  EXPECT_EQ(one["files"][0]["image_dim"], 4);
}

TEST_F(SeriesCommand, InTheOrderOfAShellIsRefusedUnlessThatIsSaid) {
  sort_as_shells_do();
  const std::vector<std::string> more = {"--iso", "0.1", "-o", path("series.vtkhdf")};
  expect_refused(2, of_frames({"contour"}, more), {"frame_11.nrrd comes before", "frame_2.nrrd", "--sort name"});
  run({"contour", whole_, "--iso", "0.1", "-o", path("whole.vtkhdf")});
  run(of_frames({"contour", "--sort", "name"}, more));
  expect_same_mesh("whole.vtkhdf", "series.vtkhdf");
  run(of_frames({"contour", "--sort", "given"}, more));
  EXPECT_NE(read_mesh(path("whole.vtkhdf")).coordinates, read_mesh(path("series.vtkhdf")).coordinates);
}

/// A tetrahedron with these values at its points.
std::string tetrahedron_file(const std::string& values) {
  const std::string array = "<DataArray format=\"ascii\" type=";
  return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
         "NumberOfCells=\"1\"><Points>" +
         array + "\"Float64\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells>" + array +
         "\"Int64\" Name=\"connectivity\">0 1 2 3</DataArray>" + array + "\"Int64\" Name=\"offsets\">4</DataArray>" +
         array + "\"UInt8\" Name=\"types\">10</DataArray></Cells><PointData>" + array + "\"Float64\" Name=\"f\">" +
         values + "</DataArray></PointData></Piece></UnstructuredGrid></VTKFile>";
}

TEST_F(SeriesCommand, OfMeshesIsSortedLikeOneOfImages) {
  const std::string ten = write("step_10.vtu", tetrahedron_file("4 -1 -1 -1")),
                    two = write("step_2.vtu", tetrahedron_file("1 -1 -1 -2")),
                    nine = write("step_9.vtu", tetrahedron_file("-1 2 -1 -1"));
  const auto contour = [&](std::vector<std::string> files, const std::vector<std::string>& more, const char* to) {
    files.insert(files.begin(), "contour");
    files.insert(files.end(), {"--iso", "0", "-o", path(to)});
    files.insert(files.end(), more.begin(), more.end());
    return files;
  };
  run(contour({two, nine, ten}, {"--time-step", "0.5"}, "ordered.vtkhdf"));
  const nlohmann::json in_order = {two, nine, ten};
  EXPECT_EQ(run(contour({ten, two, nine}, {"--time-step", "0.5", "--sort", "name"}, "by_name.vtkhdf"))["input"],
            in_order);
  expect_same_mesh("ordered.vtkhdf", "by_name.vtkhdf");
  EXPECT_EQ(run(contour({ten, two, nine}, {"--times", "1,0,0.5", "--sort", "time"}, "by_time.vtkhdf"))["input"],
            in_order);
  EXPECT_EQ(run({"measure", ten, two, nine, "--times", "1,0,0.5", "--sort", "time", "--iso", "0"})["input"], in_order);
  EXPECT_EQ(run({"slice", ten, two, nine, "--sort", "name", "--iso", "0", "--at", "t=0.5", "-o",
                 path("cut.vtkhdf")})["input"],
            in_order);
  expect_same_mesh("ordered.vtkhdf", "by_time.vtkhdf");
  expect_refused(2, contour({ten, two, nine}, {}, "out.vtkhdf"), {"as shells list names", "--sort name"});
  run(contour({ten, two, nine}, {"--sort", "given"}, "given.vtkhdf"));
  expect_refused(2, contour({ten, two}, {"--sort", "time", "--time-step", "1"}, "out.vtkhdf"),
                 {"--sort time", "--time-step", "--times"});
  expect_refused(2, contour({ten, two}, {"--sort", "time"}, "out.vtkhdf"), {"step_10.vtu", "--sort time", "--times"});
  expect_refused(2, contour({ten}, {"--sort", "name"}, "out.vtkhdf"), {"--sort name", "one mesh"});
  expect_refused(2, {"info", ten, "--sort", "name"}, {"--sort"});
}

TEST_F(SeriesCommand, LiesAtTheTimesThatAreGiven) {
  const nlohmann::json step = run(of_frames({"info", "--time-step", "0.25", "--time-unit", "s"}, {}))["axes"][3];
  EXPECT_EQ(step["step"], 0.25);
  EXPECT_EQ(step["unit"], "s");
  EXPECT_EQ(run(of_frames({"info", "--times", "1:12:12"}, {}))["axes"][3]["last"], 12);
  EXPECT_EQ(run(of_frames({"info", "--times", "0,1,2,3,4,5,6,7,8,9,10,20"}, {}))["axes"][3]["coordinates"][11], 20);
  expect_refused(2, of_frames({"info", "--times", "0,1"}, {}), {"--times has 2 numbers for 12 files"});
  expect_refused(2, of_frames({"info", "--time-step", "1e-320"}, {}), {"--time-step is 1e-320"});
  expect_refused(2, of_frames({"info", "--series", "foo"}, {}), {"--series foo", "no DICOM", "--var"});
  expect_refused(2, of_frames({"info", "--times", "0:1:12", "--time-step", "1"}, {}), {"one of the two"});
  expect_refused(2, of_frames({"info", "--time-step", "none"}, {}), {"--time-step", "none"});
  expect_refused(2, of_frames({"info", "--time-step", "0"}, {}), {"--time-step is 0"});
  expect_refused(2, of_frames({"info", "--time-step", "1", "--sort", "time"}, {}), {"--sort time", "--time-step"});
  expect_refused(2, {"info", whole_, "--times", "1"}, {"--times with one file", whole_});
}

TEST_F(SeriesCommand, TimesGoWithTheFilesAsListedAndInputIsTheOrderRead) {
  run({"contour", whole_, "--iso", "0.1", "-o", path("whole.vtkhdf")});
  const std::vector<std::string> in_order = frames_;
  std::reverse(frames_.begin(), frames_.end());
  for (const char* const sort : {"name", "time"}) {
    for (const char* const stream : {"--no-check", "--stream"}) {
      const nlohmann::json report = run(of_frames({"contour", "--times", "11:0:12", "--sort", sort, stream},
                                                  {"--iso", "0.1", "-o", path("series.vtkhdf")}));
      EXPECT_EQ(report["input"], in_order) << sort << stream;
      expect_same_mesh("whole.vtkhdf", "series.vtkhdf");
    }
    EXPECT_EQ(run(of_frames({"info", "--times", "11:0:12", "--sort", sort}, {}))["input"], in_order);
    EXPECT_EQ(run(of_frames({"measure", "--times", "11:0:12", "--sort", sort}, {"--iso", "0.1"}))["input"], in_order);
  }
  const nlohmann::json listed = run(of_frames({"info", "--times", "11:0:12", "--sort", "given"}, {}));
  EXPECT_EQ(listed["input"], frames_);
  EXPECT_EQ(listed["axes"][3]["first"], 11);
  expect_refused(2, of_frames({"info", "--times", "3,2,1,0,4,5,6,7,8,9,10,11", "--sort", "name"}, {}),
                 {"lies at 1 by", frames_[2], frames_[3] + " at 0", "--times", "--sort name"});
}

TEST_F(SeriesCommand, IsSlicedFromTheFilesBesideTheCutOnly) {
  run({"slice", whole_, "--iso", "0.1", "--at", "t=4.5", "-o", path("whole.ply")});
  run({"slice", whole_, "--iso", "0.1", "--at", "t=4.5", "--normals", "-o", path("whole_normals.ply")});
  const std::vector<std::string> sound = frames_;
  // Text that is no numbers: found only when the values are read.
  std::string garbage;
  for (int i = 0; i < 1000; ++i) garbage += "garbage ";
  const auto damage = [&](const std::set<std::size_t>& kept) {
    for (std::size_t k = 0; k < frames_.size(); ++k)
      if (!kept.contains(k))
        frames_[k] = write("damaged_" + std::to_string(k) + ".nrrd",
                           "NRRD0004\ntype: float\ndimension: 3\nsizes: 10 10 10\nencoding: ascii\n\n" + garbage);
  };
  const auto slice = [&](const std::string& at, const std::string& to, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"--iso", "0.1", "--at", at, "-o", path(to)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return of_frames({"slice", "--sort", "given"}, arguments);
  };
  damage({4, 5});
  run(slice("t=4.5", "series.ply"));
  expect_same_mesh("whole.ply", "series.ply");
  expect_refused(4, slice("t=4", "none.ply"), {frames_[3], "garbage"});
  expect_refused(4, slice("t=4.5", "none.ply", {"--normals"}), {frames_[3], "garbage"});
  expect_refused(4, slice("t=4.5,7.5", "none_{t}.ply"), {frames_[7], "garbage"});
  // Whether an isovalue lies outside of the values may depend on all files.
  expect_refused(4, of_frames({"slice", "--sort", "given"}, {"--iso", "1000", "--at", "t=4.5", "-o", path("none.ply")}),
                 {frames_[0], "garbage"});
  run(of_frames({"slice", "--sort", "given", "--allow-empty"},
                {"--iso", "1000", "--at", "t=4.5", "-o", path("empty.ply")}));
  frames_ = sound;
  damage({3, 4, 5, 6});
  run(slice("t=4.5", "series_normals.ply", {"--normals"}));
  expect_same_mesh("whole_normals.ply", "series_normals.ply");
  EXPECT_EQ(read_mesh(path("whole_normals.ply")).normals, read_mesh(path("series_normals.ply")).normals);
}

TEST_F(SeriesCommand, OfFilesThatDoNotFitFailsNamingTheFileAndLeavesNothing) {
  frames_[7] = write("frame_7.nrrd", nrrd_bytes(ball({10, 10, 9}, 3)));
  const auto before = files();
  for (const char* const stream : {"--no-check", "--stream"})
    expect_refused(4, of_frames({"contour"}, {"--iso", "0.1", stream, "-o", path("out.vtkhdf")}),
                   {frames_[7] + ": has 10 x 10 x 9 samples; expected 10 x 10 x 10, as " + frames_[0]});
  EXPECT_EQ(files(), before);
}

TEST_F(SeriesCommand, OfRawFilesIsReadInMemoryAndStreamed) {
  std::vector<std::string> raws;
  for (std::size_t k = 0; k < 12; ++k) {
    const Samples one = layer(balls_, k);
    raws.push_back(write("raw_" + std::to_string(k) + ".raw",
                         {reinterpret_cast<const char*>(one.values.data()), one.values.size() * sizeof(float)}));
  }
  frames_ = raws;
  run({"contour", whole_, "--iso", "0.1", "-o", path("whole.vtkhdf")});
  run(of_frames({"contour", "--raw", "10x10x10", "--raw-type", "float"}, {"--iso", "0.1", "-o", path("raw.vtkhdf")}));
  const Mesh whole = read_mesh(path("whole.vtkhdf"));
  EXPECT_EQ(whole.coordinates, read_mesh(path("raw.vtkhdf")).coordinates);
  EXPECT_EQ(run(of_frames({"info", "--raw", "10x10x10", "--raw-type", "float"}, {}))["axes"][3]["size"], 12);
  EXPECT_EQ(run({"info", "--raw", "10x10x10", "--raw-type", "float", raws[0]})["image_dim"], 3);
}

TEST_F(SeriesCommand, OfASavedContourIsRefused) {
  run({"contour", whole_, "--iso", "0.1", "-o", path("saved.vtkhdf")});
  expect_refused(2, {"measure", path("saved.vtkhdf"), path("saved.vtkhdf")}, {"saved contour", "one of 2 files"});
  expect_refused(2, {"measure", path("saved.vtkhdf"), "--time-step", "2"}, {"saved contour", "--time-step"});
}

TEST_F(SeriesCommand, IsNeverItsOwnOutput) {
  std::vector<std::string> more = {"--iso", "0.1", "-o", frames_[3]};
  expect_refused(6, of_frames({"contour"}, more), {frames_[3]});
  const std::string link = path("link.vtkhdf");
  std::filesystem::create_symlink(frames_[3], link);
  expect_refused(6, of_frames({"contour"}, {"--iso", "0.1", "-o", link}), {link, "is the input itself"});
}

}  // namespace
}  // namespace tegl::test
