// SPDX-License-Identifier: BSD-3-Clause
//
// The names of mesh cells on the command line.
#pragma once

#include <array>
#include <string_view>

namespace tegl::gen {

/// A value of `--tile`.
struct CellName {
  std::string_view given;  ///< on the command line
  std::string_view shape;  ///< as in tables::CellShape
  int dim;                 ///< dimension
};

/// All cells except the octahedron, which is a tile kind, too.
inline constexpr std::array kCellNames{CellName{"triangle", "triangle", 2},
                                       CellName{"quadrilateral", "quadrilateral", 2},
                                       CellName{"tetrahedron", "tetrahedron", 3},
                                       CellName{"wedge", "wedge", 3},
                                       CellName{"pyramid", "pyramid", 3},
                                       CellName{"hexahedron", "hexahedron", 3},
                                       CellName{"simplex4", "simplex4", 4},
                                       CellName{"prism:tetrahedron", "tetrahedron_prism", 4},
                                       CellName{"prism:wedge", "wedge_prism", 4},
                                       CellName{"prism:pyramid", "pyramid_prism", 4},
                                       CellName{"prism:hexahedron", "hexahedron_prism", 4},
                                       CellName{"prism:octahedron", "octahedron_prism", 4},
                                       CellName{"cross4", "cell16", 4}};

}  // namespace tegl::gen
