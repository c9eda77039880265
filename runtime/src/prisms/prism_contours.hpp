// SPDX-License-Identifier: BSD-3-Clause
//
// The contours of prisms over polyhedra, built when an extraction meets the cells.
#pragma once

#include <span>
#include <vector>

#include "polytope/polytope_contours.hpp"

namespace tegl::detail {

/// As build_polytope_contours, for polytopes that are prisms over polyhedra (4D).
[[nodiscard]] std::vector<PolytopeBlock> build_prism_contours(const Polytopes& prisms, std::span<const double> values,
                                                              const PolytopeRules& rules,
                                                              const std::vector<Index>* listed,
                                                              const WorkOptions& work);

}  // namespace tegl::detail
