// SPDX-License-Identifier: BSD-3-Clause
//
// Several files of 2D or 3D images as one image with one more axis.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>

#include "base/raw_image.hpp"
#include "process/separate_reading.hpp"
#include "tegl/io/series.hpp"

namespace tegl::io_detail {

/// Reads a file of a series, or its header.
using MemberReader =
    std::function<RawImage(const std::filesystem::path& path, Extent extent, const Progress& progress)>;

/// Opens a series with one file per layer. Of the options it uses coordinates, step, unit, order and progress. Errors:
/// those of read_series.
LayersOfFiles open_members(std::span<const std::filesystem::path> files, const SeriesOptions& options,
                           const MemberReader& read);

/// Reads a series with one file per layer, whose integers `read` leaves as they are stored: see
/// ReadImageOptions::keep_stored. nullopt if a file has none or has another scaling than the first. Options and errors
/// as for open_members.
std::optional<ImageOfFiles> read_stored_members(std::span<const std::filesystem::path> files,
                                                const SeriesOptions& options, const MemberReader& read);

}  // namespace tegl::io_detail
