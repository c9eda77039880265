// SPDX-License-Identifier: BSD-3-Clause
//
// The contours of 4D polytopes, built when an extraction meets the cells.
#pragma once

#include <span>
#include <vector>

#include "polytope/polytope_contours.hpp"

namespace tegl::detail {

/// As build_polytope_contours, for 4D polytopes.
[[nodiscard]] std::vector<PolytopeBlock> build_solid_contours(const Polytopes& polytopes,
                                                              std::span<const double> values,
                                                              const PolytopeRules& rules,
                                                              const std::vector<Index>* listed,
                                                              const WorkOptions& work);

}  // namespace tegl::detail
