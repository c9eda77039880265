// SPDX-License-Identifier: BSD-3-Clause
//
// Writing of track graphs to a pending file: for the program, which puts several files in place together.
#pragma once

#include "tegl/io/tracks.hpp"

namespace tegl {

class PendingPath;

/// As write_track of tegl/io/tracks.hpp; the caller commits the file.
void write_track(const TrackGraph& graph, const PendingPath& file, const TrackPicture& picture);

}  // namespace tegl
