// SPDX-License-Identifier: BSD-3-Clause
//
// Joins the contours of several isovalues in one mesh, for --one-file.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "output/result.hpp"
#include "tegl/error.hpp"
#include "tegl/io/meshes.hpp"

namespace tegl::cli {

/// Appends the vertices and simplices of a contour, with the isovalue as an attribute of both.
inline void append_mesh(Mesh& all, Mesh&& one, double isovalue) {
  const auto name = std::string("isovalue");
  const std::size_t vertices =
      all.space_dim == one.space_dim ? all.coordinates.size() / static_cast<std::size_t>(all.space_dim) : 0;
  const std::size_t count = one.coordinates.size() / static_cast<std::size_t>(one.space_dim);
  const std::size_t simplices = one.simplices.size() / static_cast<std::size_t>(one.dim + 1);
  one.vertex_attributes.push_back({name, "", 1, Buffer<double>(count, isovalue)});
  one.simplex_attributes.push_back({name, "", 1, Buffer<double>(simplices, isovalue)});
  if (all.coordinates.empty()) {
    all = std::move(one);
    all.isovalue.reset();
    return;
  }
  if (vertices + count > std::numeric_limits<Index>::max())
    throw Error(ErrorCode::TooLarge, fmt::format("{} vertices in one file; expected at most {}", vertices + count,
                                                 std::numeric_limits<Index>::max()));
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(all.coordinates, one.coordinates);
  append(all.normals, one.normals);
  for (const Index vertex : one.simplices) all.simplices.push_back(static_cast<Index>(vertices + vertex));
  for (std::size_t i = 0; i < all.vertex_attributes.size(); ++i)
    append(all.vertex_attributes[i].values, one.vertex_attributes[i].values);
  for (std::size_t i = 0; i < all.simplex_attributes.size(); ++i)
    append(all.simplex_attributes[i].values, one.simplex_attributes[i].values);
}

/// Merges the contours of several isovalues into one mesh with the isovalue of each vertex and simplex. Their meshes
/// are empty afterwards.
inline ContourResult in_one_mesh(std::vector<ContourResult>& results) {
  ContourResult all = results.front();
  all.mesh = Mesh();
  all.isovalue.reset();
  for (std::size_t i = 0; i < results.size(); ++i) {
    ContourResult& one = results[i];
    all.isovalues.push_back(*one.isovalue);
    if (i > 0) {
      all.seconds.classify += one.seconds.classify;
      all.seconds.find += one.seconds.find;
      all.seconds.generate += one.seconds.generate;
      all.seconds.close += one.seconds.close;
      if (all.stats) all.stats->active_tiles += one.stats->active_tiles;
    }
    append_mesh(all.mesh, std::exchange(one.mesh, Mesh()), *one.isovalue);
  }
  return all;
}

}  // namespace tegl::cli
