// SPDX-License-Identifier: BSD-3-Clause
//
// Recognition of balls and spheres: by a shelling, otherwise by pseudomanifold test, recursion over links and collapse.
#include "tegl/tile/complex.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

#include "shelling.hpp"
#include "tegl/tile/disjoint_sets.hpp"

namespace tegl::tile {

namespace {

/// All faces, by dimension: faces[d] holds those with d + 1 vertices, sorted.
std::vector<Simplices> all_faces(const Simplices& simplices) {
  std::vector<Simplices> faces(static_cast<std::size_t>(size(simplices.front())));
  faces.back() = simplices;
  std::sort(faces.back().begin(), faces.back().end());
  for (std::size_t d = faces.size() - 1; d > 0; --d) {
    for (const Simplex& s : faces[d])
      for (int i = 0; i <= static_cast<int>(d); ++i) faces[d - 1].push_back(without(s, i));
    std::sort(faces[d - 1].begin(), faces[d - 1].end());
    faces[d - 1].erase(std::unique(faces[d - 1].begin(), faces[d - 1].end()), faces[d - 1].end());
  }
  return faces;
}

int euler_of(const std::vector<Simplices>& faces) {
  int sum = 0;
  for (std::size_t d = 0; d < faces.size(); ++d) sum += (d % 2 == 0 ? 1 : -1) * static_cast<int>(faces[d].size());
  return sum;
}

std::size_t index_in(const Simplices& sorted, const Simplex& s) {
  return static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), s) - sorted.begin());
}

/// Incidence graph of the faces of a complex, for collapses.
class Collapse {
 public:
  explicit Collapse(const std::vector<Simplices>& faces) : start_(faces.size()) {
    std::size_t total = 0;
    for (std::size_t d = 0; d < faces.size(); ++d) start_[d] = total, total += faces[d].size();
    down_.resize(total), up_.resize(total);
    top_ = start_.back();
    for (std::size_t d = 1; d < faces.size(); ++d)
      for (std::size_t j = 0; j < faces[d].size(); ++j)
        for (int i = 0; i <= static_cast<int>(d); ++i) {
          const std::size_t face = start_[d - 1] + index_in(faces[d - 1], without(faces[d][j], i));
          down_[start_[d] + j].push_back(face);
          up_[face].push_back(start_[d] + j);
        }
  }

  /// True if one of a few seeded tries collapses the complex to a point. If `open`, its first top simplex is removed
  /// before.
  [[nodiscard]] bool to_a_point(bool open) const {
    for (unsigned seed = 0; seed < kTries; ++seed)
      if (const Left left = one_try(open, seed); left.vertices + left.edges + left.others == 1) return true;
    return false;
  }

  /// True if a try ends with circles only. A remainder without free faces has no ends, so one of dimension 1 with as
  /// many edges as vertices consists of circles.
  [[nodiscard]] bool to_circles() const {
    for (unsigned seed = 0; seed < kTries; ++seed)
      if (const Left left = one_try(false, seed); left.others == 0 && left.edges > 0 && left.edges == left.vertices)
        return true;
    return false;
  }

 private:
  static constexpr unsigned kTries = 4;

  /// Numbers of faces left when no face is free.
  struct Left {
    std::size_t vertices = 0, edges = 0, others = 0;
  };

  [[nodiscard]] Left one_try(bool open, unsigned seed) const {
    std::vector<std::uint16_t> cofaces(down_.size());
    std::vector<bool> gone(down_.size());
    std::vector<std::size_t> free;
    for (std::size_t f = 0; f < down_.size(); ++f) cofaces[f] = static_cast<std::uint16_t>(up_[f].size());
    const auto remove = [&](std::size_t f) {
      gone[f] = true;
      for (const std::size_t g : down_[f])
        if (--cofaces[g] == 1) free.push_back(g);
    };
    // initially free faces
    for (std::size_t f = 0; f < down_.size(); ++f)
      if (cofaces[f] == 1) free.push_back(f);
    if (open) remove(top_);
    std::mt19937 random(seed);
    // collapse free faces in random order
    while (!free.empty()) {
      std::swap(free[random() % free.size()], free.back());
      const std::size_t f = free.back();
      free.pop_back();
      if (gone[f] || cofaces[f] != 1) continue;
      const std::size_t over = *std::find_if(up_[f].begin(), up_[f].end(), [&](std::size_t u) { return !gone[u]; });
      remove(over);  // no other coface: a face above `over` would give f two cofaces
      remove(f);
    }
    // count the remaining faces
    Left left;
    for (std::size_t f = 0; f < down_.size(); ++f)
      if (!gone[f]) ++(f < start_[1] ? left.vertices : start_.size() == 2 || f < start_[2] ? left.edges : left.others);
    return left;
  }

  std::vector<std::size_t> start_;
  std::vector<std::vector<std::size_t>> down_, up_;
  std::size_t top_ = 0;
};

/// Properties that follow from the faces of codimension one. Branching: one of them lies in more than two simplices.
struct Ridges {
  bool branching = false;
  bool connected = true;
  std::vector<VertexId> boundary_vertices{};  ///< sorted
};

Ridges ridges_of(const Simplices& simplices) {
  Ridges result;
  // ridge incidences, sorted so that equal ridges are adjacent
  std::vector<std::pair<Simplex, std::size_t>> ridges;
  for (std::size_t j = 0; j < simplices.size(); ++j)
    for (int i = 0; i < size(simplices[j]); ++i) ridges.emplace_back(without(simplices[j], i), j);
  std::sort(ridges.begin(), ridges.end());
  // sets of simplices that share ridges; a ridge in one simplex belongs to the boundary
  detail::BasicDisjointSets<std::size_t> sets(simplices.size());
  for (std::size_t i = 0; i < ridges.size();) {
    std::size_t j = i + 1;
    while (j < ridges.size() && ridges[j].first == ridges[i].first) ++j;
    if (j - i > 2) result.branching = true;
    if (j - i == 2) sets.join(ridges[i].second, ridges[i + 1].second);
    if (j - i == 1)
      for (int v = 0; v < size(ridges[i].first); ++v) result.boundary_vertices.push_back(ridges[i].first[v]);
    i = j;
  }
  for (std::size_t j = 1; j < simplices.size(); ++j) result.connected &= sets.find(j) == sets.find(0);
  auto& b = result.boundary_vertices;
  std::sort(b.begin(), b.end());
  b.erase(std::unique(b.begin(), b.end()), b.end());
  return result;
}

bool links_are_right(const Simplices& simplices, const Simplices& vertices, const std::vector<VertexId>& boundary) {
  for (const Simplex& v : vertices) {
    Simplices link;
    for (const Simplex& s : simplices)
      if (const auto at = std::find(s.begin(), s.end(), v[0]); at != s.end())
        link.push_back(without(s, static_cast<int>(at - s.begin())));
    const bool on_boundary = std::binary_search(boundary.begin(), boundary.end(), v[0]);
    if (shape_of(link) != (on_boundary ? Shape::ball : Shape::sphere)) return false;
  }
  return true;
}

/// Slower than a shelling, but recognises complexes for which no shelling is found.
Shape shape_by_collapse(const Simplices& simplices) {
  const Ridges ridges = ridges_of(simplices);
  if (ridges.branching || !ridges.connected) return Shape::other;
  const bool closed = ridges.boundary_vertices.empty();
  const std::vector<Simplices> faces = all_faces(simplices);
  const int even_sphere = faces.size() % 2 == 1 ? 2 : 0;
  if (euler_of(faces) != (closed ? even_sphere : 1)) return Shape::other;
  if (!Collapse(faces).to_a_point(closed)) return Shape::other;  // before the links: faster, and fails in most cases
  if (!links_are_right(simplices, faces[0], ridges.boundary_vertices)) return Shape::other;
  return closed ? Shape::sphere : Shape::ball;
}

}  // namespace

Shape shape_of(const Simplices& simplices) {
  if (simplices.empty()) return Shape::other;
  const int vertices = size(simplices.front());
  std::vector<std::uint32_t> all(simplices.size());
  std::iota(all.begin(), all.end(), std::uint32_t{0});
  Adjacency adjacency;
  if (!adjacency.build(simplices)) return Shape::other;
  const Shape shelled = Shelling().shape(simplices, adjacency, all, kNoVertex);
  return vertices <= 3 || shelled != Shape::other ? shelled : shape_by_collapse(simplices);
}

bool collapses_to_a_circle(const Simplices& simplices) {
  if (simplices.empty() || size(simplices.front()) < 2) return false;
  Adjacency adjacency;
  // Collapses preserve connectedness, so a connected complex ends in a single circle.
  return adjacency.build(simplices) && ridges_of(simplices).connected && Collapse(all_faces(simplices)).to_circles();
}

int euler_characteristic(const Simplices& simplices) { return simplices.empty() ? 0 : euler_of(all_faces(simplices)); }

}  // namespace tegl::tile
