// SPDX-License-Identifier: BSD-3-Clause
//
// The options --positions, --positions-image and --last-axis-weight: where vertices lie on their edges; and --label:
// the mask that is contoured.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <variant>
#include <vector>

#include "base/progress.hpp"
#include "input/commands.hpp"
#include "input/cuts.hpp"
#include "input/extraction.hpp"
#include "tegl/cells.hpp"
#include "tegl/positions.hpp"

namespace tegl::cli {

/// Samples of --positions-image: doubles where float would round them.
using PositionValues = std::variant<std::vector<float>, std::vector<double>>;

class PositionArguments {
 public:
  /// Adds the options to a command. This object must outlive the parse.
  void add_to(CLI::App& app);

  [[nodiscard]] bool has_label() const { return !label_.empty(); }
  /// The isovalues of --iso; 1/2 with --label; NaN by default with --positions relaxed: see `apply`. Throws
  /// InvalidArgument without --iso otherwise, and for --iso with --label.
  [[nodiscard]] std::vector<SpelledNumber> isovalues(const ExtractionOptions& options) const;
  /// Whether `apply` sets the isovalue.
  [[nodiscard]] bool finds_isovalue(const ExtractionOptions& options) const;
  /// With --label, replaces the image by 1 for samples that have this value and 0 for others; missing ones stay
  /// missing. Sets isovalues of NaN to the middle of the image's two values, and returns a remark of this. Throws
  /// EmptyResult if no sample has the label, unless `allow_empty`, InvalidArgument if the image has not exactly two
  /// values.
  std::string apply(std::variant<ReadImageResult, ReadImage5dResult>& input, std::vector<ContourResult>& results,
                    bool allow_empty) const;

  [[nodiscard]] bool are_linear() const { return rule_ == "linear"; }
  /// Why simplices by --positions filtered have zero size, for reports.
  static constexpr const char* kNoSize =
      "samples of the image, or of --positions-image where they are clamped, equal the isovalue; --epsilon avoids them";
  /// Throws InvalidArgument unless positions are linear, and for --label with an option that needs the image of FILE.
  /// `with`: another option.
  void refuse(const std::string& with) const;
  /// Throws InvalidArgument for an option that the rule does not have or that it misses, FileNotFound for a missing
  /// image.
  void require() const;
  /// The file of --positions-image; empty: none.
  [[nodiscard]] const std::string& file() const { return file_; }

  /// Options of the library for an image. `values`: receives the samples of --positions-image, which the result refers
  /// to. `reading`: how the file is read. Throws UnsupportedData for an image of another size.
  [[nodiscard]] PositionOptions library_options(const AnyImage& image, ReadImageOptions reading,
                                                PositionValues& values) const;

  /// The same for an image of 5 axes. Throws InvalidArgument for other rules than linear and relaxed.
  [[nodiscard]] PositionOptions library_options_5d() const;

 private:
  [[nodiscard]] PositionOptions without_image() const;

  std::string rule_ = "linear";
  std::string file_;
  std::string weight_ = "1";
  std::string label_;
};

/// Extracts the contour of an image of any type and passes it to `use`, as Extraction<N, float> or
/// Extraction<N, double>. `tiling`: whether samples are cells, and their faces.
template <class Result, class Use>
Result extract_placed_and_use(const AnyImage& image, double isovalue, const PositionOptions& positions,
                              const ExtractOptions& options, bool single_precision, const Tiling& tiling,
                              const Use& use) {
  const auto of_owned = [&](const auto& owned) -> Result {
    if (tiling.of_cells) {
      const CellFaces& faces = tiling.cell_faces;
      if (single_precision)
        return use(extract_cells_with_stats<float>(owned.view(), isovalue, positions, options, faces));
      return use(extract_cells_with_stats<double>(owned.view(), isovalue, positions, options, faces));
    }
    if (single_precision) return use(extract_placed_with_stats<float>(owned.view(), isovalue, positions, options));
    return use(extract_placed_with_stats<double>(owned.view(), isovalue, positions, options));
  };
  return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
}

/// The same for an image in 5 dimensions.
template <class Result, class Use>
Result extract_placed_and_use(const AnyImage5d& image, double isovalue, const PositionOptions& positions,
                              const ExtractOptions& options, bool single_precision, const Use& use) {
  return std::visit(
      [&](const auto& owned) -> Result {
        if (single_precision) return use(extract_placed_with_stats<float>(owned.view(), isovalue, positions, options));
        return use(extract_placed_with_stats<double>(owned.view(), isovalue, positions, options));
      },
      image);
}

}  // namespace tegl::cli
