// SPDX-License-Identifier: BSD-3-Clause
//
// The definition of a contour in which every face has a centre that is high or low, in any dimension: components and
// Euler characteristics of the high and of the low part of a cube's boundary. It shares no code with the builders, nor
// with the other oracle (definition_oracle.hpp), in which cubes have no centres.
//
// If a face's centre belongs to a part, the part in the face is the cone from the centre to the part in the face's
// boundary; otherwise it is a collar of that, which adds nothing to its homotopy type. So each face whose centre
// belongs to a part joins what the part has in its boundary, X, and adds 1 - euler(X) to the Euler characteristic.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <utility>
#include <vector>

#include "definition_oracle.hpp"

namespace tegl::test {

/// The part of the boundary of an n-cube that contains the corners `inside`, n = 1 to 5.
class ConedPart {
 public:
  /// Whether the centre of the face along `axes` from corner `base` is in the part, for a face that has corners in it
  /// and others.
  using HasCentre = std::function<bool(unsigned base, unsigned axes)>;

  ConedPart(int n, Corners inside, const HasCentre& has_centre) {
    static const CubeFaces five(5);
    const std::vector<PolytopeFace>& faces = n == 5 ? five.faces : CubeFaces::of(n);
    std::vector<Corners> joined;
    std::vector<long> weights(faces.size());
    for (std::size_t f = 0; f + 1 < faces.size(); ++f) {
      const Corners of_part = faces[f].corners & inside;
      if (of_part == 0) continue;
      // An edge with one end in the part adds nothing in either case.
      if (of_part != faces[f].corners && (faces[f].dim == 1 || !has_centre(faces[f].base, faces[f].axes))) continue;
      weights[f] = 1;
      for (const std::size_t below : faces[f].below) weights[f] -= weights[below];
      joined.push_back(of_part);
    }
    components_ = merged(joined);
    eulers_.assign(components_.size(), 0);
    for (std::size_t f = 0; f + 1 < faces.size(); ++f)
      for (std::size_t c = 0; weights[f] != 0 && c < components_.size(); ++c)
        if ((faces[f].corners & components_[c]) != 0) eulers_[c] += weights[f];
  }

  [[nodiscard]] std::size_t components() const noexcept { return components_.size(); }
  /// Of all components.
  [[nodiscard]] std::multiset<long> eulers() const { return {eulers_.begin(), eulers_.end()}; }

 private:
  std::vector<Corners> components_;
  std::vector<long> eulers_;
};

/// The Euler characteristics of a tile's facets. If its centre is low, they are copies of the components of the high
/// part of its boundary; if it is high, of the low part. `is_high`: the centre of a face.
inline std::multiset<long> eulers_of_facets(int n, Corners high, bool centre_is_high,
                                            const ConedPart::HasCentre& is_high) {
  const Corners all = n == 5 ? ~Corners{0} : (Corners{1} << (1u << n)) - 1;
  if (high == 0 || high == all) return {};
  return ConedPart(n, centre_is_high ? all & ~high : high,
                   [&](unsigned base, unsigned axes) { return is_high(base, axes) != centre_is_high; })
      .eulers();
}

}  // namespace tegl::test
