// SPDX-License-Identifier: BSD-3-Clause
//
// Contours as facets, of any dimension and type behind one Python class.
#pragma once

#include <mutex>
#include <utility>
#include <variant>

#include "tegl/facet_hierarchy.hpp"

namespace tegl::python {

/// Facets of any dimension and type; `_tegl.Facets` in Python.
struct AnyFacets {
  using Hierarchy = std::variant<FacetHierarchy<2, float>, FacetHierarchy<3, float>, FacetHierarchy<4, float>,
                                 FacetHierarchy<2, double>, FacetHierarchy<3, double>, FacetHierarchy<4, double>>;

  AnyFacets(Hierarchy hierarchy, double level) : facets(std::move(hierarchy)), isovalue(level) {}

  Hierarchy facets;
  double isovalue;
  std::once_flag connected;  ///< connect_up was called
};

}  // namespace tegl::python
