// SPDX-License-Identifier: BSD-3-Clause
//
// The catalogue of cases: one page per dimension with every class of signatures and its contours in the tables, drawn
// by the builders of the tables.
#pragma once

#include <vector>

#include "tables/language.hpp"

namespace tegl::gen {

/// Returns the page `<dim>d.md` (Markdown) and its pictures `<dim>d/*.svg`. 2D and 3D: each class in both alternatives.
/// 4D: a table of all classes; for classes with a torus also cuts of the tile at five times. Errors: InvalidArgument
/// unless dim is 2, 3 or 4.
[[nodiscard]] std::vector<EmittedFile> emit_cases(int dim);

}  // namespace tegl::gen
