// SPDX-License-Identifier: BSD-3-Clause
//
// Writes elements of contours to files: the text format of Cornelius' programs, and HDF5. Link with tegl::io; not
// thread-safe, as all of tegl/io.hpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tegl/elements.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// The order of coordinates and components in a file. time_first: the last axis first, then the others (t x y z), as in
/// codes for freeze-out surfaces; as_is: as in the contour (x y z t).
enum class ElementAxes { time_first, as_is };

/// covariant: d sigma_mu, as Elements::normals. contravariant: d sigma^mu by the metric (+, -, -, -), whose + is the
/// last axis: all components except that one change sign (in units with speed of light 1).
enum class ElementComponents { covariant, contravariant };

/// Options of write_elements.
struct ElementFileOptions {
  ElementAxes axes = ElementAxes::time_first;                   ///< which axis leads
  ElementComponents components = ElementComponents::covariant;  ///< how normals are written
  bool header = false;                                          ///< text: first line with column names, after a '#'
  WorkOptions work = {};                                        ///< progress; one thread writes
};

/// Writes elements, by extension.
///
/// .dat, .txt: one line per element, numbers separated by blanks: the N coordinates of the centroid, the N components
/// of the normal, then the attributes in their order, each with all its numbers. Numbers have the shortest digits that
/// read back as the same double; missing values are "nan". Without attributes this is the format of the programs that
/// come with Cornelius.
///
/// .h5, .hdf5: the datasets /centroid (#E x N), /dsigma (#E x N), /measure (#E), /simplices (#E, uint32: number of
/// simplices of the element) and /attributes/NAME (#E, or #E x width; a '/' in the name becomes '_'); type double
/// except where given. Each has the attribute "units": one unit, or one per column on separate lines; empty if unknown.
/// The file has the attributes "format" ("tegl elements 1"), "axes" (the column names, one per line), "components"
/// ("covariant", "contravariant") and "direction" ("descent", "ascent").
///
/// Written to a temporary name beside the target and renamed at the end, so there is never a partial file. Errors:
/// UnsupportedFormat (the extension), WriteFailed, Cancelled. Memory: a few MiB. N = 2, 3, 4, 5.
template <int N>
requires DimensionBetween<N, 2, 5>
void write_elements(const Elements<N>& elements, const std::filesystem::path& path,
                    const ElementFileOptions& options = {});

/// The column names of the text format, such as t x y z dsigma_t dsigma_x dsigma_y dsigma_z T. Axes without a name are
/// x, y, z, t (and u in 5D); attributes of several numbers become NAME_0, NAME_1 ...; blanks become '_'.
template <int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] std::vector<std::string> element_columns(const Elements<N>& elements,
                                                       const ElementFileOptions& options = {});

}  // namespace tegl
