// SPDX-License-Identifier: BSD-3-Clause
//
// Counts vertices that coincide in a file's format: a manifold contour far from the origin may become non-manifold in
// it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tegl/io/meshes.hpp"

namespace tegl::cli {

/// Number of distinct vertices of a mesh that coincide with others in a file.
struct LostVertices {
  std::uint64_t vertices = 0;   ///< vertices used by simplices
  std::uint64_t in_single = 0;  ///< of them, those that coincide in single precision only
  std::uint64_t by_place = 0;   ///< those that coincide in any precision, for formats without vertex numbers

  LostVertices& operator+=(const LostVertices& other);
  [[nodiscard]] std::uint64_t count() const { return in_single + by_place; }
  /// "261 of 928 vertices fall together (single precision)", for a line of a report; empty if there are none.
  [[nodiscard]] std::string text() const;
  /// A sentence with advice, naming the file; empty if there are none.
  [[nodiscard]] std::string remark(const std::filesystem::path& output) const;
};

/// Counts them for the format of `output`: only .gltf and .glb (single precision) and .stl (also without vertex
/// numbers) can have any. O(V log V) time for these; O(1) for others.
LostVertices lost_vertices(const MeshView& mesh, const std::filesystem::path& output);

}  // namespace tegl::cli
