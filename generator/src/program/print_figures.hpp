// SPDX-License-Identifier: BSD-3-Clause
//
// The figures of a certified table as text and as JSON, for all commands that certify.
#pragma once

#include <string>

#include "base/lattice.hpp"
#include "tables/table_set.hpp"

namespace tegl::gen {

void print_figures(TileKind tile, int dim, const CertifiedFigures& f);

std::string figures_json(const CertifiedFigures& f);

}  // namespace tegl::gen
