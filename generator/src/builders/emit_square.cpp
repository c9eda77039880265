// SPDX-License-Identifier: BSD-3-Clause
//
// Emits the builder of the square: maximal runs of corners around its boundary are cut off.
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "base/lattice.hpp"
#include "builders/emit_builder.hpp"
#include "builders/square_contours.hpp"
#include "builders/templates.hpp"

namespace tegl::gen {

namespace {

/// The rows of the table: by sign of the centre and signature.
std::string table_rows() {
  std::string text;
  for (const bool centre_high : {false, true}) {
    text += "{\n";
    for (unsigned signature = 0; signature < 16; ++signature) {
      const std::vector<SquareSegment> segments = square_segments(signature, centre_high);
      text += fmt::format("{}{{{}, {{", signature % 4 == 0 ? "    " : " ", segments.size());
      for (std::size_t i = 0; i < 2; ++i) {
        const SquareSegment s = i < segments.size() ? segments[i] : SquareSegment{0, 0};
        text += fmt::format("{}{{{}, {}}}", i == 0 ? "" : ", ", s[0], s[1]);
      }
      text += signature % 4 == 3 ? "}},\n" : "}},";
    }
    text += "},\n";
  }
  return text;
}

/// The words of shaders: by sign of the centre and signature, the number of segments and four bits for each vertex.
std::string table_words() {
  std::string text;
  for (unsigned i = 0; i < 32; ++i) {
    const std::vector<SquareSegment> segments = square_segments(i % 16, i >= 16);
    std::uint32_t word = static_cast<std::uint32_t>(segments.size());
    for (std::size_t s = 0; s < segments.size(); ++s)
      word |= (std::uint32_t{segments[s][0]} | std::uint32_t{segments[s][1]} << 4) << (8 * s + 4);
    text += fmt::format("{}u{}", word, i == 31 ? "\n" : i % 8 == 7 ? ",\n" : ", ");
  }
  return text;
}

}  // namespace

BuilderTexts emit_square_builder(const BuilderRequest& request) {
  BuilderTexts texts;
  certify_squares();
  texts.certificate = "16 signatures, both signs of the centre";
  const std::string name = builder_name(request), space = builder_namespace(request);
  for (const Language language : request.languages) {
    const auto banner = [&](const char* what) { return builder_banner(request, language, what, texts.certificate); };
    if (language != Language::cpp) {
      texts.files.push_back({fmt::format("{}.{}", name, language_name(language)),
                             filled(fmt::format("builder2.{}", language_name(language)),
                                    {{"banner", banner("The contour in one square.")}, {"words", table_words()}})});
      continue;
    }
    texts.files.push_back({name + ".hpp", filled("builder2.hpp", {{"banner", banner("The contour in one square.")},
                                                                  {"namespace", space}})});
    const std::string what = banner(request.leaf == Leaf::table ? "The contour in one square, by table."
                                                                : "The contour in one square, by runs of corners.");
    texts.files.push_back(
        {name + ".cpp",
         request.leaf == Leaf::table
             ? filled("builder2.cpp",
                      {{"banner", what}, {"name", name}, {"namespace", space}, {"contours", table_rows()}})
             : filled("builder2_edges.cpp", {{"banner", what},
                                             {"name", name},
                                             {"namespace", space},
                                             {"ring_corners", fmt::format("{}", fmt::join(kRingCorner, ", "))},
                                             {"ring_edges", fmt::format("{}", fmt::join(kRingEdge, ", "))}})});
  }
  return texts;
}

}  // namespace tegl::gen
