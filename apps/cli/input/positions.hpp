// SPDX-License-Identifier: BSD-3-Clause
//
// The options --positions, --positions-image and --last-axis-weight: where vertices lie on their edges.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <variant>

#include "base/progress.hpp"
#include "input/commands.hpp"
#include "input/extraction.hpp"
#include "tegl/cells.hpp"
#include "tegl/positions.hpp"

namespace tegl::cli {

class PositionArguments {
 public:
  /// Adds the options to a command. This object must outlive the parse.
  void add_to(CLI::App& app);

  [[nodiscard]] bool are_linear() const { return rule_ == "linear"; }
  /// Throws InvalidArgument unless positions are linear. `with`: another option.
  void refuse(const std::string& with) const;
  /// Throws InvalidArgument for an option that the rule does not have or that it misses, FileNotFound for a missing
  /// image.
  void require() const;
  /// The file of --positions-image; empty: none.
  [[nodiscard]] const std::string& file() const { return file_; }

  /// Options of the library for an image. `values`: receives the samples of --positions-image, which the result refers
  /// to. `reading`: how the file is read. Throws UnsupportedData for an image of another size.
  [[nodiscard]] PositionOptions library_options(const AnyImage& image, ReadImageOptions reading,
                                                std::vector<float>& values) const;

 private:
  std::string rule_ = "linear";
  std::string file_;
  std::string weight_ = "1";
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

}  // namespace tegl::cli
