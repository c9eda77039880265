// SPDX-License-Identifier: BSD-3-Clause
//
// Proofs for surfaces in a cube, by the proof for tiles.
#include "cubes/cube_embedding.hpp"

#include <algorithm>
#include <cstddef>

namespace tegl::gen {

namespace {

std::vector<EmbeddingProof::Ray> rays_of(std::span<const std::uint32_t> masks) {
  std::vector<EmbeddingProof::Ray> rays;
  for (const std::uint32_t mask : masks)
    if (is_on_ray(mask)) rays.push_back(ray_of(mask));
  return rays;
}

constexpr std::size_t kTriangles = 560;  ///< sets of three of 16 vertices
constexpr std::int8_t kUnknown = -1;

/// The number of the set of a triangle's vertices.
std::size_t number_of(CubeTriangle t) {
  std::sort(t.begin(), t.end());
  return std::size_t{t[2]} * (t[2] - 1u) * (t[2] - 2u) / 6 + std::size_t{t[1]} * (t[1] - 1u) / 2 + t[0];
}

}  // namespace

CubeEmbedding::CubeEmbedding(const CubeFrame& frame, std::span<const std::uint32_t> masks)
    : proof_(frame.cube(), rays_of(masks)) {
  for (std::uint8_t e = 0; e < CubeFrame::kEdges; ++e) number_.push_back(e);
  auto ray = static_cast<std::uint8_t>(CubeFrame::kEdges);
  first_mean_ = CubeFrame::kEdges + rays_of(masks).size();
  for (const std::uint32_t mask : masks) {
    number_.push_back(is_on_ray(mask) ? ray++ : static_cast<std::uint8_t>(first_mean_ + means_.size()));
    if (!is_on_ray(mask)) means_.push_back(mask >> 8 & 0xfffu);
  }
}

LocalSimplex CubeEmbedding::local(const CubeTriangle& triangle) const {
  return {number_[triangle[0]], number_[triangle[1]], number_[triangle[2]], 0};
}

std::vector<LocalSimplex> CubeEmbedding::local(const CubeTriangles& triangles) const {
  std::vector<LocalSimplex> result;
  for (const CubeTriangle& t : triangles) result.push_back(local(t));
  return result;
}

bool CubeEmbedding::is_embedded(const CubeTriangles& triangles) const {
  const std::vector<LocalSimplex> simplices = local(triangles);
  const auto has_mean = [&](const LocalSimplex& s) {
    return std::any_of(s.begin(), s.begin() + 3, [&](std::uint8_t v) { return v >= first_mean_; });
  };
  // The cone from a mean, which is inside the cube, to segments of its boundary is not flat.
  return std::none_of(simplices.begin(), simplices.end(),
                      [&](const LocalSimplex& s) { return !has_mean(s) && proof_.may_be_flat(s); }) &&
         proof_.holds(simplices, means_);
}

bool CubeEmbedding::holds_between(const CubeTriangles& first, const CubeTriangles& second) const {
  return proof_.holds_between(local(first), local(second), means_);
}

bool CubeEmbedding::may_add(const CubeTriangle& triangle, const CubeTriangles& others) {
  if (are_apart_.empty()) are_apart_.assign(kTriangles * kTriangles, kUnknown);
  const LocalSimplex one = local(triangle);
  std::int8_t* const row = are_apart_.data() + kTriangles * number_of(triangle);
  return std::all_of(others.begin(), others.end(), [&](const CubeTriangle& other) {
    std::int8_t& are_apart = row[number_of(other)];
    if (are_apart == kUnknown) {
      const LocalSimplex two = local(other);
      are_apart = proof_.holds_between({&one, 1}, {&two, 1}, means_) ? 1 : 0;
    }
    return are_apart != 0;
  });
}

}  // namespace tegl::gen
