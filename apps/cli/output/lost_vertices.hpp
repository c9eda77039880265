// SPDX-License-Identifier: BSD-3-Clause
//
// Vertices that a file's format cannot tell apart: a sound contour far from the origin is no manifold any more in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tegl/io.hpp"

namespace tegl::cli {

/// How many vertices fall together with others in a file, though the mesh tells them apart.
struct LostVertices {
  std::uint64_t vertices = 0;   ///< that simplices have
  std::uint64_t in_single = 0;  ///< of them, those that are at another's place in single precision only
  std::uint64_t by_place = 0;   ///< those that are at another's place in any, where a format has no numbers of vertices

  LostVertices& operator+=(const LostVertices& other);
  [[nodiscard]] std::uint64_t count() const { return in_single + by_place; }
  /// "261 of 928 vertices fall together (single precision)", for a line of a report; empty without any.
  [[nodiscard]] std::string text() const;
  /// A sentence with what to do, naming the file; empty without any.
  [[nodiscard]] std::string remark(const std::filesystem::path& output) const;
};

/// Those of a mesh in the format that `output` names: none but in .gltf and .glb (single precision) and .stl (and no
/// numbers). O(V log V) time there; else nothing is looked at.
LostVertices lost_vertices(const Mesh& mesh, const std::filesystem::path& output);

}  // namespace tegl::cli
