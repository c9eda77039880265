// SPDX-License-Identifier: BSD-3-Clause
//
// The faces of the 5-cube as C++ text: the part of the builder of 5-cubes that depends on the tile.
#include "builders/five_cube_faces.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <iterator>
#include <vector>

#include "base/error.hpp"
#include "tegl/tile/corners.hpp"
#include "tegl/tile/face_lattice.hpp"

namespace tegl::gen {

namespace {

using namespace tegl::detail;
using tile::Signature;

constexpr unsigned kDim = 5;
constexpr unsigned kTesseracts = 2 * kDim;

struct CubeFace {
  unsigned base, axes;
};

/// Faces of dimension k by their axes as a bit set, then by their lowest corner.
std::vector<CubeFace> faces_of(int k) {
  std::vector<CubeFace> result;
  for (unsigned axes = 0; axes < 1u << kDim; ++axes)
    for (unsigned base = 0; std::popcount(axes) == k && base < 1u << kDim; ++base)
      if ((base & axes) == 0) result.push_back({base, axes});
  return result;
}

unsigned number_of(const std::vector<CubeFace>& faces, unsigned base, unsigned axes) {
  unsigned n = 0;
  while (faces[n].base != base || faces[n].axes != axes) ++n;
  return n;
}

/// Name of a face: axis 4 first, `e` for an axis that it spans.
std::string name_of(const CubeFace& face) {
  std::string name;
  for (unsigned a = kDim; a-- > 0;) name += (face.axes >> a & 1u) != 0 ? 'e' : (face.base >> a & 1u) != 0 ? '1' : '0';
  return name;
}

/// The spread bits of `bits` at the set bits of `axes`.
unsigned spread(unsigned bits, unsigned axes) {
  unsigned result = 0;
  for (unsigned a = 0; a < kDim; ++a)
    if ((axes >> a & 1u) != 0) {
      result |= (bits & 1u) << a;
      bits >>= 1;
    }
  return result;
}

unsigned nth_axis(unsigned n, unsigned axes) {
  for (unsigned a = 0;; ++a)
    if ((axes >> a & 1u) != 0 && n-- == 0) return a;
}

struct TesseractFace {
  CubeFace face;
  std::vector<unsigned> corners, edges, squares, cubes;
  bool is_reversed;
};

struct Faces {
  std::vector<CubeFace> squares = faces_of(2), cubes = faces_of(3);
  std::vector<std::vector<unsigned>> cube_corners{}, cube_edges{};
  std::vector<std::array<unsigned, 2>> edges{};
  std::vector<TesseractFace> tesseracts{};

  Faces() {
    for (unsigned e = 0; e < edge_count(kDim); ++e) {
      const unsigned base = edge_base(kDim, e);
      edges.push_back({base, base | 1u << e / 16});
    }
    for (const CubeFace& cube : cubes) {
      auto& corners = cube_corners.emplace_back();
      for (unsigned v = 0; v < 8; ++v) corners.push_back(cube.base | spread(v, cube.axes));
      auto& own_edges = cube_edges.emplace_back();
      for (unsigned e = 0; e < 12; ++e)
        own_edges.push_back(edge_number(kDim, nth_axis(e / 4, cube.axes), corners[edge_base(3, e)]));
    }
    for (unsigned f = 0; f < kTesseracts; ++f) tesseracts.push_back(tesseract(f));
  }

 private:
  static constexpr unsigned edge_count(unsigned n) { return n << (n - 1); }

  [[nodiscard]] TesseractFace tesseract(unsigned f) const {
    TesseractFace result{{f % 2 << f / 2, 31u ^ 1u << f / 2}, {}, {}, {}, {}, face_sign(f) < 0};
    for (unsigned v = 0; v < 16; ++v) result.corners.push_back(lifted_corner(f, v));
    for (unsigned e = 0; e < 32; ++e) result.edges.push_back(lifted_edge(kDim, f, e));
    // squares by the two axes that they do not span, then by their sides: as the builder of tesseracts numbers them
    for (unsigned c = 0; c < 4; ++c)
      for (unsigned d = c + 1; d < 4; ++d)
        for (unsigned sides = 0; sides < 4; ++sides)
          result.squares.push_back(number_of(squares, lifted_corner(f, (sides & 1u) << c | (sides >> 1) << d),
                                             spread(15u ^ 1u << c ^ 1u << d, result.face.axes)));
    for (unsigned c = 0; c < 8; ++c)
      result.cubes.push_back(
          number_of(cubes, lifted_corner(f, (c & 1u) << c / 2), spread(15u ^ 1u << c / 2, result.face.axes)));
    return result;
  }
};

Signature set_of(const auto& corners) {
  Signature set = 0;
  for (const unsigned v : corners) set |= Signature{1} << v;
  return set;
}

void write_squares(const Faces& faces, std::string& text) {
  text += "const std::array<FiveCube::Face, 80> FiveCube::kSquares{{\n";
  for (std::size_t q = 0; q < faces.squares.size(); ++q)
    fmt::format_to(std::back_inserter(text), "    {{{:2}, {:2}}},  // {}: {}\n", faces.squares[q].base,
                   faces.squares[q].axes, q, name_of(faces.squares[q]));
  text += "}};\n\n";
}

void write_cubes(const Faces& faces, std::string& text) {
  text += "const std::array<FiveCube::Cube, 40> FiveCube::kCubes{{\n";
  for (std::size_t c = 0; c < faces.cubes.size(); ++c)
    fmt::format_to(std::back_inserter(text), "    // {}: {}\n    {{{{{}, {}}}, {{{}}}, {{{}}}}},\n", c,
                   name_of(faces.cubes[c]), faces.cubes[c].base, faces.cubes[c].axes,
                   fmt::join(faces.cube_corners[c], ", "), fmt::join(faces.cube_edges[c], ", "));
  text += "}};\n\n";
}

/// Numbers separated by commas, 16 to a line; further lines are indented by six.
std::string wrapped(const std::vector<unsigned>& numbers) {
  std::string text;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : i % 16 == 0 ? ",\n      " : ", ", numbers[i]);
  return text;
}

void write_tesseracts(const Faces& faces, std::string& text) {
  text += "const std::array<FiveCube::Tesseract, 10> FiveCube::kTesseracts{{\n";
  for (unsigned f = 0; f < kTesseracts; ++f) {
    const TesseractFace& t = faces.tesseracts[f];
    fmt::format_to(std::back_inserter(text),
                   "    // {}: {}, x{} = {}\n    {{{{{}}},\n     {{{}}},\n     {{{}}},\n     {{{}}},\n     {}}},\n", f,
                   name_of(t.face), f / 2, f % 2, wrapped(t.corners), wrapped(t.edges), wrapped(t.squares),
                   wrapped(t.cubes), t.is_reversed);
  }
  text += "}};\n\n";
}

void write_edges(const Faces& faces, std::string& text) {
  text += "const std::array<std::array<std::uint8_t, 2>, 80> FiveCube::kEdges{{\n";
  for (std::size_t e = 0; e < faces.edges.size(); ++e) {
    if (e % 16 == 0) fmt::format_to(std::back_inserter(text), "    // along axis {}\n", e / 16);
    fmt::format_to(std::back_inserter(text), "{}{{{}, {}}},{}", e % 8 == 0 ? "    " : " ", faces.edges[e][0],
                   faces.edges[e][1], e % 8 == 7 ? "\n" : "");
  }
  text += "}};\n\n";
  text += "/// By tesseract: its edges.\nconstexpr std::array<std::array<std::uint64_t, 2>, 10> kEdgesOfTesseracts{{\n";
  for (const TesseractFace& t : faces.tesseracts) {
    std::array<std::uint64_t, 2> set{};
    for (const unsigned e : t.edges) set[e / 64] |= std::uint64_t{1} << (e % 64);
    fmt::format_to(std::back_inserter(text), "    {{{:#018x}, {:#06x}}},\n", set[0], set[1]);
  }
  text += "}};\n\n";
}

/// The signatures of the faces at x_a = 0 and 1: the corners at the lower end of axis a, moved together.
void write_signatures(std::string& text) {
  text +=
      "std::array<std::uint16_t, 10> FiveCube::signatures(std::uint32_t signature) noexcept {\n"
      "  std::array<std::uint16_t, 10> result{};\n  std::uint32_t s = 0;\n";
  for (unsigned f = 0; f < kTesseracts; ++f) {
    const unsigned axis = f / 2;
    // bits of the corners with coordinate 0 along the axis; each later axis closes one gap
    std::uint32_t mask = 0;
    for (unsigned v = 0; v < 32; ++v) mask |= (v >> axis & 1u) == 0 ? 1u << v : 0;
    fmt::format_to(std::back_inserter(text), "  s = signature{} & {:#010x};  // {}\n",
                   f % 2 == 0 ? std::string() : fmt::format(" >> {}", 1u << axis), mask,
                   name_of({f % 2 << axis, 31u ^ 1u << axis}));
    for (unsigned a = axis; a + 1 < kDim; ++a) {
      std::uint32_t kept = 0;
      for (unsigned v = 0; v < 32; ++v) kept |= (v >> (a + 1) & 1u) == 0 ? 1u << v : 0;
      fmt::format_to(std::back_inserter(text), "  s = (s | s >> {}) & {:#010x};\n", 1u << a, kept);
    }
    fmt::format_to(std::back_inserter(text), "  result[{}] = static_cast<std::uint16_t>(s);\n", f);
  }
  text += "  return result;\n}\n";
}

/// Sets of corners of squares and cubes, the two tesseracts around each cube, and the three cubes around each square.
void write_incidences(const Faces& faces, std::string& text) {
  const auto write = [&](const char* what, const char* type, const char* name, const auto& all, const auto& set) {
    fmt::format_to(std::back_inserter(text), "/// {}\nconstexpr std::array<{}, {}> {}{{{{\n", what, type, all.size(),
                   name);
    for (std::size_t i = 0; i < all.size(); ++i)
      fmt::format_to(std::back_inserter(text), "{}{:#x},{}", i % 8 == 0 ? "    " : " ", set(all[i]),
                     i % 8 == 7 ? "\n" : "");
    text += "}};\n\n";
  };
  const auto corners_of = [](const CubeFace& face) {
    std::uint64_t set = 0;
    for (unsigned v = 0; v < 1u << kDim; ++v)
      if ((v & ~face.axes) == face.base) set |= std::uint64_t{1} << v;
    return set;
  };
  const auto around = [&](const auto& larger, const CubeFace& face) {
    std::uint64_t set = 0;
    for (std::size_t i = 0; i < larger.size(); ++i)
      if ((corners_of(face) & ~corners_of(larger[i])) == 0) set |= std::uint64_t{1} << i;
    return set;
  };
  std::vector<CubeFace> tesseracts;
  for (const TesseractFace& t : faces.tesseracts) tesseracts.push_back(t.face);
  write("Corners of each square.", "std::uint32_t", "kCornersOfSquares", faces.squares, corners_of);
  write("Corners of each cube.", "std::uint32_t", "kCornersOfCubes", faces.cubes, corners_of);
  write("The cubes around each square.", "std::uint64_t", "kCubesOfSquares", faces.squares,
        [&](const CubeFace& square) { return around(faces.cubes, square); });
  write("The tesseracts around each cube.", "std::uint32_t", "kTesseractsOfCubes", faces.cubes,
        [&](const CubeFace& cube) { return around(tesseracts, cube); });
}

}  // namespace

std::string five_cube_faces() {
  const Faces faces;
  std::string text;
  write_squares(faces, text);
  write_cubes(faces, text);
  write_tesseracts(faces, text);
  write_edges(faces, text);
  write_incidences(faces, text);
  write_signatures(text);
  return text;
}

namespace {

/// Throws if a face is not as in the face lattice.
void require_face(bool holds, const char* what, unsigned number) {
  if (!holds)
    throw Error(ErrorCode::CertificateFailed, fmt::format("5-cube, {} {}: not as in the face lattice", what, number));
}

Signature corners_of_square(const Faces& faces, unsigned q) {
  std::vector<unsigned> corners;
  for (unsigned v = 0; v < 4; ++v) corners.push_back(faces.squares[q].base | spread(v, faces.squares[q].axes));
  return set_of(corners);
}

/// The faces of a tesseract, each once, at the corners that the frame of the tesseract gives them.
void certify_faces_of(const Faces& faces, unsigned f) {
  const TesseractFace& t = faces.tesseracts[f];
  for (unsigned e = 0; e < 32; ++e) {
    const unsigned base = edge_base(4, e);
    const std::array<unsigned, 2> ends = {t.corners[base], t.corners[base | 1u << e / 8]};
    require_face(set_of(ends) == set_of(faces.edges[t.edges[e]]), "tesseract", f);
  }
  for (unsigned c = 0; c < 8; ++c) {
    std::vector<unsigned> own;
    for (unsigned v = 0; v < 8; ++v) own.push_back(t.corners[lifted_corner(c, v)]);
    require_face(own == faces.cube_corners[t.cubes[c]], "tesseract", f);
  }
  unsigned q = 0;
  for (unsigned c = 0; c < 4; ++c)
    for (unsigned d = c + 1; d < 4; ++d)
      for (unsigned sides = 0; sides < 4; ++sides, ++q) {
        Signature own = 0;
        for (unsigned v = 0; v < 16; ++v)
          if ((v >> c & 1u) == (sides & 1u) && (v >> d & 1u) == sides >> 1) own |= Signature{1} << t.corners[v];
        require_face(own == corners_of_square(faces, t.squares[q]), "tesseract", f);
      }
}

}  // namespace

void certify_five_cube_faces() {
  const Faces faces;
  const tile::FaceLattice lattice = tile::FaceLattice::cube(kDim);
  const auto dim_of = [&](Signature corners) {
    const auto face = lattice.find(corners);
    return face ? lattice.faces()[*face].dim : -1;
  };
  for (unsigned e = 0; e < faces.edges.size(); ++e) require_face(dim_of(set_of(faces.edges[e])) == 1, "edge", e);
  for (unsigned q = 0; q < faces.squares.size(); ++q)
    require_face(dim_of(corners_of_square(faces, q)) == 2, "square", q);
  for (unsigned c = 0; c < faces.cubes.size(); ++c) {
    require_face(dim_of(set_of(faces.cube_corners[c])) == 3, "cube", c);
    for (unsigned e = 0; e < 12; ++e) {
      const unsigned base = edge_base(3, e);
      const std::array<unsigned, 2> ends = {faces.cube_corners[c][base], faces.cube_corners[c][base | 1u << e / 4]};
      require_face(set_of(ends) == set_of(faces.edges[faces.cube_edges[c][e]]), "cube", c);
    }
  }
  const auto& tesseracts = lattice.faces().back().faces;
  for (unsigned f = 0; f < faces.tesseracts.size(); ++f) {
    const TesseractFace& t = faces.tesseracts[f];
    const Signature corners = set_of(t.corners);
    const auto at = std::find_if(tesseracts.begin(), tesseracts.end(),
                                 [&](std::uint32_t g) { return lattice.faces()[g].corners == corners; });
    require_face(at != tesseracts.end(), "tesseract", f);
    require_face((lattice.faces().back().signs[static_cast<std::size_t>(at - tesseracts.begin())] < 0) == t.is_reversed,
                 "tesseract", f);
    certify_faces_of(faces, f);
  }
}

}  // namespace tegl::gen
