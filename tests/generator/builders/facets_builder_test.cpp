// SPDX-License-Identifier: BSD-3-Clause
//
// The emitted builder of facets, as compiled; copies of it with one fault each; and its certificate.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.hpp"
#include "builder4_facets.hpp"
#include "builders/cube_facets.hpp"
#include "builders/tesseract_arrays.hpp"
#include "facets_checks.hpp"
#include "facets_swapped_ends.hpp"
#include "facets_wrong_cube.hpp"
#include "facets_wrong_group.hpp"
#include "facets_wrong_number.hpp"
#include "facets_wrong_part.hpp"
#include "facets_wrong_square.hpp"

namespace tegl::test {
namespace {

#define TEGL_FACETS(space) FacetFinder<space::FaceFacets, space::TesseractFacets>()

TEST(FacetsBuilder, RandomTesseractsHaveTheFacetsOfTheGeneralBuilder) {
  EXPECT_EQ(fault_of_random_facets(TEGL_FACETS(builders), 6000), "");
}

TEST(FacetsBuilder, CopiesWithAFaultAreFound) {
  EXPECT_NE(fault_of_random_facets(TEGL_FACETS(builders::facets_swapped_ends), 6000), "");
  EXPECT_NE(fault_of_random_facets(TEGL_FACETS(builders::facets_wrong_cube), 6000), "");
  EXPECT_NE(fault_of_random_facets(TEGL_FACETS(builders::facets_wrong_group), 6000), "");
  EXPECT_NE(fault_of_random_facets(TEGL_FACETS(builders::facets_wrong_number), 6000), "");
  EXPECT_NE(fault_of_random_facets(TEGL_FACETS(builders::facets_wrong_part), 6000), "");
  EXPECT_NE(fault_of_random_facets(TEGL_FACETS(builders::facets_wrong_square), 6000), "");
}

/// What the certificate says of the facets; "" if it accepts them.
std::string verdict(const gen::CubeLists& lists, const std::vector<gen::CubeFacets>& facets) {
  try {
    gen::certify_cube_facets(lists, facets);
  } catch (const gen::Error& error) {
    return error.what();
  }
  return "";
}

TEST(FacetsBuilder, TheCertificateFindsEveryChangedEntry) {
  const gen::CubeLists lists = gen::make_tesseract_arrays().lists.back();
  const std::vector<gen::CubeFacets> facets = gen::make_cube_facets(lists);
  EXPECT_EQ(verdict(lists, facets), "");
  // every list has a facet with each of these faults in turn
  for (std::size_t i = 0; i < facets.size(); i += 37)
    for (int fault = 0; fault < 6; ++fault) {
      std::vector<gen::CubeFacets> changed = facets;
      std::vector<gen::FaceFacet>& of = changed[i].facets;
      std::vector<gen::FacetBound>& bounds = of[i % of.size()].bounds;
      gen::FacetBound& bound = bounds[i % bounds.size()];
      if (fault == 0) bound.sign = static_cast<std::int8_t>(-bound.sign);
      if (fault == 1) bound.number ^= 1u;
      if (fault == 2) bound.face ^= 1u;
      if (fault == 3) std::swap(bounds[0], bounds[1]);
      if (fault == 4) bounds.pop_back();
      if (fault == 5) of.push_back(of.front());
      EXPECT_NE(verdict(lists, changed), "") << "list " << i << ", fault " << fault;
    }
}

}  // namespace
}  // namespace tegl::test
