// SPDX-License-Identifier: BSD-3-Clause
//
// Reading and writing of files: all headers of tegl/io. Link with tegl::io.
//
// Not thread-safe, not even for different files: the libraries behind some formats (netCDF, HDF5) have global state.
// Nothing is printed.
#pragma once

#include "tegl/io/active_tiles.hpp"
#include "tegl/io/cell_meshes.hpp"
#include "tegl/io/contour_file.hpp"
#include "tegl/io/elements.hpp"
#include "tegl/io/facets.hpp"
#include "tegl/io/image_writer.hpp"
#include "tegl/io/images.hpp"
#include "tegl/io/layers.hpp"
#include "tegl/io/mesh_array.hpp"
#include "tegl/io/meshes.hpp"
#include "tegl/io/series.hpp"
#include "tegl/io/text.hpp"
#include "tegl/io/tracks.hpp"
#include "tegl/io/write_options.hpp"
