// SPDX-License-Identifier: BSD-3-Clause
//
// The catalogue of cases in docs/ equals the generator's output, and its pictures are correct.
#include "pictures/cases.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace tegl::gen {
namespace {

std::size_t count_of(const std::string& text, const std::string& pattern) {
  std::size_t count = 0;
  for (std::size_t at = text.find(pattern); at != std::string::npos; at = text.find(pattern, at + 1)) ++count;
  return count;
}

const std::string& text_of(const std::vector<EmittedFile>& files, const std::string& name) {
  const auto found = std::find_if(files.begin(), files.end(), [&](const EmittedFile& f) { return f.name == name; });
  if (found == files.end()) throw std::runtime_error("no file " + name);
  return found->text;
}

class Cases : public testing::TestWithParam<int> {};

TEST_P(Cases, InTheDocumentationAreWhatTheGeneratorWrites) {
  const std::filesystem::path folder = TEGL_SOURCE_DIR "/docs/cases";
  std::set<std::filesystem::path> written;
  for (const EmittedFile& file : emit_cases(GetParam())) {
    std::ifstream in(folder / file.name, std::ios::binary);
    const std::string committed{std::istreambuf_iterator<char>(in), {}};
    EXPECT_TRUE(committed == file.text)
        << file.name << " has changed; where that was meant: cmake --build BUILD --target update_cases";
    written.insert(folder / file.name);
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder / (std::to_string(GetParam()) + "d")))
    EXPECT_TRUE(written.contains(entry.path())) << entry.path() << " is a picture that nothing writes any more";
}

INSTANTIATE_TEST_SUITE_P(Dimensions, Cases, testing::Values(2, 3, 4));

TEST(CasePages, HaveARowForEveryClass) {
  EXPECT_EQ(6u, count_of(text_of(emit_cases(2), "2d.md"), "| **"));
  EXPECT_EQ(23u, count_of(text_of(emit_cases(3), "3d.md"), "| **"));
  const auto files = emit_cases(4);
  const std::string& page = text_of(files, "4d.md");
  EXPECT_EQ(16u, count_of(page, "\n### "));
  const std::string table = page.substr(page.find("|---:|"));
  EXPECT_EQ(402u, count_of(table, "\n| "));
  EXPECT_EQ(16u, count_of(table, "**T**"));
  EXPECT_EQ(1u + 16u, files.size());
}

TEST(CasePictures, ShowCornersEdgesAndPolygons) {
  const auto files = emit_cases(3);
  const std::string& low = text_of(files, "3d/006_low.svg");
  EXPECT_EQ(2u, count_of(low, "class=\"high\""));
  EXPECT_EQ(6u, count_of(low, "class=\"low"));
  EXPECT_EQ(9u, count_of(low, "class=\"edge\"")) << "three edges of a cube are hidden";
  EXPECT_EQ(3u, count_of(low, "class=\"hidden\""));
  EXPECT_EQ(2u, count_of(low, "<polygon")) << "two triangles";
  EXPECT_EQ(6u, count_of(low, "class=\"rim\""));
  EXPECT_EQ(4u, count_of(text_of(files, "3d/006_high.svg"), "<polygon")) << "a hexagon";
}

TEST(CasePages, AreForTwoToFourDimensions) { EXPECT_THROW((void)emit_cases(5), Error); }

}  // namespace
}  // namespace tegl::gen
