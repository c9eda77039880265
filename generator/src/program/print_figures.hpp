// SPDX-License-Identifier: BSD-3-Clause
//
// The figures of a certified table as text, for all commands that certify.
#pragma once

#include "base/lattice.hpp"
#include "tables/table_set.hpp"

namespace tegl::gen {

void print_figures(TileKind tile, int dim, const CertifiedFigures& f);

}  // namespace tegl::gen
