// SPDX-License-Identifier: BSD-3-Clause
//
// The program `gen` run as a process: exit status, output and messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gen_cli.hpp"

namespace tegl::test {
namespace {

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
    EXPECT_EQ(json::parse(run.out), (json{{"tile", "cube"},
                                          {"dim", std::stoi(expected.dim)},
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

TEST(GenCli, TransversalCountsRepresentativesByOrbitLength) {
  const Outcome run = gen({"--dim", "3", "--transversal", "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json found = json::parse(run.out);
  EXPECT_EQ(found["representatives"], 22);
  EXPECT_EQ(found["signatures"], 256);
  EXPECT_EQ(found["orbit_lengths"]["24"], 6);
  EXPECT_EQ(gen({"--dim", "2", "--transversal", "--list"}).out, "0 1\n1 4\n3 4\n6 2\n7 4\n15 1\n");
  EXPECT_THAT(gen({"--dim", "5", "--transversal"}).out, HasSubstr("1228158"));
  EXPECT_EQ(gen({"--dim", "6", "--transversal"}).status, 2);
  EXPECT_EQ(gen({"--dim", "3", "--transversal", "--list", "--json"}).status, 2);
  EXPECT_EQ(gen({"--dim", "3", "--transversal", "--inversion"}).status, 2);
}

// Tables 6.8 and 6.9 of the thesis.
TEST(GenCli, SymmetriesOfTheSquareAreTheThesissTables) {
  const Outcome run = gen({"--dim", "2", "--symmetries", "--group", "rotations"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.out, R"(dimension   2
group       rotations, order 4
generators  rho     quarter turn from x to y

element  kind          fixed  signatures
1        identity         16  {0, 1, ..., 15}
rho      quarter turn      2  {0, 15}
rho^2    half turn         4  {0, 6, 9, 15}
rho^3    quarter turn      2  {0, 15}

24 fixed points in all = 4 elements x 6 classes (Burnside's lemma)

high corners  in all  signature  orbit  order  isotropy group
           0       1          0      1      4  G
           1       4          1      4      1  {1}
           2       6          3      4      1  {1}
           2                  6      2      2  {1, rho^2}
           3       4          7      4      1  {1}
           4       1         15      1      4  G
)");
}

TEST(GenCli, SymmetriesAsJsonHoldAllElementsAndClasses) {
  struct Expected {
    const char* dim;
    const char* group;
    bool inversion;
    std::size_t order, classes;
  };
  for (const Expected& expected :
       {Expected{"2", "full", true, 16, 4}, Expected{"3", "full", false, 48, 22},
        Expected{"3", "rotations", true, 48, 15}, Expected{"4", "rotations", false, 192, 496}}) {
    const Outcome run =
        expected.inversion
            ? gen({"--dim", expected.dim, "--symmetries", "--group", expected.group, "--inversion", "--json"})
            : gen({"--dim", expected.dim, "--symmetries", "--group", expected.group, "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const json table = json::parse(run.out);
    EXPECT_EQ(table.at("group"), expected.group);
    EXPECT_EQ(table.at("inversion"), expected.inversion);
    EXPECT_EQ(table.at("order"), expected.order);
    ASSERT_EQ(table.at("elements").size(), expected.order);
    ASSERT_EQ(table.at("classes").size(), expected.classes);
    std::size_t fixed = 0;
    std::set<std::string> words;
    for (const json& element : table.at("elements")) {
      fixed += element.at("fixed").get<std::size_t>();
      words.insert(element.at("word"));
      EXPECT_EQ(element.contains("signatures"), table.at("dim") != 4);
      EXPECT_EQ(element.at("kind").is_null(), table.at("dim") == 4);
    }
    EXPECT_EQ(fixed, expected.order * expected.classes);
    EXPECT_EQ(fixed, table.at("fixed_sum"));
    EXPECT_EQ(words.size(), expected.order);
    for (const json& found : table.at("classes")) {
      const json& isotropy = found.at("isotropy");
      EXPECT_EQ(isotropy.at("elements").size(), isotropy.at("order"));
      EXPECT_EQ(isotropy.at("order").get<std::size_t>() * found.at("orbit_length").get<std::size_t>(), expected.order);
      for (const json& word : isotropy.at("elements")) EXPECT_TRUE(words.contains(word)) << word;
    }
  }
}

TEST(GenCli, SymmetriesOf4dAreListedByConjugacyClass) {
  const Outcome run = gen({"--dim", "4", "--symmetries"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("154368 fixed points in all = 384 elements x 402 classes"));
  EXPECT_THAT(run.out, HasSubstr("\n+2 +2         +1      2        12        1024  rho_xy^2 rho_xz rho_yt\n"));
  EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), 9 + 1 + 1 + 20 + 3 + 1 + 402);
}

TEST(GenCli, ADimensionWithoutACommandIsCertifiedAndSummarised) {
  const Outcome text = gen({"--dim", "2"});
  EXPECT_EQ(text.status, 0) << text.err;
  for (const char* const line :
       {"2-tile: 4 corners, 16 signatures\n", "      6       4  rotations\n",
        "low         barycentric          16      16             0        16       2       16       128",
        "Every signature is certified, and every pair of neighbours matches.\n",
        "tile2_compact                  flat     16        16       256\n"}) {
    EXPECT_THAT(text.out, HasSubstr(line));
  }
  const Outcome run = gen({"--dim", "3", "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json summary = json::parse(run.out);
  std::vector<int> classes;
  for (const json& group : summary.at("groups")) classes.push_back(group.at("classes"));
  EXPECT_EQ(classes, (std::vector<int>{22, 23, 14, 15}));
  ASSERT_EQ(summary.at("certified").size(), 4U);
  for (const json& figures : summary.at("certified")) {
    EXPECT_EQ(figures.at("passed"), 256);
    EXPECT_EQ(figures.at("embedded_proved"), 256);
    EXPECT_EQ(figures.at("embedded_searched"), 0);
    EXPECT_EQ(figures.at("pairs"), 3 * 16 * 16 * 16);
    EXPECT_EQ(figures.at("unmatched_pairs"), 0);
  }
  std::set<std::string> names;
  for (const json& table : summary.at("tables")) {
    names.insert(table.at("name"));
    EXPECT_GT(table.at("bytes"), table.at("simplices"));
  }
  EXPECT_EQ(names, (std::set<std::string>{"tile3_barycentric", "tile3_compact", "region2_barycentric_low",
                                          "region2_barycentric_high", "region2_compact_low", "region2_compact_high",
                                          "tile3_resolved", "tile3_barycentric_variants", "tile3_compact_variants",
                                          "tile3_barycentric_rows", "tile3_compact_rows"}));
  std::set<std::string> texts;
  for (const json& builder_text : summary.at("builder").at("texts")) texts.insert(builder_text.at("name"));
  EXPECT_EQ(texts, (std::set<std::string>{"builder3.hpp", "builder3.cpp", "builder3.glsl", "builder3.wgsl"}));
  EXPECT_THAT(std::string(summary.at("builder").at("certified")), HasSubstr("656 resolutions of 256 signatures"));
}

TEST(GenCli, FiveDimensionsAreSummarisedWithoutTables) {
  const Outcome text = gen({"--dim", "5"});
  EXPECT_EQ(text.status, 0) << text.err;
  for (const char* const line : {"5-tile: 32 corners, 4294967296 signatures\n", "1228158    3840  all symmetries\n",
                                 "The classes are counted by Burnside's lemma.\n", "200 with random signatures",
                                 "builder5.cpp", "Certified: faces and incidence signs"}) {
    EXPECT_THAT(text.out, HasSubstr(line));
  }
  const Outcome run = gen({"--dim", "5", "--json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const json summary = json::parse(run.out);
  EXPECT_EQ(summary.at("certified_tiles"), 200);
  EXPECT_EQ(summary.at("builder").at("texts").size(), 2U);
}

TEST(GenCli, OtherTilesAreSummarisedWithoutNeighbours) {
  const Outcome run = gen({"--dim", "3", "--tile", "simplex"});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3-simplex: 4 corners, 16 signatures\n"));
  EXPECT_THAT(run.out, HasSubstr("Every signature is certified.\n"));
  EXPECT_THAT(run.out, HasSubstr("simplex3_compact"));
  const Outcome wrong = gen({"--dim", "5", "--tile", "simplex"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, testing::Not(HasSubstr("--transversal")));
}

TEST(GenCli, OptionsMayComeInAnyOrderAndWithEqualsSigns) {
  EXPECT_EQ(gen({"--json", "--group=rotations", "--dim=3", "--inversion", "--count"}).out,
            gen({"--dim", "3", "--count", "--group", "rotations", "--inversion", "--json"}).out);
}

TEST(GenCli, HelpListsCommandsExamplesAndExitCodesAndWinsOverTheRest) {
  const Outcome run = gen({"--help"});
  EXPECT_EQ(run.status, 0);
  EXPECT_EQ(run.err, "");
  for (const char* const text :
       {"--count", "--symmetries", "--classes", "--certify", "--out DIR", "gen --dim N [--tile T] [--json]",
        "--group full|rotations", "examples", "exit status", "--layout class|flat|auto"}) {
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

TEST(GenCli, RefusesNeitherCommandNorDimensionAndSeveralCommands) {
  expect_refused({}, {"no command", "--dim N", "--count", "--help"});
  expect_refused({"--json"}, {"no command", "--dim N", "--count"});
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
  expect_refused({"--dim", "3", "--out", "t", "--language", "json,basic"},
                 {"--language json,basic", "'basic'", "wgsl"});
  expect_refused({"--dim", "3", "--out", "t", "--language", "json,"}, {"--language json,", "''", "cpp"});
  expect_refused({"--dim", "3", "--out", "t", "--language", "glsl,glsl"}, {"glsl twice"});
  expect_refused({"--dim", "3", "--count", "--json=yes"}, {"--json takes no value", "'yes'"});
}

TEST(GenCli, RefusesDimensionsOutsideOfTheCommandsRange) {
  for (const char* const dim : {"-1", "0", "9"}) {
    expect_refused({"--dim", dim, "--count"}, {"--count expects 1 to 8"});
  }
  for (const char* const dim : {"1", "6"})
    expect_refused({"--dim", dim}, {"expected 2 to 5", "--count (1 to 8)", "(2 to 6)"});
  for (const char* const dim : {"1", "5"}) {
    expect_refused({"--dim", dim, "--classes"}, {"--classes expects 2 to 4"});
    expect_refused({"--dim", dim, "--symmetries"}, {"--symmetries expects 2 to 4"});
    expect_refused({"--dim", dim, "--certify"}, {"--certify expects 2 to 4"});
    expect_refused({"--dim", dim, "--out", "tables"}, {"--out expects 2 to 4"});
    expect_refused({"--dim", dim, "--cases", "docs"}, {"--cases expects 2 to 4"});
  }
}

TEST(GenCli, RefusesOptionsThatTheCommandWouldIgnore) {
  expect_refused({"--dim", "3", "--classes", "--inversion"}, {"--inversion does not go with --classes", "--json"});
  expect_refused({"--dim", "3", "--certify", "--group", "full"}, {"--group does not go with --certify"});
  expect_refused({"--dim", "3", "--count", "--layout", "flat"}, {"--layout does not go with --count"});
  expect_refused({"--dim", "3", "--symmetries", "--list"}, {"--list does not go with --symmetries", "--inversion"});
  expect_refused({"--dim", "3", "--symmetries", "--tile", "simplex"}, {"--tile does not go with --symmetries"});
  expect_refused({"--dim", "3", "--inversion"}, {"--inversion without a command", "--tile, --json", "--symmetries"});
  expect_refused({"--dim", "3", "--certify", "--language", "json"}, {"--language does not go with --certify"});
  expect_refused({"--dim", "3", "--out", "tables", "--json"}, {"--json does not go with --out"});
  expect_refused({"--version", "--dim", "3"}, {"--dim does not go with --version", "nothing else"});
}

TEST(GenCli, TheTableByClassHasHolesWithInversionAndNoneWithout) {
  const Outcome marching_cubes =
      gen({"--dim", "3", "--certify", "--group", "rotations", "--inversion", "--table-by-class", "--json"});
  EXPECT_EQ(marching_cubes.status, 4);
  EXPECT_THAT(marching_cubes.err, HasSubstr("leave a hole"));
  const json figures = json::parse(marching_cubes.out);
  EXPECT_EQ(figures.at("classes"), 15);
  EXPECT_EQ(figures.at("pairs"), 3 * 16 * 16 * 16);
  EXPECT_GT(figures.at("unmatched_pairs"), 0);
  const Outcome rotations = gen({"--dim", "3", "--certify", "--group", "rotations", "--table-by-class", "--json"});
  EXPECT_EQ(rotations.status, 0) << rotations.err;
  EXPECT_EQ(json::parse(rotations.out).at("unmatched_pairs"), 0);
  EXPECT_EQ(json::parse(rotations.out).at("classes"), 23);
}

TEST(GenCli, TheTableByClassIsForCertifyInTwoAndThreeDimensions) {
  expect_refused({"--dim", "4", "--certify", "--table-by-class"}, {"--dim 4", "expects 2 or 3"});
  expect_refused({"--dim", "3", "--count", "--table-by-class"}, {"--table-by-class does not go with --count"});
  expect_refused({"--dim", "3", "--certify", "--inversion"}, {"--inversion does not go with --certify without"});
}

TEST(GenCli, AllResolutionsAndSamplesAreCertified) {
  const Outcome all = gen({"--dim", "3", "--certify", "--all", "--json"});
  EXPECT_EQ(all.status, 0) << all.err;
  EXPECT_EQ(json::parse(all.out).at("pairs"), 656);
  const Outcome text = gen({"--dim", "4", "--certify", "--sample", "50"});
  EXPECT_THAT(text.out, HasSubstr("torus"));
  EXPECT_THAT(text.out, HasSubstr("Euler characteristic"));
  const Outcome sample = gen({"--dim", "5", "--certify", "--sample", "3", "--seed", "9", "--threads", "2", "--json"});
  EXPECT_EQ(json::parse(sample.out).at("certified_tiles"), 3);
  EXPECT_EQ(json::parse(sample.out).at("seed"), 9);
  const Outcome all_threads = gen({"--dim", "5", "--certify", "--sample", "3", "--threads", "0", "--json"});
  EXPECT_EQ(all_threads.status, 0) << all_threads.err;
  EXPECT_EQ(json::parse(all_threads.out).at("certified_tiles"), 3);
}

TEST(GenCli, RefusesSamplesThatAreNone) {
  expect_refused({"--dim", "4", "--certify", "--sample", "0"}, {"--sample 0", "from 1 to"});
  expect_refused({"--dim", "4", "--certify", "--sample", "many"}, {"--sample many", "whole number"});
  expect_refused({"--dim", "4", "--certify", "--sample", "5", "--all"}, {"--all and --sample"});
  expect_refused({"--dim", "4", "--certify", "--sample", "99999999999999999999999"}, {"18446744073709551615"});
  expect_refused({"--dim", "5", "--certify"}, {"--dim 5", "2 to 4, with --sample to 6"});
  expect_refused({"--dim", "7", "--certify", "--sample", "5"}, {"--dim 7", "2 to 6"});
  expect_refused({"--dim", "5", "--certify", "--all"}, {"--dim 5", "2 to 4"});
  expect_refused({"--dim", "4", "--certify", "--seed", "5"}, {"--seed", "without --sample"});
  expect_refused({"--dim", "4", "--certify", "--threads", "2"}, {"--threads", "--all or --sample"});
  expect_refused({"--dim", "4", "--certify", "--all", "--threads", "-1"}, {"--threads -1", "from 0 to"});
  expect_refused({"--dim", "3", "--certify", "--all", "--table-by-class"}, {"--all does not go with --table-by-class"});
}

TEST(GenCli, OtherTilesAreCountedAndCertified) {
  struct Expected {
    const char* tile;
    const char* dim;
    int order, orbits, with_inversion, signatures;
  };
  for (const Expected& expected :
       {Expected{"simplex", "2", 6, 4, 2, 8}, Expected{"simplex", "3", 24, 5, 3, 16},
        Expected{"simplex", "4", 120, 6, 3, 32}, Expected{"octahedron", "3", 48, 10, 6, 64}}) {
    const Outcome count = gen({"--tile", expected.tile, "--dim", expected.dim, "--count", "--json"});
    EXPECT_EQ(json::parse(count.out), (json{{"tile", expected.tile},
                                            {"dim", std::stoi(expected.dim)},
                                            {"group", "full"},
                                            {"inversion", false},
                                            {"order", expected.order},
                                            {"orbits", expected.orbits}}));
    const Outcome inverted = gen({"--tile", expected.tile, "--dim", expected.dim, "--count", "--inversion", "--json"});
    EXPECT_EQ(json::parse(inverted.out).at("orbits"), expected.with_inversion);
    const Outcome classes = gen({"--tile", expected.tile, "--dim", expected.dim, "--classes", "--json"});
    EXPECT_EQ(json::parse(classes.out).at("classes").size(), static_cast<std::size_t>(expected.orbits));
    const Outcome certify = gen({"--tile", expected.tile, "--dim", expected.dim, "--certify", "--json"});
    EXPECT_EQ(certify.status, 0) << certify.err;
    const json certified = json::parse(certify.out).at("certified");
    EXPECT_EQ(certified.size(), 4u);
    for (const json& figures : certified) EXPECT_EQ(figures.at("passed"), expected.signatures);
  }
}

TEST(GenCli, MeshCellsAreTiles) {
  struct Expected {
    const char* tile;
    int dim, order, orbits, with_inversion, tori;
    std::uint64_t signatures, pairs;
  };
  for (const Expected& expected :
       {Expected{"wedge", 3, 12, 13, 8, 0, 64, 94}, Expected{"pyramid", 3, 8, 12, 6, 0, 32, 36},
        Expected{"prism:tetrahedron", 4, 48, 22, 14, 0, 256, 594}, Expected{"cross4", 4, 384, 15, 9, 6, 256, 256}}) {
    const json count = json::parse(gen({"--tile", expected.tile, "--count", "--json"}).out);
    EXPECT_EQ(count, (json{{"tile", expected.tile},
                           {"dim", expected.dim},
                           {"group", "full"},
                           {"inversion", false},
                           {"order", expected.order},
                           {"orbits", expected.orbits}}));
    const json inverted = json::parse(gen({"--tile", expected.tile, "--count", "--inversion", "--json"}).out);
    EXPECT_EQ(inverted.at("orbits"), expected.with_inversion) << expected.tile;
    const json certified = json::parse(gen({"--tile", expected.tile, "--certify", "--json"}).out);
    ASSERT_EQ(certified.at("certified").size(), 2u);  // alternatives
    for (const json& figures : certified.at("certified")) {
      EXPECT_EQ(figures.at("passed"), expected.signatures) << expected.tile;
      EXPECT_EQ(figures.at("signatures_with_non_spherical"), expected.tori) << expected.tile;
    }
    const json all = json::parse(gen({"--tile", expected.tile, "--certify", "--all", "--json"}).out);
    EXPECT_EQ(all.at("pairs"), expected.pairs) << expected.tile;
    EXPECT_GE(all.at("tiles_without_symmetry"), expected.pairs) << expected.tile;
    const json classes = json::parse(gen({"--tile", expected.tile, "--classes", "--json"}).out);
    EXPECT_EQ(classes.at("classes").size(), static_cast<std::size_t>(expected.orbits));
    const json summary = json::parse(gen({"--tile", expected.tile, "--json"}).out);
    EXPECT_EQ(summary.at("groups").at(0).at("classes"), expected.orbits);
    EXPECT_EQ(summary.at("tables").size(), expected.dim == 3 ? 2u : 1u);
  }
  EXPECT_EQ(gen({"--dim", "4", "--tile", "octahedron", "--count"}).out, gen({"--tile", "cross4", "--count"}).out);
  for (const char* command : {"--count", "--classes"})
    EXPECT_EQ(gen({"--tile", "octahedron", command}).out, gen({"--dim", "3", "--tile", "octahedron", command}).out);
}

TEST(GenCli, TheTablesOfACellAreWrittenWithTheNumbersOfAllCells) {
  const Folder folder;
  const Outcome run = gen({"--tile", "wedge", "--out", folder.file("t"), "--language", "cpp,json"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto files = contents(folder.file("t")), built = contents(TEGL_TABLE_DIR);
  ASSERT_EQ(files.size(), 4u);
  const json all = json::parse(built.at("cells_manifest.json"));
  for (const json& table : json::parse(files.at("cell_wedge_manifest.json")).at("tables")) {
    const json& tables = all.at("tables");
    EXPECT_NE(std::find(tables.begin(), tables.end(), table), tables.end()) << table;
    const json file = json::parse(files.at("cell_wedge_" + table.at("triangulation").get<std::string>() + ".json"));
    EXPECT_EQ(file.at("fnv1a"), table.at("fnv1a"));
    EXPECT_EQ(file.at("list_of").size(), 64u);
  }
  // the arrays of the library's own file
  const std::string& source = files.at("cell_wedge.cpp");
  const std::string array = "const char kWedgeCompactSimplices[]";
  const std::string text =
      source.substr(source.find(array), 2000).substr(0, source.substr(source.find(array)).find(';'));
  EXPECT_THAT(built.at("cells.cpp"), HasSubstr(text));
}

TEST(GenCli, CellsAreCertifiedAndWrittenAsTheBuildHasThem) {
  const Outcome printed = gen({"--cells"});
  ASSERT_EQ(printed.status, 0) << printed.err;
  EXPECT_THAT(printed.out, testing::ContainsRegex("wedge_prism +barycentric +4096 +48 +158 +158 +48"));
  const Folder folder;
  const Outcome written = gen({"--cells", "--out", folder.file("t")});
  ASSERT_EQ(written.status, 0) << written.err;
  const auto files = contents(folder.file("t")), built = contents(TEGL_TABLE_DIR);
  ASSERT_EQ(files.size(), 2u);
  for (const auto& [name, text] : files) EXPECT_EQ(text, built.at(name)) << name;
}

TEST(GenCli, CellsTakeNoDimension) {
  expect_refused({"--dim", "3", "--cells"}, {"--dim does not go with --cells", "only --out, --keep"});
  expect_refused({"--cells", "--keep"}, {"--keep does not go with --cells without --out"});
}

TEST(GenCli, RefusesTilesAndWhatTheyDoNotHave) {
  expect_refused({"--dim", "3", "--count", "--tile", "prism"},
                 {"--tile prism", "cube, simplex, octahedron", "wedge", "prism:octahedron", "cross4"});
  expect_refused({"--dim", "5", "--count", "--tile", "simplex"}, {"--dim 5", "2 to 4"});
  expect_refused({"--dim", "2", "--certify", "--tile", "octahedron"}, {"--dim 2", "expects 3 or 4"});
  expect_refused({"--dim", "4", "--count", "--tile", "wedge"}, {"--dim 4", "--tile wedge expects 3"});
  expect_refused({"--tile", "simplex"}, {"--tile without --dim", "expected --dim N"});
  expect_refused({"--tile", "wedge", "--certify", "--table-by-class"}, {"--tile wedge", "--table-by-class"});
  expect_refused({"--tile", "wedge", "--out", "t", "--language", "glsl"}, {"--tile wedge", "glsl", "cpp or json"});
  expect_refused({"--tile", "wedge", "--out", "t", "--layout", "flat"}, {"--layout", "--tile wedge"});
  expect_refused({"--tile", "cross4", "--out", "t", "--triangulation", "compact"}, {"compact", "expects barycentric"});
  expect_refused({"--dim", "3", "--out", "t", "--tile", "simplex", "--language", "json,glsl"}, {"glsl", "cpp or json"});
  expect_refused({"--dim", "3", "--out", "t", "--tile", "simplex", "--layout", "class"}, {"--layout class"});
  expect_refused({"--dim", "3", "--certify", "--tile", "simplex", "--table-by-class"}, {"--table-by-class"});
  expect_refused({"--dim", "3", "--transversal", "--tile", "simplex"}, {"--tile does not go with --transversal"});
}

TEST(GenCli, WritesTheCatalogueOfCases) {
  const std::string folder = testing::TempDir() + "gen_cases";
  const Outcome run = gen({"--dim", "2", "--cases", folder});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("2d.md and 7 pictures"));
  EXPECT_TRUE(std::filesystem::exists(folder + "/2d/006_high.svg"));
  std::filesystem::remove_all(folder);
  expect_refused({"--dim", "2", "--cases", folder, "--layout", "flat"}, {"--layout does not go with --cases"});
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

/// Polygon sizes, in descending order.
std::vector<std::size_t> sizes_of(const json& facets) {
  std::vector<std::size_t> sizes;
  for (const json& facet : facets) {
    sizes.push_back(facet.size());
  }
  std::sort(sizes.rbegin(), sizes.rend());
  return sizes;
}

TEST(GenCli, ClassesOfTheCubeHaveTheKnownOrbitsAndPolygons) {
  struct Expected {
    int orbit;
    std::vector<std::size_t> low;
    std::vector<std::size_t> high;
    int ambiguous_squares;
  };
  const std::map<int, Expected> cube{
      {0, {1, {}, {}, 0}},
      {1, {8, {3}, {3}, 0}},
      {3, {12, {4}, {4}, 0}},
      {6, {12, {3, 3}, {6}, 1}},
      {7, {24, {5}, {5}, 0}},
      {15, {6, {4}, {4}, 0}},
      {22, {8, {3, 3, 3}, {6, 3}, 3}},
      {23, {8, {6}, {6}, 0}},
      {24, {4, {3, 3}, {3, 3}, 0}},
      {25, {24, {4, 3}, {7}, 1}},
      {27, {24, {6}, {6}, 0}},
      {30, {24, {5, 3}, {5, 3}, 2}},
      {31, {24, {5}, {5}, 0}},
      {60, {6, {4, 4}, {4, 4}, 2}},
      {61, {24, {7}, {4, 3}, 1}},
      {63, {12, {4}, {4}, 0}},
      {105, {2, {3, 3, 3, 3}, {3, 3, 3, 3}, 6}},
      {107, {8, {6, 3}, {3, 3, 3}, 3}},
      {111, {12, {6}, {3, 3}, 1}},
      {126, {4, {3, 3}, {3, 3}, 0}},
      {127, {8, {3}, {3}, 0}},
      {255, {1, {}, {}, 0}},
  };
  for (const char* const alternative : {"low", "high"}) {
    const Outcome run = gen({"--dim", "3", "--classes", "--json", "--alternative", alternative});
    ASSERT_EQ(run.status, 0) << run.err;
    const json classes = json::parse(run.out).at("classes");
    ASSERT_EQ(classes.size(), cube.size());
    for (const json& found : classes) {
      const Expected& expected = cube.at(found.at("signature"));
      EXPECT_EQ(found.at("orbit_length"), expected.orbit) << found;
      EXPECT_EQ(found.at("stabiliser"), 48 / expected.orbit) << found;
      EXPECT_EQ(sizes_of(found.at("facets")), alternative[0] == 'l' ? expected.low : expected.high) << found;
      EXPECT_EQ(found.at("components"), found.at("facets").size()) << found;
      EXPECT_EQ(found.at("ambiguous_faces").at("2"), expected.ambiguous_squares) << found;
    }
  }
}

TEST(GenCli, ClassesForPeopleHasALineForEachClass) {
  for (const auto& [dim, classes] : {std::pair{"2", 6}, std::pair{"3", 22}, std::pair{"4", 402}}) {
    const Outcome run = gen({"--dim", dim, "--classes"});
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(std::count(run.out.begin(), run.out.end(), '\n'), classes + 1) << "and one of headings";
  }
}

TEST(GenCli, CertifiesEverySignatureOfBothAlternativesAndTriangulations) {
  for (const auto& [dim, signatures] : {std::pair{"2", 16}, std::pair{"3", 256}}) {
    const Outcome run = gen({"--dim", dim, "--certify", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const json certified = json::parse(run.out).at("certified");
    std::set<std::pair<std::string, std::string>> covered;
    for (const json& figures : certified) {
      covered.emplace(figures.at("alternative"), figures.at("triangulation"));
      EXPECT_EQ(figures.at("signatures"), signatures);
      EXPECT_EQ(figures.at("passed"), signatures);
      EXPECT_EQ(figures.at("non_spherical"), 0);
    }
    EXPECT_EQ(covered.size(), 4U);
  }
}

TEST(GenCli, OutWritesTheSameBytesWhereverAndHoweverOften) {
  const Folder folder;
  ASSERT_EQ(gen({"--dim", "3", "--out", folder.file("first")}).status, 0);
  ASSERT_EQ(gen({"--out", folder.file("a/second"), "--dim", "3"}).status, 0);
  ASSERT_EQ(gen({"--out", folder.file("a/second"), "--dim", "3"}).status, 0) << "over the first ones";
  const auto first = contents(folder.file("first"));
  EXPECT_EQ(first.size(), 6U);
  for (const auto& [name, text] : first) {
    EXPECT_EQ(text.find(folder.file("")), std::string::npos) << name << " names the folder";
  }
  EXPECT_EQ(first, contents(folder.file("a/second")));
}

TEST(GenCli, SaysWhenItsOutputCannotBeWritten) {
  for (const char* const arguments : {"--help", "--dim 4 --classes --json", "--dim 3 --count"}) {
    const std::string command = std::string(TEGL_GEN_PROGRAM) + " " + arguments + " > /dev/full 2> /dev/null";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 5) << arguments;  // NOLINT: no shell text from outside
  }
}

TEST(GenCli, OutSaysHowLargeEachFileIsAndHowLongItTook) {
  const Folder folder;
  const Outcome run = gen({"--dim", "2", "--out", folder.file("out")});
  for (const auto& [name, text] : contents(folder.file("out")))
    EXPECT_THAT(run.out, testing::ContainsRegex("wrote " + name + ": " + std::to_string(text.size()) +
                                                " bytes in [0-9]+\\.[0-9]+ s"));
}

TEST(GenCli, OutOf4dOnOneProcessorIsWhatTheBuildWroteOnAll) {
  if (std::string(TEGL_TABLE_LAYOUT) != "auto") GTEST_SKIP() << "built with tables of another layout";
  const Folder folder;
  cpu_set_t before, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
  CPU_ZERO(&one);
  for (int cpu = 0; CPU_COUNT(&one) == 0; ++cpu)
    if (CPU_ISSET(cpu, &before)) CPU_SET(cpu, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);  // inherited by gen
  const Outcome run = gen({"--dim", "4", "--out", folder.file("one")});
  ASSERT_EQ(sched_setaffinity(0, sizeof(before), &before), 0);
  ASSERT_EQ(run.status, 0) << run.err;
  const auto built = contents(TEGL_TABLE_DIR);
  for (const auto& [name, text] : contents(folder.file("one"))) {
    ASSERT_TRUE(built.contains(name)) << name;
    EXPECT_TRUE(built.at(name) == text) << name;
  }
}

TEST(GenCli, OutHonoursTriangulationAndLayout) {
  const Folder folder;
  ASSERT_EQ(gen({"--dim", "2", "--out", folder.file("compact"), "--triangulation", "compact"}).status, 0);
  const auto compact = contents(folder.file("compact"));
  EXPECT_TRUE(compact.contains("tile2_compact.cpp"));
  EXPECT_FALSE(compact.contains("tile2_barycentric.cpp"));
  for (const char* const layout : {"class", "flat"}) {
    ASSERT_EQ(gen({"--dim", "2", "--out", folder.file(layout), "--layout", layout}).status, 0);
    EXPECT_THAT(contents(folder.file(layout)).at("tile2_barycentric.cpp"), HasSubstr(std::string(layout) + " layout"));
  }
}

TEST(GenCli, OutThatCannotBeWrittenFailsAndLeavesNothingHalfWritten) {
  const Folder folder;
  std::ofstream(folder.file("file")) << "in the way";
  const Outcome not_a_folder = gen({"--dim", "2", "--out", folder.file("file")});
  EXPECT_EQ(not_a_folder.status, 5);
  EXPECT_THAT(not_a_folder.err, HasSubstr(folder.file("file")));

  std::filesystem::create_directories(folder.file("tables/region1.cpp"));
  const Outcome blocked = gen({"--dim", "2", "--out", folder.file("tables")});
  EXPECT_EQ(blocked.status, 5);
  EXPECT_THAT(blocked.err, HasSubstr("region1.cpp"));
  for (const auto& [name, text] : contents(folder.file("tables"))) {
    EXPECT_THAT(name, testing::Not(HasSubstr(".part")));
  }
}

}  // namespace
}  // namespace tegl::test
