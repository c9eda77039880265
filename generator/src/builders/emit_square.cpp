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

}  // namespace

BuilderTexts emit_square_builder(const BuilderRequest& request) {
  BuilderTexts texts;
  certify_squares();
  texts.certificate = "16 signatures, both signs of the centre";
  const std::string name = builder_name(request), space = builder_namespace(request);
  for (const Language language : request.languages) {
    if (language != Language::cpp)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("--dim 2: --builder does not emit {} yet; expected cpp", language_name(language)));
    const auto banner = [&](const char* what) { return builder_banner(request, language, what, texts.certificate); };
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
