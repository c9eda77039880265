// SPDX-License-Identifier: BSD-3-Clause
//
// Elements of contours to files: the text that Cornelius' programs write and read, and HDF5. Link with tegl::io; not
// thread-safe, as all of tegl/io.hpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tegl/elements.hpp"
#include "tegl/error.hpp"

namespace tegl {

/// The order of coordinates and components in a file. time_first: the last axis leads, then the others (t x y z), as
/// codes for freeze-out surfaces have it; as_is: as in the contour (x y z t).
enum class ElementAxes { time_first, as_is };

/// covariant: d sigma_mu as Elements::normals has it; contravariant: d sigma^mu by the metric (+, -, -, -), whose + is
/// the last axis: all components but that one change their sign. (In units where the speed of light is 1.)
enum class ElementComponents { covariant, contravariant };

/// What an element file holds, and how.
struct ElementFileOptions {
  ElementAxes axes = ElementAxes::time_first;                   ///< which axis leads
  ElementComponents components = ElementComponents::covariant;  ///< how normals are written
  bool header = false;     ///< of text: a first line that names the columns, behind a '#'
  Progress progress = {};  ///< see Progress
};

/// Writes by extension.
///
/// .dat, .txt: a line for each element, numbers between blanks: the N coordinates of the centroid, the N components of
/// the normal, then the attributes in their order, each with all its numbers. Shortest digits that give the same double
/// again; missing values are "nan". Without attributes this is what the programs that come with Cornelius write.
///
/// .h5, .hdf5: the datasets /centroid (#E x N), /dsigma (#E x N), /measure (#E), /simplices (#E, uint32: of how many
/// simplices the element is made) and /attributes/NAME (#E, or #E x width; a '/' in the name becomes '_'), doubles if
/// nothing else is said. Each has the attribute "units": one unit, or one per column in lines of their own; empty where
/// it is not known. The file has the attributes "format" ("tegl elements 1"), "axes" (the names of the columns, one per
/// line), "components" ("covariant", "contravariant") and "direction" ("descent", "ascent").
///
/// Written under another name beside the target and renamed at the end: never half a file. Errors: UnsupportedFormat
/// (the extension), WriteFailed, Cancelled. Memory: a few MiB. N = 2, 3, 4, 5.
template <int N>
void write_elements(const Elements<N>& elements, const std::filesystem::path& path,
                    const ElementFileOptions& options = {});

/// The names of the columns that the text has, such as t x y z dsigma_t dsigma_x dsigma_y dsigma_z T: axes without a
/// name are x, y, z, t (and u in 5D), attributes of several numbers NAME_0, NAME_1 ...; blanks become '_'.
template <int N>
std::vector<std::string> element_columns(const Elements<N>& elements, const ElementFileOptions& options = {});

}  // namespace tegl
