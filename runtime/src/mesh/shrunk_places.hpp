// SPDX-License-Identifier: BSD-3-Clause
//
// Finds where replacing vertices by others changes the topology of a contour.
//
// Replacing vertices is a simplicial map. It keeps the topology if everything that it maps to one point is contractible
// and nothing of its image is dropped. So two kinds of places are found: groups of vertices with one replacement whose
// simplices among themselves are not contractible (by the Euler characteristic of each component, 1 for a point, an arc
// or a disc, 0 for a ring), and faces that collapsed simplices become and that no other simplex has.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// The places where vertices are replaced in simplices of N vertices.
template <int N>
class ShrunkPlaces {
 public:
  using Simplex = std::array<Index, N>;
  /// `kept`: by vertex, the vertex that replaces it.
  ShrunkPlaces(std::span<const Simplex> simplices, std::span<const Index> kept) : simplices_(simplices), kept_(kept) {}

  /// Vertices at the places, at least one of each, by replacement and number.
  std::vector<Index> find() {
    for (const Simplex& simplex : simplices_) add_collapsed(simplex);
    std::vector<Index> found = not_contractible();
    add_dropped(found);
    std::sort(found.begin(), found.end(), [&](Index a, Index b) {
      return std::pair{kept_[a], a} < std::pair{kept_[b], b};
    });
    return found;
  }

 private:
  /// The vertices of a face, ascending; unused ones are kNone.
  using Face = std::array<Index, N>;
  static constexpr Index kNone = std::numeric_limits<Index>::max();

  /// The face of some vertices of a simplex, without repetitions.
  static Face face_of(const Simplex& simplex, unsigned set) {
    Face face;
    face.fill(kNone);
    for (std::size_t j = 0, count = 0; j < N; ++j)
      if ((set >> j & 1u) != 0) face[count++] = simplex[j];
    std::sort(face.begin(), face.end());
    const auto end = std::unique(face.begin(), std::find(face.begin(), face.end(), kNone));
    std::fill(end, face.end(), kNone);
    return face;
  }
  static std::size_t size_of(const Face& face) {
    return static_cast<std::size_t>(std::find(face.begin(), face.end(), kNone) - face.begin());
  }
  static void make_unique(std::vector<Face>& faces) {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  }

  [[nodiscard]] Simplex replaced(const Simplex& simplex) const {
    Simplex result;
    for (std::size_t j = 0; j < N; ++j) result[j] = kept_[simplex[j]];
    return result;
  }

  /// Adds the faces of a simplex that become points, and the face that it becomes.
  void add_collapsed(const Simplex& simplex) {
    const Simplex to = replaced(simplex);
    if (!is_collapsed<N>(to.data())) return;
    const Face image = face_of(to, kAll);
    if (size_of(image) > 1) images_.push_back(image);
    for (unsigned set = 1; set <= kAll; ++set) {
      const Face face = face_of(simplex, set);
      if (size_of(face) > 1 && size_of(face_of(to, set)) == 1) within_.push_back(face);
    }
  }

  /// Vertices of groups that are not contractible.
  std::vector<Index> not_contractible() {
    make_unique(within_);
    std::vector<Index> vertices;
    for (const Face& face : within_)
      vertices.insert(vertices.end(), face.begin(), std::find(face.begin(), face.end(), kNone));
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    const auto number = [&](Index v) {
      return static_cast<std::size_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
    };
    BasicDisjointSets<std::size_t> groups(vertices.size());
    for (const Face& face : within_) groups.join(number(face[0]), number(face[1]));
    std::vector<std::int64_t> euler(vertices.size(), 0);
    for (std::size_t i = 0; i < vertices.size(); ++i) ++euler[groups.find(i)];
    for (const Face& face : within_) euler[groups.find(number(face[0]))] += size_of(face) % 2 == 1 ? 1 : -1;
    std::vector<Index> result;
    for (std::size_t i = 0; i < vertices.size(); ++i)
      if (groups.find(i) == i && euler[i] != 1) result.push_back(vertices[i]);
    return result;
  }

  /// Adds the vertices of faces that collapsed simplices become and that no other simplex has.
  void add_dropped(std::vector<Index>& found) {
    make_unique(images_);
    std::vector<bool> stays(images_.size(), false);
    if (images_.empty()) return;
    std::vector<bool> is_in_image(kept_.size(), false);
    for (const Face& face : images_)
      for (std::size_t j = 0; j < size_of(face); ++j) is_in_image[face[j]] = true;
    for (const Simplex& simplex : simplices_) {
      const Simplex to = replaced(simplex);
      if (std::none_of(to.begin(), to.end(), [&](Index v) { return is_in_image[v]; })) continue;
      if (is_collapsed<N>(to.data())) continue;
      for (unsigned set = 1; set < kAll; ++set) {
        const Face face = face_of(to, set);
        const auto at = std::lower_bound(images_.begin(), images_.end(), face);
        if (at != images_.end() && *at == face) stays[static_cast<std::size_t>(at - images_.begin())] = true;
      }
    }
    for (std::size_t i = 0; i < images_.size(); ++i)
      if (!stays[i])
        found.insert(found.end(), images_[i].begin(), std::find(images_[i].begin(), images_[i].end(), kNone));
  }

  static constexpr unsigned kAll = (1u << N) - 1;
  std::span<const Simplex> simplices_;
  std::span<const Index> kept_;
  std::vector<Face> within_;  ///< faces of at least two vertices that become points
  std::vector<Face> images_;  ///< faces of at least two vertices that collapsed simplices become
};

}  // namespace tegl::detail
