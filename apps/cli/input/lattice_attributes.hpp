// SPDX-License-Identifier: BSD-3-Clause
//
// The option --attribute for images on lattices, and where it is refused.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "input/attributes.hpp"
#include "input/extraction.hpp"
#include "tegl/curved.hpp"
#include "tegl/lattice.hpp"

namespace tegl::cli {

/// Throws UnsupportedData unless an image of --attribute has the samples' places of the image that is contoured. A file
/// that records no lattice has the contour's.
template <int N>
void require_same_lattice(const Grid<N>& image, const ImageInfo& info, const std::string& file, const Grid<N>& contour,
                          Lattice lattice) {
  bool is_same = info.curved.empty() && (!info.lattice || *info.lattice == lattice) && image.linear == contour.linear &&
                 image.offset == contour.offset;
  for (std::size_t a = 0; a < N && is_same; ++a) {
    const Axis &one = image.axes[a], &other = contour.axes[a];
    is_same = one.size() == other.size();
    for (std::size_t i = 0; i < one.size() && is_same; ++i) is_same = one[i] == other[i];
  }
  if (is_same) return;
  throw Error(ErrorCode::UnsupportedData,
              fmt::format("--attribute {}: an image on the lattice {}; the contour's is {}: expected the same lattice, "
                          "numbers of samples and coordinates as the image that is contoured",
                          file, info.lattice ? name_of(*info.lattice) : "cubic", name_of(lattice)));
}

/// The values of an image of --attribute on a lattice, without samples that repeat the first ones of periodic axes, as
/// they are left out of the image that is contoured. Throws as require_same_lattice and without_repeated.
template <Value T, int N>
std::vector<double> numbers_on_lattice(const OwnedImage<T, N>& image, const ImageInfo& info, const std::string& file,
                                       const Grid<N>& contour, const Tiling& tiling) {
  const NamedPeriods named = named_periods(contour, {}, tiling.periodic);
  const Grid<N> kept = without_repeated<T, N>(image.view(), {}, named.axes, named.periods).image.grid();
  require_same_lattice<N>(kept, info, file, contour, *tiling.lattice);
  std::vector<double> numbers;
  numbers.reserve(image.values.size());
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    bool is_kept = true;
    std::size_t rest = i;
    for (std::size_t a = 0; a < N; ++a) {
      is_kept = is_kept && rest % image.grid.axes[a].size() < kept.axes[a].size();
      rest /= image.grid.axes[a].size();
    }
    if (is_kept) numbers.push_back(static_cast<double>(image.values[i]));
  }
  return numbers;
}

/// Throws InvalidArgument for --attribute with a curved grid and --periodic.
inline void refuse_attributes_on_seams(const AttributeOptions& attributes, const Tiling& tiling) {
  if (attributes.wanted() && !tiling.curved.empty() && !tiling.periodic.empty())
    throw Error(ErrorCode::InvalidArgument,
                "--attribute with --periodic and a curved grid; expected two of them, or --index-grid");
}

/// The same, and for --attribute on a lattice: for commands other than contour.
inline void refuse_attributes_on_lattices(const AttributeOptions& attributes, const Tiling& tiling) {
  refuse_attributes_on_seams(attributes, tiling);
  if (attributes.wanted() && tiling.lattice)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("--attribute on the lattice {}; expected it with 'tegl contour', which writes a contour with "
                    "attributes, and then this command",
                    name_of(*tiling.lattice)));
}

/// Interpolates the images of --attribute along the edges of the lattice of `image`, whose contour this is. Throws as
/// AttributeOptions::sample_to, and UnsupportedData for an image with other places of samples.
template <int N, class Real>
void sample_on_lattice(const AttributeOptions& attributes, Contour<N, Real>& contour, const AnyImage& image,
                       const Tiling& tiling, double isovalue, const ExtractOptions& options,
                       const ReadImageOptions& reading, ProgressBar& bar) {
  const auto of_owned = [&]<Value T>(const OwnedImage<T, N>& owned) {
    CurvedContour<N, Real> how;
    how.on_lattice = [&](const ReadImageResult& other, const std::string& file) {
      std::vector<double> numbers;
      const auto take = [&](const auto& from) {
        numbers = numbers_on_lattice(from, other.info, file, owned.grid, tiling);
      };
      std::visit(take, std::get<AnyImageN<N>>(other.image));
      return interpolate_lattice(owned.view(), *tiling.lattice, isovalue, numbers, "", "", options,
                                 periods_of(owned.grid, tiling.periodic));
    };
    attributes.sample_to(contour, reading, options.work.threads, bar, how);
  };
  std::visit(of_owned, std::get<AnyImageN<N>>(image));
}

}  // namespace tegl::cli
