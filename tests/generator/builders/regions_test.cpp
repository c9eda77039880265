// SPDX-License-Identifier: BSD-3-Clause
//
// The regions of cubes consist of positive tetrahedra at random positions of the contour's vertices. The positions and
// volumes are computed here, apart from the proof.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "builders/tesseract_arrays.hpp"
#include "embedding/region_proof.hpp"
#include "tegl/tile/corners.hpp"

namespace tegl::gen {
namespace {

using Position = std::array<double, 3>;
using Positions = std::array<Position, CubeRegions::kVertices>;

constexpr unsigned kFirstEdge = CubeRegions::kFirstEdge, kFirstOwn = CubeRegions::kFirstOwn,
                   kFirstCentre = CubeRegions::kFirstCentre;

double six_volumes(const Position& a, const Position& b, const Position& c, const Position& d) {
  std::array<Position, 3> m{};
  for (std::size_t i = 0; i < 3; ++i) m[0][i] = b[i] - a[i], m[1][i] = c[i] - a[i], m[2][i] = d[i] - a[i];
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

/// Random positions of a list's vertices: uniform on edges and rays, or near their ends.
class RandomPositions {
 public:
  Positions operator()(const CubeLists::List& list, bool near_ends) {
    Positions result{};
    for (unsigned v = 0; v < 8; ++v) result[v] = corner(v);
    for (unsigned e = 0; e < 12; ++e) {
      result[kFirstEdge + e] = corner(detail::edge_base(3, e));
      result[kFirstEdge + e][e / 4] = share(near_ends);
    }
    for (unsigned j = 0; j < list.own_vertices; ++j) {
      const std::uint32_t mask = list.masks[j];
      Position& own = result[kFirstOwn + j] = mean(result, mask, 0.1);
      const double level = share(near_ends);  // for a mean of corners: on a ray from the cube's centre
      for (double& x : own) x = (mask & 0xffu) != 0 ? 0.5 + level * (mean_of_axis(mask, &x - own.data()) - 0.5) : x;
    }
    return result;
  }

  static void add_centres(Positions& positions, std::span<const std::uint32_t> masks) {
    for (std::size_t j = 0; j < masks.size(); ++j)
      positions[kFirstCentre + j] = masks[j] >= CubeRegions::kFirstDouble
                                        ? positions[std::countr_zero(masks[j])]
                                        : mean(positions, masks[j], masks[j] >> 8 != 0 ? 0.01 : 0.0);
  }

 private:
  static Position corner(unsigned v) {
    return {static_cast<double>(v & 1u), static_cast<double>(v >> 1 & 1u), static_cast<double>(v >> 2)};
  }
  static double mean_of_axis(std::uint32_t corners, std::ptrdiff_t axis) {
    double sum = 0;
    for (unsigned v = 0; v < 8; ++v) sum += (corners >> v & 1u) != 0 ? static_cast<double>(v >> axis & 1u) : 0.0;
    return sum / std::popcount(corners & 0xffu);
  }
  static Position mean(const Positions& of, std::uint32_t mask, double step) {
    Position sum{};
    double weight = 0;
    for (unsigned v = 0; v < 20; ++v) {
      if ((mask >> v & 1u) == 0) continue;
      for (std::size_t i = 0; i < 3; ++i) sum[i] += (1.0 + step * v) * of[v][i];
      weight += 1.0 + step * v;
    }
    for (double& x : sum) x /= weight;
    return sum;
  }
  double share(bool near_ends) {
    const double x = std::uniform_real_distribution<double>(0.001, 0.999)(random_);
    return near_ends ? 1.0 / (1.0 + std::exp(14.0 * (x - 0.5))) : x;
  }

  std::mt19937_64 random_{1994};
};

/// "" if all tetrahedra of a region have its side's orientation; else the fault.
std::string fault_of_region(const CubeRegions& regions, const CubeRegions::Region& region, bool high,
                            Positions positions) {
  RandomPositions::add_centres(positions, std::span(regions.centres).subspan(region.first_centre, region.centre_count));
  constexpr double kLeast = 1e-15;
  for (std::size_t t = 0; t < region.tetrahedron_count; ++t) {
    const auto& [a, b, c, d] = regions.tetrahedra[region.first_tetrahedron + t];
    const bool is_wall = region.centre_count == 1 && positions[a] == positions[kFirstCentre] &&
                         (positions[b] == positions[a] || positions[c] == positions[a] || positions[d] == positions[a]);
    if (is_wall) continue;  // parallel to the rays
    const double volume = six_volumes(positions[a], positions[b], positions[c], positions[d]);
    if (high ? volume >= -kLeast : volume <= kLeast)
      return fmt::format("{} side: tetrahedron ({} {} {} {}) has six times the volume {}", high ? "high" : "low", a, b,
                         c, d, volume);
  }
  return "";
}

/// "" if all tetrahedra of the regions of one side of a list have the side's orientation; else the region.
std::string fault_of_side(const CubeLists& lists, const CubeRegions& regions, std::size_t list, bool high,
                          const Positions& positions) {
  const std::size_t side = 2 * list + (high ? 1 : 0);
  for (std::size_t r = regions.first_region[side]; r < regions.first_region[side + 1]; ++r) {
    const CubeRegions::Region& region = regions.regions[r];
    if (const std::string fault = fault_of_region(regions, region, high, positions); !fault.empty())
      return fmt::format("list {} of signature {}, {}", list, lists.lists[list].signature, fault);
  }
  return "";
}

std::string fault_of_regions(const CubeLists& lists, const CubeRegions& regions, int positions) {
  RandomPositions random;
  for (std::size_t list = 0; list < lists.lists.size(); ++list)
    for (int i = 0; i < positions; ++i) {
      const Positions at = random(lists.lists[list], i % 2 == 1);
      for (const bool high : {false, true})
        if (std::string fault = fault_of_side(lists, regions, list, high, at); !fault.empty()) return fault;
    }
  return "";
}

TEST(RegionProof, KnowsTheSignsOfTetrahedraForAllPositions) {
  const RegionProof proof;
  using Sign = RegionProof::Sign;
  const auto edge = [](unsigned e) { return RegionProof::Points{1} << (8 + e); };
  EXPECT_EQ(proof.sign(1, 2, 4, 16), Sign::positive);
  EXPECT_EQ(proof.sign(2, 1, 4, 16), Sign::negative);
  EXPECT_EQ(proof.sign(1, 2, 4, 8), Sign::zero);
  EXPECT_EQ(proof.sign(1, edge(0), edge(4), edge(8)), Sign::positive);  // a corner cut off
  EXPECT_EQ(proof.sign(1, edge(0), edge(4), edge(0)), Sign::zero);
  EXPECT_EQ(proof.sign(edge(0), edge(1), edge(2), edge(3)), Sign::mixed);  // four parallel edges
  // the centre of the square x = 0 on its ray sees the square from inside
  const auto ray = RegionProof::on_ray(0x55);
  EXPECT_EQ(proof.sign(ray, 1, 16, 4), Sign::positive);
  EXPECT_EQ(proof.sign(ray, 1, 4, 16), Sign::negative);
}

TEST(CubeRegions, TetrahedraOfAllRegionsArePositiveAtRandomPositions) {
  const TesseractArrays arrays = make_tesseract_arrays();
  EXPECT_EQ(fault_of_regions(arrays.lists[0], arrays.regions[0], 40), "");
  EXPECT_EQ(fault_of_regions(arrays.lists[1], arrays.regions[1], 40), "");
  for (std::size_t i = 0; i < arrays.regions.size(); ++i)  // caps: high sides only
    EXPECT_EQ(arrays.regions[i].regions.size(), i < 2 ? 2346u : 1173u);
}

TEST(CubeRegions, TetrahedraOfCapsArePositiveAtRandomPositions) {
  const TesseractArrays arrays = make_tesseract_arrays();
  EXPECT_EQ(fault_of_regions(arrays.lists[0], arrays.regions[2], 40), "");
  EXPECT_EQ(fault_of_regions(arrays.lists[1], arrays.regions[3], 40), "");
}

TEST(CubeRegions, AFaultInOneRegionIsFoundByItsList) {
  TesseractArrays arrays = make_tesseract_arrays();
  CubeRegions& regions = arrays.regions[1];
  const std::size_t list = 400;
  const CubeRegions::Region& region = regions.regions[regions.first_region[2 * list]];
  CubeRegions::Tetrahedron& changed = regions.tetrahedra[region.first_tetrahedron];
  std::swap(changed[0], changed[1]);
  const std::string name =
      fmt::format("list {} of signature {}, low side", list, arrays.lists[1].lists[list].signature);
  EXPECT_EQ(fault_of_regions(arrays.lists[1], regions, 2).substr(0, name.size()), name);
}

}  // namespace
}  // namespace tegl::gen
