// SPDX-License-Identifier: BSD-3-Clause
//
// Look-up of the simplices of Sigma's own triangulation, face by face, for certificate (4).
#include "filling/sigma_complex.hpp"

#include <algorithm>

namespace tegl::gen {

namespace {

Key key_of_triangle(std::uint8_t a, std::uint8_t b, std::uint8_t c) { return key_of({a, b, c, 0}, 3); }

}  // namespace

SigmaComplex::SigmaComplex(const FaceContours& faces, const std::vector<LocalSimplex>& component) : faces_(faces) {
  for (const LocalSimplex& s : component) {
    triangles_.push_back(key_of_triangle(s[0], s[1], s[2]));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (i != j) adjacent_[s[i]].set(s[j]);
  }
  std::sort(triangles_.begin(), triangles_.end());
}

bool SigmaComplex::allows_triangle(std::uint8_t a, std::uint8_t b, std::uint8_t c) const {
  if ((faces_.faces_of(a) & faces_.faces_of(b) & faces_.faces_of(c)) == 0) return true;
  return std::binary_search(triangles_.begin(), triangles_.end(), key_of_triangle(a, b, c));
}

bool SigmaComplex::allows(const LocalSimplex& t) const {
  std::uint32_t common = ~0u;
  for (int i = 0; i < 4; ++i) {
    common &= faces_.faces_of(t[i]);
    for (int j = 0; j < i; ++j)
      if ((faces_.faces_of(t[i]) & faces_.faces_of(t[j])) != 0 && !adjacent_[t[i]].test(t[j])) return false;
  }
  return common == 0 && allows_triangle(t[0], t[1], t[2]) && allows_triangle(t[0], t[1], t[3]) &&
         allows_triangle(t[0], t[2], t[3]) && allows_triangle(t[1], t[2], t[3]);
}

}  // namespace tegl::gen
