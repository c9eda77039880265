// SPDX-License-Identifier: BSD-3-Clause
//
// The certificate that contours of cubes with resolved ambiguities are embedded, list by list.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cubes/cube_frame.hpp"
#include "cubes/resolved_cube.hpp"

namespace tegl::gen {

/// Proves lists with CubeEmbedding, from their triangles and masks only.
class CubeListCertifier {
 public:
  /// Proves that no two triangles intersect, for all positions. Throws Error{CertificateFailed} with `name` otherwise.
  void certify(const CubeTriangles& triangles, std::span<const std::uint32_t> masks, const std::string& name);
  [[nodiscard]] std::uint64_t proved() const { return proved_; }  ///< number of certified lists

 private:
  CubeFrame frame_;
  std::uint64_t proved_ = 0;
};

/// Certifies every list of a table. Returns their number.
std::uint64_t certify_embedding(const ResolvedCube& table);

}  // namespace tegl::gen
