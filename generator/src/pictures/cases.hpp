// SPDX-License-Identifier: BSD-3-Clause
//
// The catalogue of cases: a page for each dimension, with every class of signatures and what the tables do in it, drawn
// from the same builders as the tables.
#pragma once

#include <vector>

#include "tables/language.hpp"

namespace tegl::gen {

/// The page `<dim>d.md` (Markdown) and its pictures `<dim>d/*.svg`. 2D and 3D: each class in both alternatives. 4D: all
/// classes as a table; of those with a torus, cuts through the tile at five times. dim = 2, 3, 4.
[[nodiscard]] std::vector<EmittedFile> emit_cases(int dim);

}  // namespace tegl::gen
