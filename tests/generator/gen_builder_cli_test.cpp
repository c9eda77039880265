// SPDX-License-Identifier: BSD-3-Clause
//
// The program `gen`: builders, and files that are kept.
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "gen_cli.hpp"

namespace tegl::test {
namespace {

std::string hexadecimal(std::uint64_t number) {
  std::ostringstream text;
  text << std::hex << std::setw(16) << std::setfill('0') << number;
  return text.str();
}

/// FNV-1a of 64 bits.
std::uint64_t digest_of(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

TEST(GenCli, BuilderIsPrintedOrWrittenWithItsManifest) {
  const Folder folder;
  for (const char* const dim : {"2", "3"})
    for (const char* const leaf : {"table", "edges"}) {
      const std::string name = std::string("builder") + dim + (std::string(leaf) == "edges" ? "_edges" : "");
      const Outcome printed = gen({"--dim", dim, "--builder", "--leaf", leaf});
      ASSERT_EQ(printed.status, 0) << printed.err;
      const Outcome written = gen({"--dim", dim, "--builder", "--leaf", leaf, "--out", folder.file(name)});
      ASSERT_EQ(written.status, 0) << written.err;
      EXPECT_THAT(written.out, HasSubstr("wrote " + name + ".hpp"));
      const auto files = contents(folder.file(name));
      ASSERT_EQ(files.size(), 3u);
      EXPECT_EQ(printed.out, "// ---- " + name + ".hpp ----\n" + files.at(name + ".hpp") + "\n// ---- " + name +
                                 ".cpp ----\n" + files.at(name + ".cpp"));
      const json manifest = json::parse(files.at(name + "_manifest.json"));
      EXPECT_EQ(manifest.at("builder"), std::stoi(dim));
      EXPECT_EQ(manifest.at("leaf"), leaf);
      ASSERT_EQ(manifest.at("texts").size(), 2u);
      for (const json& text : manifest.at("texts")) {
        const std::string& content = files.at(text.at("name"));
        EXPECT_EQ(text.at("bytes"), content.size());
        EXPECT_EQ(text.at("fnv1a"), hexadecimal(digest_of(content)));
      }
    }
}

TEST(GenCli, BuilderIsTheOneOfTheBuildInEveryLanguage) {
  const Folder folder;
  for (const char* const dim : {"2", "3"}) {
    ASSERT_EQ(gen({"--builder", "--dim", dim, "--language", "cpp,glsl,wgsl", "--out", folder.file("all")}).status, 0);
    const auto files = contents(folder.file("all"));
    const std::string name = std::string("builder") + dim;
    for (const char* const suffix : {".hpp", ".cpp", ".glsl", ".wgsl", "_manifest.json"}) {
      std::ifstream in(std::string(TEGL_TABLE_DIR) + "/" + name + suffix, std::ios::binary);
      EXPECT_EQ(files.at(name + suffix), (std::string{std::istreambuf_iterator<char>(in), {}})) << name << suffix;
    }
  }
}

TEST(GenCli, ManifestOfABuilderKeepsTheTextsOfEarlierCalls) {
  const Folder folder;
  const auto emit = [&](const char* out, const std::string& languages) {
    ASSERT_EQ(gen({"--builder", "--dim", "2", "--language", languages, "--out", folder.file(out)}).status, 0);
  };
  const auto names = [&](const char* out) {
    std::vector<std::string> result;
    const json manifest = json::parse(contents(folder.file(out)).at("builder2_manifest.json"));
    for (const json& text : manifest.at("texts")) result.push_back(text.at("name"));
    return result;
  };
  emit("at_once", "cpp,glsl,wgsl");
  for (const char* const languages : {"wgsl", "cpp", "glsl", "cpp"}) emit("in_turn", languages);
  EXPECT_EQ(contents(folder.file("in_turn")), contents(folder.file("at_once")));
  // a text that was changed, and one that is no longer there, are not listed
  std::ofstream(folder.file("in_turn/builder2.glsl"), std::ios::app) << "// changed\n";
  std::filesystem::remove(folder.file("in_turn/builder2.wgsl"));
  emit("in_turn", "cpp");
  EXPECT_EQ(names("in_turn"), (std::vector<std::string>{"builder2.hpp", "builder2.cpp"}));
  // nor is anything of a manifest with another certificate
  std::ofstream(folder.file("at_once/builder2_manifest.json")) << "{}\n";
  emit("at_once", "glsl");
  EXPECT_EQ(names("at_once"), std::vector<std::string>{"builder2.glsl"});
}

TEST(GenCli, LinesOfBuildersHaveAtMost120Columns) {
  std::set<std::string> builders;
  for (const auto& [name, text] : contents(TEGL_TABLE_DIR)) {
    if (name.rfind("builder", 0) != 0 || name.find("_manifest.json") != std::string::npos) continue;
    builders.insert(name);
    for (std::size_t first = 0; first < text.size(); first = text.find('\n', first) + 1)
      ASSERT_LE(text.find('\n', first) - first, 120u) << name << ": " << text.substr(first, 120);
  }
  for (const char* const name : {"builder2.hpp", "builder3.wgsl", "builder4.cpp", "builder4_lists.cpp", "builder5.cpp"})
    EXPECT_EQ(builders.count(name), 1u) << name;
}

TEST(GenCli, BuilderRefusesOptionsOfOtherCommands) {
  expect_refused({"--dim", "6", "--builder"}, {"--dim 6", "--builder expects 2 to 5"});
  expect_refused({"--dim", "3", "--builder", "--leaf", "corners"}, {"--leaf corners", "table or edges"});
  expect_refused({"--dim", "3", "--builder", "--language", "cuda"}, {"does not emit cuda", "cpp, glsl or wgsl"});
  expect_refused({"--dim", "3", "--builder", "--leaf", "edges", "--language", "glsl"}, {"--leaf edges", "table"});
  expect_refused({"--dim", "3", "--builder", "--triangulation", "all"},
                 {"--triangulation all", "barycentric or compact"});
  expect_refused({"--dim", "3", "--builder", "--triangulation", "fan"},
                 {"--triangulation fan: expected barycentric or compact;"});
  for (const char* const dim : {"2", "4", "5"})
    expect_refused({"--dim", dim, "--builder", "--triangulation", "barycentric"},
                   {dim, "--triangulation does not go with this builder"});
  expect_refused({"--dim", "3", "--builder", "--layout", "flat"}, {"--layout does not go with --builder"});
  expect_refused({"--dim", "3", "--count", "--leaf", "table"}, {"--leaf does not go with --count"});
  expect_refused({"--dim", "3", "--builder", "--count"}, {"--builder and --count were both given"});
  expect_refused({"--dim", "3", "--builder", "--out", "a", "--cases", "b"}, {"--builder and --cases were both given"});
}

TEST(GenCli, KeepLeavesFilesThatHaveTheirText) {
  const Folder folder;
  const std::string file = folder.file("out/tile2_compact.cpp");
  ASSERT_EQ(gen({"--dim", "2", "--out", folder.file("out")}).status, 0);
  const auto long_ago = std::filesystem::last_write_time(file) - std::chrono::hours(1);
  const auto write_again = [&](std::initializer_list<std::string_view> arguments) {
    std::filesystem::last_write_time(file, long_ago);
    EXPECT_EQ(gen(arguments).status, 0);
    return std::filesystem::last_write_time(file) != long_ago;
  };
  const std::string out = folder.file("out");
  EXPECT_FALSE(write_again({"--dim", "2", "--out", out, "--keep"}));
  EXPECT_TRUE(write_again({"--dim", "2", "--out", out}));
  std::ofstream(file, std::ios::app) << " ";
  EXPECT_TRUE(write_again({"--dim", "2", "--out", out, "--keep"}));
  EXPECT_EQ(contents(folder.file("out")).size(), 5U) << "a temporary file is left";
  expect_refused({"--dim", "2", "--builder", "--keep"}, {"--keep", "--out"});
}

}  // namespace
}  // namespace tegl::test
