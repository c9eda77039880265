// SPDX-License-Identifier: BSD-3-Clause
//
// The options of `tegl contour`, and the checks of which go together.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "commands/over_scales.hpp"
#include "input/attributes.hpp"
#include "input/extraction.hpp"
#include "input/image_input.hpp"
#include "input/merging.hpp"
#include "input/positions.hpp"
#include "output/output.hpp"

namespace tegl::cli {

struct ContourArguments {
  ExtractionOptions extraction;
  PositionArguments positions;
  MergeArguments merging;
  ScaleSpaceArguments scales;
  AttributeOptions attributes;
  CompressOption compress;
  std::string output;  ///< with placeholders
  std::string index;   ///< the file of --index; empty: none
  std::string pick;
  bool stream = false;  ///< --stream; see is_streamed
  bool one_file = false, facets = false, unroll = false, no_check = false;

  /// Adds the options to a command, whose options for images are `images`. Both, and this object, must outlive the
  /// parse.
  void add_to(CLI::App& app, const ImageOptions& images);

  /// Whether the image is read by layers and the contour written in parts: if requested, and for raw files whenever
  /// possible.
  [[nodiscard]] bool is_streamed() const;
  /// Whether the output's name has an isovalue that is found in the image.
  [[nodiscard]] bool is_named_by_image() const;
  /// Whether no option is given that needs straight axes.
  [[nodiscard]] bool knows_curved_grids() const;
  /// Whether the samples may be stored integers: for contours that depend on the samples' sides and, along edges, on
  /// their differences only. Other rules compare sums, and files beside the image have its values.
  [[nodiscard]] bool takes_stored_integers(const ExtractOptions& options) const;
  /// Whether --pick is given.
  [[nodiscard]] bool picks() const;
  /// The numbers of --pick; empty without the option. Throws InvalidArgument with options that exclude it.
  [[nodiscard]] std::vector<double> picked_point() const;
  /// The given options of this command that need an image.
  [[nodiscard]] std::vector<std::string> for_images() const;

  // Each throws InvalidArgument for options that do not go together.

  /// Options about periodic axes, lattices, divisions and cells.
  void require_tiling() const;
  /// --positions with functions that know linear positions only, and its own options.
  void require_positions() const;
  /// --merge with contours that are not in memory or have no simplices.
  void require_merging() const;
  /// --scale-space with options that need the image itself, or layers of a file. Parses the scales.
  void require_scale_space();
  /// --one-file, for this number of isovalues.
  void require_one_file_of_several(std::size_t isovalues) const;
  /// Options that 5D contours do not have.
  void require_to_5d() const;
  /// Options that cells and lattices do not have, if the samples of `file` are cells or on a lattice.
  void refuse_tiling_of_file(const ImageInfo& info, const std::string& file) const;

 private:
  /// Calls refuse(with) for the options that know only cubic cells between samples.
  template <class Refuse>
  void for_plain_cells(const Refuse& refuse) const;

  const CLI::App* app_ = nullptr;
  const ImageOptions* images_ = nullptr;
};

}  // namespace tegl::cli
