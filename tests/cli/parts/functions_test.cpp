// SPDX-License-Identifier: BSD-3-Clause
//
// Unit tests of the program's functions: numbers, cuts, output paths, exit codes.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/exit_codes.hpp"
#include "base/numbers.hpp"
#include "base/printable.hpp"
#include "base/progress.hpp"
#include "base/suggestions.hpp"
#include "base/table.hpp"
#include "input/cuts.hpp"
#include "output/output.hpp"
#include "output/result.hpp"
#include "view/view_page.hpp"

namespace tegl::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// The error thrown by a call; fails the test if there is none.
template <class Call>
Error error_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error";
  return {ErrorCode::Cancelled, ""};
}

TEST(Numbers, AreReadWholeOrNotAtAll) {
  EXPECT_EQ(parse_number("7.3"), 7.3);
  EXPECT_EQ(parse_number("-4e2"), -400.0);
  EXPECT_EQ(parse_number("+1"), 1.0);
  EXPECT_EQ(parse_number("-1e400"), -INFINITY);
  EXPECT_EQ(parse_number("1e-400"), 0.0);
  EXPECT_TRUE(std::isnan(parse_number("nan").value()));
  for (const char* text : {"", "abc", "7.3x", "7,3", "1 2", "+-1", "--1", "0x10", " 1"}) {
    EXPECT_FALSE(parse_number(text).has_value()) << text;
  }
}

TEST(Numbers, MustBeFiniteWhereAValueIsExpected) {
  EXPECT_EQ(parse_finite("--iso", "20"), 20.0);
  for (const char* text : {"nan", "inf", "-inf", "1e999", "abc"}) {
    const Error error = error_of([&] { (void)parse_finite("--iso", text); });
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr(text));
    EXPECT_THAT(error.what(), HasSubstr("--iso"));
  }
}

TEST(Numbers, AreShownShort) {
  EXPECT_EQ(number(20.5), "20.5");
  EXPECT_EQ(number(static_cast<double>(20.1f)), "20.1");
  EXPECT_EQ(number(-400), "-400");
  EXPECT_EQ(grouped(7), "7");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1 000");
  EXPECT_EQ(grouped(1234567), "1 234 567");
  EXPECT_EQ(counted(1, "vertex", "vertices"), "1 vertex");
  EXPECT_EQ(counted(0, "vertex", "vertices"), "0 vertices");
  EXPECT_EQ(byte_size(812), "812 B");
  EXPECT_EQ(byte_size(3400000), "3.4 MB");
  EXPECT_EQ(byte_size(999999), "1.0 MB");
}

TEST(Numbers, BesideOthersLookDifferentWhereTheyAre) {
  EXPECT_THAT(numbers_apart({20, 0.5, static_cast<double>(20.1f)}), ElementsAre("20", "0.5", "20.1"));
  const auto floats = std::vector<double>{101325, 101324, static_cast<double>(101324.6f)};
  EXPECT_THAT(numbers_apart(floats), ElementsAre("101325", "101324", "101324.6"));
  EXPECT_THAT(numbers_apart({static_cast<double>(101324.6f), static_cast<double>(101324.9f)}),
              ElementsAre("101324.6", "101324.9"));
  EXPECT_THAT(numbers_apart({101325.55, static_cast<double>(101323.9f), 101325.5}),
              ElementsAre("101325.55", "101323.9", "101325.5"));
  EXPECT_THAT(numbers_apart({90000, static_cast<double>(101323.9f), 101325.5}),
              ElementsAre("90000", "101324", "101325.5"));
  const double next = std::nextafter(0.1, 1.0);
  EXPECT_THAT(numbers_apart({0.1, next}), ElementsAre("0.1", "0.10000000000000002"));
  EXPECT_THAT(numbers_apart({1.0 / 3.0, 1.0 / 3.0}), ElementsAre("0.333333", "0.333333"));
  EXPECT_THAT(numbers_apart({}), ElementsAre());
}

TEST(Cuts, AreReadFromSeveralValuesAndLists) {
  const std::vector<Cut> cuts = parse_cuts({"t=7.3", "TIME=1,2.50"});
  ASSERT_EQ(cuts.size(), 3u);
  EXPECT_EQ(cuts[0].axis, "t");
  EXPECT_EQ(cuts[0].value, 7.3);
  EXPECT_EQ(cuts[2].axis, "TIME");
  EXPECT_EQ(cuts[2].value, 2.5);
  EXPECT_EQ(cuts[2].text, "2.50");
}

TEST(Cuts, OtherTextIsRefusedAndQuoted) {
  for (const char* text :
       {"7.3", "t", "t=", "=7", "t=a", "t=1,", "t=nan", "t=1,,2", "t=0:1", "t=0:1:1", "t=0:1:2.5", "t=0:1:2:3"}) {
    const Error error = error_of([&] { (void)parse_cuts({text}); });
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr(text));
  }
}

TEST(Cuts, ARangeHasItsEndsAndCount) {
  const std::vector<Cut> cuts = parse_cuts({"t=0.1:0.7:4,5"});
  ASSERT_EQ(cuts.size(), 5u);
  EXPECT_EQ(cuts[0].value, 0.1);
  EXPECT_EQ(cuts[1].value, 0.3) << "and not its neighbour";
  EXPECT_EQ(cuts[3].value, 0.7);
  EXPECT_EQ(cuts[3].text, "0.7");
  EXPECT_EQ(cuts[4].value, 5.0);
}

TEST(Cuts, ARangeHasTheNumbersThatAreMeant) {
  EXPECT_THAT(parse_numbers("--iso", "1:6:6"), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(parse_numbers("--iso", "-0.1:0.2:4"), ElementsAre(-0.1, 0, 0.1, 0.2));
  EXPECT_THAT(parse_numbers("--iso", "101325:101325.4:5"), ElementsAre(101325, 101325.1, 101325.2, 101325.3, 101325.4));
  EXPECT_THAT(parse_numbers("--iso", "0:1:4"), ElementsAre(0, 1.0 / 3, 2.0 / 3, 1));
  EXPECT_THAT(parse_numbers("--iso", "6:1:3"), ElementsAre(6, 3.5, 1));
  EXPECT_THAT(parse_numbers("--iso", "-1.5e308:1.5e308:3"), ElementsAre(-1.5e308, 0, 1.5e308));
  EXPECT_THAT(parse_numbers("--iso", "1e-10:1e6:3"), ElementsAre(1e-10, 500000, 1e6)) << "ends are as they are";
  EXPECT_THAT(parse_numbers("--iso", "0.30000000000000004:1:2"), ElementsAre(0.30000000000000004, 1));
  for (const double number : parse_numbers("--iso", "-1e308:1e308:21")) EXPECT_TRUE(std::isfinite(number));
  const std::vector<double> whole = parse_numbers("--iso", "-1000:1000:2001");
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_EQ(whole[i], static_cast<double>(i) - 1000);
  const std::vector<double> tenths = parse_numbers("--iso", "0:100:1001");
  for (std::size_t i = 0; i < tenths.size(); ++i)
    EXPECT_EQ(tenths[i], std::stod(std::to_string(i / 10) + "." + std::to_string(i % 10)));
}

TEST(Cuts, ARangeIsSpelledApart) {
  const auto texts = [](std::string_view range) {
    std::vector<std::string> all;
    for (const SpelledNumber& number : parse_spelled_numbers("--iso", range)) all.push_back(number.text);
    return all;
  };
  EXPECT_THAT(texts("101325:101325.4:3"), ElementsAre("101325", "101325.2", "101325.4"));
  EXPECT_THAT(texts("0:1:4"), ElementsAre("0", "0.333333", "0.666667", "1"));
  const auto fine = texts("1000000:1000000.001:4");
  EXPECT_EQ(std::set(fine.begin(), fine.end()).size(), 4U) << fine[1] << " " << fine[2];
}

TEST(Cuts, HaveAnOutputEach) {
  const std::vector<Cut> cuts = parse_cuts({"TIME=1,2.50"});
  EXPECT_THAT(cut_outputs("a_{t}.ply", cuts), ElementsAre("a_1.ply", "a_2.50.ply"));
  EXPECT_THAT(cut_outputs("{TIME}/{t}.ply", cuts), ElementsAre("1/1.ply", "2.50/2.50.ply"));
  EXPECT_THAT(cut_outputs("{n}_{t}_{n}.ply", cuts), ElementsAre("1_1_1.ply", "2_2.50_2.ply"));
  EXPECT_EQ(error_of([&] { (void)cut_outputs("a.ply", cuts); }).code(), ErrorCode::InvalidArgument);
  EXPECT_EQ(error_of([&] { (void)cut_outputs("{t}.ply", parse_cuts({"t=1,1"})); }).code(), ErrorCode::InvalidArgument);
}

TEST(Cuts, AreNumberedSoThatTheirNamesSort) {
  for (const std::size_t count : {2U, 9U, 10U, 100U, 101U, 1000U}) {
    std::vector<std::string> outputs = cut_outputs("film_{n}.glb", parse_cuts({fmt::format("t=0:1000:{}", count)}));
    ASSERT_EQ(outputs.size(), count);
    EXPECT_EQ(outputs.back(), fmt::format("film_{}.glb", count));
    EXPECT_EQ(outputs.front().size(), outputs.back().size());
    EXPECT_TRUE(std::is_sorted(outputs.begin(), outputs.end())) << count;
  }
  // Cuts of several directions. An axis of that name has priority over the cut's number.
  EXPECT_THAT(cut_outputs("{n}.ply", parse_cuts({"t=1", "x=5,1"})), ElementsAre("1.ply", "2.ply", "3.ply"));
  EXPECT_THAT(cut_outputs("{n}.ply", parse_cuts({"n=7,5"})), ElementsAre("7.ply", "5.ply"));
}

TEST(Isovalues, HaveAnOutputEach) {
  const std::vector<SpelledNumber> isovalues = {{20, "20"}, {5, "5.0"}};
  EXPECT_THAT(isovalue_outputs("a.ply", isovalues), ElementsAre("a_20.ply", "a_5.0.ply"));
  EXPECT_THAT(isovalue_outputs("a_{n}.ply", isovalues), ElementsAre("a_1.ply", "a_2.ply"));
  EXPECT_THAT(isovalue_outputs("{iso}/{n}.ply", isovalues), ElementsAre("20/1.ply", "5.0/2.ply"));
  EXPECT_THAT(isovalue_outputs("a.ply", std::vector<SpelledNumber>{{20, "20"}}), ElementsAre("a.ply"));
}

TEST(Output, SimplicesAreNamedByTheirDimension) {
  const std::vector<std::pair<std::string, std::string>> names = {{"1 point", "2 points"},
                                                                  {"1 segment", "2 segments"},
                                                                  {"1 triangle", "2 triangles"},
                                                                  {"1 tetrahedron", "2 tetrahedra"},
                                                                  {"1 4-simplex", "2 4-simplices"}};
  for (int dim = 0; dim < 5; ++dim) {
    EXPECT_EQ(counted_simplices(dim, 1), names[static_cast<std::size_t>(dim)].first);
    EXPECT_EQ(counted_simplices(dim, 2), names[static_cast<std::size_t>(dim)].second);
  }
  EXPECT_THAT(error_of([] { require_output_holds("a.ply", 3); }).what(),
              HasSubstr("4D contour (tetrahedra in 4D space)"));
  EXPECT_THAT(error_of([] { require_output_holds("a.ply", 4); }).what(),
              HasSubstr("5D contour (4-simplices in 5D space)"));
}

TEST(Output, FormatsHoldTheDimensionsThatTheyHold) {
  for (const char* name : {"a.ply", "a.gltf", "a.glb", "a.obj", "a.vtkhdf", "A.PLY"}) {
    EXPECT_NO_THROW(require_output_holds(name, 1)) << name;
    EXPECT_NO_THROW(require_output_holds(name, 2)) << name;
  }
  EXPECT_NO_THROW(require_output_holds("a.stl", 2));
  EXPECT_NO_THROW(require_output_holds("a.vtkhdf", 3));
  for (const char* name : {"a.ply", "a.gltf", "a.glb", "a.stl", "a.obj"}) {
    const Error error = error_of([&] { require_output_holds(name, 3); });
    EXPECT_EQ(error.code(), ErrorCode::WriteFailed);
    EXPECT_THAT(error.what(), HasSubstr("expected .vtkhdf, or a surface: slice the contour first ('tegl slice')"));
  }
  const Error lines = error_of([] { require_output_holds("a.stl", 1); });
  EXPECT_EQ(lines.code(), ErrorCode::WriteFailed);
  EXPECT_THAT(lines.what(), HasSubstr("'.stl' cannot hold a 2D contour, which is made of lines; expected .ply"));
}

TEST(Output, WhatOptionsAskForIsNotLeftOut) {
  for (const char* name : {"a.vtkhdf", "a.ply", "a.glb"})
    for (const char* normals : {"", "gradient", "geometric", "flat"})
      EXPECT_NO_THROW(require_output_keeps(name, normals, true)) << name;
  for (const char* name : {"a.stl", "a.obj"}) {
    EXPECT_NO_THROW(require_output_keeps(name, "", false));
    EXPECT_THAT(error_of([&] { require_output_keeps(name, "", true); }).what(), HasSubstr("cannot hold attributes"));
  }
  // STL stores normals of facets, OBJ normals of vertices.
  EXPECT_NO_THROW(require_output_keeps("a.stl", "flat", false));
  EXPECT_NO_THROW(require_output_keeps("a.obj", "sobel", false));
  const Error error = error_of([] { require_output_keeps("A.STL", "gradient", false); });
  EXPECT_EQ(error.code(), ErrorCode::WriteFailed);
  EXPECT_THAT(error.what(), HasSubstr("'.stl' cannot hold normals of vertices; expected .vtkhdf, .ply, .obj"));
  EXPECT_THAT(error_of([] { require_output_keeps("a.obj", "flat", false); }).what(),
              HasSubstr("normals of triangles; expected .vtkhdf, .ply with --normals flat"));
}

TEST(Output, TheDimensionsThatAreAllowedCanBeWritten) {
  // The table of formats must agree with the writers.
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir());
  for (const char* extension : {".ply", ".gltf", ".glb", ".vtkhdf", ".stl", ".obj"}) {
    for (int dim = 1; dim <= 3; ++dim) {
      const std::filesystem::path path = folder / (std::string("tegl_writable_") + std::to_string(dim) + extension);
      Mesh mesh;
      mesh.dim = dim;
      mesh.space_dim = dim + 1;
      const auto points = static_cast<std::size_t>(dim + 1);
      mesh.coordinates.assign(points * points, 0.0);
      for (std::size_t i = 0; i < points; ++i) mesh.coordinates[i * points + i] = 1.0;
      for (Index i = 0; i < points; ++i) mesh.simplices.push_back(i);
      bool allowed = true;
      try {
        require_output_holds(path, dim);
      } catch (const Error&) {
        allowed = false;
      }
      if (allowed) {
        EXPECT_GT(write_file(path, [&] { write_mesh(mesh, path); }), 0u) << path;
      } else {
        EXPECT_EQ(error_of([&] { write_file(path, [&] { write_mesh(mesh, path); }); }).code(), ErrorCode::WriteFailed)
            << path;
      }
      EXPECT_EQ(std::filesystem::exists(path), allowed) << path;
      std::filesystem::remove(path);
    }
  }
}

TEST(Output, IsLookedAtBeforeTheWork) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "tegl_output_test";
  std::filesystem::create_directories(folder);
  const std::filesystem::path input = folder / "input.ply";
  std::ofstream(input) << "x";
  const auto message = [&](const std::filesystem::path& path) {
    const Error error = error_of([&] { require_output(path, {input}); });
    EXPECT_EQ(error.code(), ErrorCode::WriteFailed);
    EXPECT_THAT(error.what(), HasSubstr(path.string()));
    return std::string(error.what());
  };
  EXPECT_NO_THROW(require_output(folder / "out.glb", {input}));
  EXPECT_NO_THROW(require_output("out.glb", {input}));
  EXPECT_THAT(message(folder / "out.xyz"), HasSubstr(".xyz"));
  EXPECT_THAT(message(folder / "out"), HasSubstr("no extension"));
  EXPECT_THAT(message(folder / "none" / "out.ply"), HasSubstr("does not exist"));
  EXPECT_THAT(message(input / "out.ply"), HasSubstr("not a folder"));
  EXPECT_THAT(message(input), HasSubstr("input"));
  std::filesystem::create_directories(folder / "folder.ply");
  EXPECT_THAT(message(folder / "folder.ply"), HasSubstr("directory"));
  std::filesystem::remove_all(folder);
}

TEST(Faults, AreThoseOfManifoldnessAlone) {
  MeshReport report;
  report.dim = 2;
  report.boundary_simplices = 3;
  report.degenerate_simplices = 4;
  EXPECT_FALSE(has_faults(report));
  for (const auto member : {&MeshReport::nonmanifold_simplices, &MeshReport::bad_links,
                            &MeshReport::orientation_conflicts, &MeshReport::nonfinite_vertices}) {
    MeshReport faulty = report;
    faulty.*member = 1;
    EXPECT_TRUE(has_faults(faulty));
  }
}

TEST(Faults, TextThatIsNoUtf8StillMakesJson) {
  Json json;
  json["unit"] = "\xb0\x43";  // degree sign in Latin-1
  EXPECT_TRUE(nlohmann::json::accept(dump(json)));
}

TEST(ExitCodes, AreAsDocumented) {
  EXPECT_EQ(static_cast<int>(exit_code(ErrorCode::InvalidArgument)), 2);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorCode::VariableNotFound)), 2);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorCode::FileNotFound)), 3);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorCode::MalformedFile)), 4);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorCode::UnsupportedData)), 4);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorCode::WriteFailed)), 6);
  EXPECT_EQ(static_cast<int>(exit_code(ErrorCode::Cancelled)), 130);
  for (const char* code : {"0 ", "1 ", "2 ", "3 ", "4 ", "5 ", "6 ", "70 ", "130 "}) {
    EXPECT_THAT(exit_code_help(), HasSubstr(std::string("\n  ") + code));
  }
}

TEST(Printable, LeavesTextAloneAndEscapesWhatIsNoneInIt) {
  for (const char* const text : {"", "plain text", "C:\\x1b",
                                 "\xc2\xb0"
                                 "C",
                                 "\xe6\xb5\xb7", "\xf0\x9f\x8c\x8a", "\xc2\xa0", "\xef\xbf\xbd", "\xf4\x8f\xbf\xbf"})
    EXPECT_EQ(printable(text), text);
  EXPECT_EQ(printable(std::string_view("\0\t\n\r\x1b\x7f", 6)), "\\x00\\x09\\x0a\\x0d\\x1b\\x7f");
  // C1 control characters as UTF-8, and as bytes of Latin-1.
  EXPECT_EQ(printable("\xc2\x80\xc2\x9b\xc2\x9f"), "\\u0080\\u009b\\u009f");
  EXPECT_EQ(printable("\x9b"
                      "31m\xb0"),
            "\\x9b31m\\xb0");
  // Direction marks, separators of lines and paragraphs.
  EXPECT_EQ(
      printable(
          "\xd8\x9c\xe2\x80\x8e\xe2\x80\x8f\xe2\x80\xa8\xe2\x80\xa9\xe2\x80\xaa\xe2\x80\xae\xe2\x81\xa6\xe2\x81\xa9"),
      "\\u061c\\u200e\\u200f\\u2028\\u2029\\u202a\\u202e\\u2066\\u2069");
  // Overlong, a surrogate, beyond Unicode, truncated, a continuation byte only.
  EXPECT_EQ(printable("\xc0\x9b"), "\\xc0\\x9b");
  EXPECT_EQ(printable("\xe0\x80\x9b"), "\\xe0\\x80\\x9b");
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
  EXPECT_EQ(printable("a\xe6\xb5"), "a\\xe6\\xb5");
  EXPECT_EQ(printable("\x80"), "\\x80");
}

TEST(Printable, JsonIsAsJsonHasItAndReadsBackTheSame) {
  Json json;
  json["text"] = "\x1b\x7f\xc2\x9b\xe2\x80\xae\n\xe6\xb5\xb7";
  const std::string text = dump(json);
  EXPECT_THAT(text, HasSubstr("\\u001b\\u007f\\u009b\\u202e\\n\xe6\xb5\xb7"));
  EXPECT_EQ(Json::parse(text), json);
}

TEST(Printable, IsWhatReportsAndTablesShow) {
  EXPECT_EQ(report_line("a\x1b", "b\n\x9b"), "  a\\x1b        b\\x0a\\x9b\n");
  const Table table{{"x\x1b", "y"}, {{"1", "\x07"}}};
  EXPECT_EQ(table.to_text(1), "  x\\x1b     y\n      1  \\x07\n");
  EXPECT_EQ(Console(stderr).bold("\x1b"), "\\x1b");
}

TEST(Suggestions, AreTheNearestWords) {
  const std::vector<std::string> words = {"--iso", "--output", "-o", "--triangulation", "--precision", "--threads"};
  EXPECT_EQ(nearest_word("--isovalue", words), "--iso");
  EXPECT_EQ(nearest_word("--thread", words), "--threads");
  EXPECT_EQ(nearest_word("--otuput", words), "--output");
  EXPECT_EQ(nearest_word("--triangluation", words), "--triangulation");
  EXPECT_EQ(nearest_word("--precison", words), "--precision");
  EXPECT_EQ(nearest_word("--x", words), std::nullopt);
  EXPECT_EQ(nearest_word("--colour", words), std::nullopt);
}

TEST(ViewLimit, LetsALargeComponentInWithoutTheOthers) {
  // Two components: fans of 5 and of 2 triangles.
  Contour<3, double> fans;
  for (Index v = 0; v < 20; ++v) fans.vertices.push_back({double(v), double(v * v % 7), 1.0});
  for (Index v = 1; v < 6; ++v) fans.simplices.push_back({0, v, v + 1});
  for (Index v = 11; v < 13; ++v) fans.simplices.push_back({10, v, v + 1});
  const auto kept = [&](const ViewLimit& limit) {
    Contour<3, double> contour = fans;
    const Thinned thinned = thin(contour, limit, WorkOptions{});
    EXPECT_EQ(contour.simplices.size(), thinned.simplices);
    return thinned.simplices;
  };
  EXPECT_EQ(kept({7, 7}), 7U);
  EXPECT_EQ(kept({6, 6}), 5U);
  EXPECT_EQ(kept({3, 100}), 5U) << "the largest one, beyond what several may have";
  EXPECT_EQ(kept({0, 0}), 7U);
  const Error error = error_of([&] { kept({3, 4}); });
  EXPECT_EQ(error.code(), ErrorCode::TooLarge);
  EXPECT_THAT(error.what(), HasSubstr("5 triangles; expected at most 4: --limit 5 shows it"));
}

TEST(ProgressBar, EstimatesTheTimeLeft) {
  EXPECT_EQ(time_left(1.0, 0.5), "");
  EXPECT_EQ(time_left(60.0, 0.001), "");
  EXPECT_EQ(time_left(60.0, 1.0), "");
  EXPECT_EQ(time_left(10.0, 0.25), "30 s left");
  EXPECT_EQ(time_left(60.0, 0.25), "3 min left");
  EXPECT_EQ(time_left(3600.0, 0.3), "2 h 20 min left");
}

TEST(Interrupt, StopsProgressAtTheNextCall) {
  const Console console(stderr);
  const InterruptHandler handler;
  ProgressBar bar(console, false);
  const Progress progress = bar.stage("read");
  EXPECT_TRUE(progress(0.5));
  std::raise(SIGINT);
  EXPECT_FALSE(progress(0.6));
  EXPECT_EQ(error_of([&] { (void)bar.stage("write"); }).code(), ErrorCode::Cancelled);
}

}  // namespace
}  // namespace tegl::cli
