// SPDX-License-Identifier: BSD-3-Clause
//
// The arrays of the tesseract's builder, as data and as C++ text.
#pragma once

#include <string>
#include <vector>

#include "builders/cube_lists.hpp"
#include "builders/cube_regions.hpp"
#include "cubes/resolved_cube.hpp"

namespace tegl::gen {

/// All arrays, by triangulation: barycentric, compact.
struct TesseractArrays {
  ResolvedCube cube;
  std::vector<tables::CubeJoin> joins;  ///< by entry of `cube`
  std::vector<CubeLists> lists;      ///< barycentric, compact
  std::vector<CubeRegions> regions;  ///< barycentric, compact; caps of both, for closed borders

  [[nodiscard]] std::size_t region_count() const;
  [[nodiscard]] unsigned most_triangles() const;  ///< maximum per list
};

/// Makes and certifies the arrays. Throws Error{CertificateFailed}.
[[nodiscard]] TesseractArrays make_tesseract_arrays();

/// The definitions of the arrays that builder4.hpp declares.
[[nodiscard]] std::string arrays_text(const TesseractArrays& arrays);

}  // namespace tegl::gen
