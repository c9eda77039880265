// SPDX-License-Identifier: BSD-3-Clause
//
// Draws tiles as SVG. The normals of a convex tile's faces determine its hidden lines. Facets are painted from far to
// near.
#include "pictures/picture.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace tegl::gen {

namespace {

/// Styles of all elements, by class.
constexpr const char* kStyle =
    "<style>.edge,.rim,.segment,.mark{stroke-linecap:round}.edge{stroke:#555;stroke-width:1.4}.hidden{stroke:#8a8a8a;"
    "stroke-width:1.1;"
    "stroke-dasharray:4 "
    "4;stroke-linecap:butt}.high{fill:#1d1d1d;stroke:#fff}.low{fill:#fff;stroke:#555;stroke-width:1.3}"
    ".behind{opacity:.5}.side{fill-opacity:.93;stroke-width:.7}.rim{stroke:#3a3a3a;stroke-width:1.6}"
    ".mesh{stroke:#fff;stroke-opacity:.55;stroke-width:.8}.segment{stroke:#2f62a8;stroke-width:4}"
    ".towards{stroke:#f0a53c;stroke-width:4}.mark{stroke:#d4145a;stroke-width:5}"
    "text{font:13px sans-serif;fill:#555;text-anchor:middle}</style>\n";

using Colour = std::array<int, 3>;
constexpr Colour kHighSide{240, 165, 60}, kLowSide{95, 150, 215};

Place operator-(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Place operator+(const Place& a, const Place& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Place operator*(double f, const Place& a) { return {f * a[0], f * a[1], f * a[2]}; }
double dot(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Place cross(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Place unit(const Place& a) { return 1 / std::sqrt(std::max(dot(a, a), 1e-30)) * a; }

Place corner_place(const Tile& tile, std::uint32_t v) {
  return {tile.corners[v][0], tile.corners[v][1], tile.dim > 2 ? tile.corners[v][2] : 0.0};
}

Place mean_of(const std::vector<Place>& places) {
  Place sum{};
  for (const Place& p : places) sum = sum + p;
  return 1 / static_cast<double>(places.size()) * sum;
}

/// Orthographic view: the direction to the eye, and the axes of the picture.
struct View {
  Place right, up, eye;

  explicit View(int dim) {
    eye = dim == 2 ? Place{0, 0, 1} : unit({-0.28, -1.0, 0.48});
    right = dim == 2 ? Place{1, 0, 0} : unit(cross({0, 0, 1}, eye));
    up = cross(eye, right);
  }
};

/// Visible corners and edges of a tile: they belong to faces that point towards the eye.
struct Visible {
  std::vector<bool> corners, edges;

  Visible(const Tile& tile, const View& view) : corners(tile.corner_count()), edges(tile.edge_count()) {
    std::vector<Place> all;
    for (std::uint32_t v = 0; v < tile.corner_count(); ++v) all.push_back(corner_place(tile, v));
    const Place centre = mean_of(all);
    for (const SubTile& face : tile.faces) {
      if (tile.dim == 3) {
        std::vector<Place> places;
        for (const std::uint8_t v : face.corner) places.push_back(all[v]);
        Place normal = cross(places[1] - places[0], places[2] - places[0]);
        if (dot(normal, mean_of(places) - centre) < 0) normal = -1.0 * normal;
        if (dot(normal, view.eye) <= 0) continue;
      }
      for (const std::uint8_t v : face.corner) corners[v] = true;
      for (const std::uint8_t e : face.edge) edges[e] = true;
    }
  }
};

/// Collects SVG elements in picture coordinates and their bounding box.
class Canvas {
 public:
  Canvas(const View& view, double scale) : view_(view), scale_(scale) {}

  void line(const Place& a, const Place& b, const char* style) {
    const auto [ax, ay] = project(a);
    const auto [bx, by] = project(b);
    add("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>\n", ax, ay, bx, by, style);
  }
  void dot(const Place& p, double radius, const char* style) {
    const auto [x, y] = project(p);
    add("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" class=\"{}\"/>\n", x, y, radius, style);
  }
  void polygon(const std::vector<Place>& places, const std::string& style) {
    std::string points;
    for (const Place& p : places) {
      const auto [x, y] = project(p);
      points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", x, y);
    }
    add("<polygon points=\"{}\" {}/>\n", points, style);
  }

  /// The SVG element, standalone or placed at x inside another one. Grows `width` and `height` to include it.
  [[nodiscard]] std::string svg(const Picture& picture, bool alone, double x, double& width, double& height) const {
    constexpr double kMargin = 12, kCaption = 18;
    const double w = std::ceil(high_[0] - low_[0]) + 2 * kMargin;
    const double h = std::ceil(high_[1] - low_[1]) + 2 * kMargin + (picture.caption.empty() ? 0 : kCaption);
    const double left = low_[0] - kMargin, top = low_[1] - kMargin;
    std::string text = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" x=\"{0:.0f}\" width=\"{1:.0f}\" height=\"{2:.0f}\" "
        "viewBox=\"{3:.1f} {4:.1f} "
        "{1:.1f} {2:.1f}\">\n<title>{5}</title>\n{6}{7}",
        x, w, h, left, top, picture.title, alone ? kStyle : "", elements_);
    if (!picture.caption.empty())
      text += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", left + w / 2, top + h - 5, picture.caption);
    width = std::max(width, x + w);
    height = std::max(height, h);
    return text + "</svg>\n";
  }

 private:
  template <class... Values>
  void add(fmt::format_string<Values...> form, Values&&... values) {
    fmt::format_to(std::back_inserter(elements_), form, std::forward<Values>(values)...);
  }
  std::array<double, 2> project(const Place& p) {
    const std::array<double, 2> at{scale_ * gen::dot(p, view_.right), -scale_ * gen::dot(p, view_.up)};
    for (std::size_t i = 0; i < 2; ++i) {
      low_[i] = std::min(low_[i], at[i]);
      high_[i] = std::max(high_[i], at[i]);
    }
    return at;
  }

  const View& view_;
  double scale_;
  std::string elements_;
  std::array<double, 2> low_{1e9, 1e9}, high_{-1e9, -1e9};
};

const std::vector<LocalFacet>& facets_of(const PlacedTile& placed) {
  static const std::vector<LocalFacet> none{};
  return placed.contour == nullptr ? none : placed.contour->facets;
}

/// Draws the facets of one tile, far triangles first, then their outlines.
void draw_facets(const PlacedTile& placed, const View& view, Canvas& canvas) {
  struct Triangle {
    double depth;
    std::vector<Place> places;
    std::string style;
  };
  // collect the triangles of facets and patches
  std::vector<Triangle> triangles;
  std::vector<std::array<Place, 3>> all;
  for (const LocalFacet& facet : facets_of(placed))
    for (const LocalSimplex& s : facet.simplices)
      all.push_back({place_of(*placed.tile, facet, s[0]), place_of(*placed.tile, facet, s[1]),
                     place_of(*placed.tile, facet, s[2])});
  all.insert(all.end(), placed.patches.begin(), placed.patches.end());
  // shade each triangle; count triangles per side: a side of one triangle is a rim
  std::map<std::pair<Place, Place>, int> sides;
  for (const auto& corners : all) {
    for (std::size_t i = 0; i < 3; ++i) ++sides[std::minmax(corners[i], corners[(i + 1) % 3])];
    Triangle t;
    for (const Place& p : corners) t.places.push_back(placed.at + p);
    const Place normal = unit(cross(t.places[1] - t.places[0], t.places[2] - t.places[0]));
    const double facing = dot(normal, view.eye);
    const double light = 0.72 + 0.28 * std::abs(dot(normal, unit({0.2, -0.4, 1.0})));
    const Colour& base = facing > 0 ? kHighSide : kLowSide;
    const auto shade = [&](int i) { return static_cast<int>(std::lround(base[i] * light)); };
    t.depth = dot(mean_of(t.places), view.eye);
    const std::string colour = fmt::format("#{:02x}{:02x}{:02x}", shade(0), shade(1), shade(2));
    t.style = fmt::format("fill=\"{0}\" stroke=\"{0}\" class=\"side\"", colour);
    triangles.push_back(std::move(t));
  }
  // paint from far to near
  std::stable_sort(triangles.begin(), triangles.end(),
                   [](const Triangle& a, const Triangle& b) { return a.depth < b.depth; });
  for (const Triangle& t : triangles) canvas.polygon(t.places, t.style);
  for (const auto& [ends, count] : sides)
    canvas.line(placed.at + ends.first, placed.at + ends.second, count == 1 ? "rim" : "mesh");
}

/// 2D: draws segments, with a short stroke to their high side.
void draw_segments(const PlacedTile& placed, Canvas& canvas) {
  for (const LocalFacet& facet : facets_of(placed))
    for (const LocalSimplex& s : facet.simplices) {
      const Place a = placed.at + place_of(*placed.tile, facet, s[0]),
                  b = placed.at + place_of(*placed.tile, facet, s[1]);
      const Place along = unit(b - a), left{-along[1], along[0], 0};
      const Place middle = 0.5 * (a + b);
      canvas.line(middle, middle + 0.12 * left, "towards");
      canvas.line(a, b, "segment");
    }
}

void draw_edges(const PlacedTile& placed, const Visible& visible, bool hidden, Canvas& canvas) {
  const Tile& tile = *placed.tile;
  for (std::uint32_t e = 0; e < tile.edge_count(); ++e)
    if (visible.edges[e] != hidden)
      canvas.line(placed.at + corner_place(tile, tile.edges[e][0]), placed.at + corner_place(tile, tile.edges[e][1]),
                  hidden ? "hidden" : "edge");
}

/// Hidden corners are drawn paler, above the facets, so that the signature stays readable.
void draw_corners(const PlacedTile& placed, const Visible& visible, bool hidden, Canvas& canvas) {
  for (std::uint32_t v = 0; v < placed.tile->corner_count(); ++v) {
    if (visible.corners[v] == hidden) continue;
    const bool high = ((placed.signature >> v) & 1u) != 0;
    canvas.dot(placed.at + corner_place(*placed.tile, v), high ? 6.0 : 4.0,
               high ? (hidden ? "high behind" : "high") : (hidden ? "low behind" : "low"));
  }
}

}  // namespace

Place place_of(const Tile& tile, const LocalFacet& facet, std::uint8_t vertex) {
  const auto middle = [&tile](std::uint8_t e) {
    return 0.5 * (corner_place(tile, tile.edges[e][0]) + corner_place(tile, tile.edges[e][1]));
  };
  if (vertex < tile.edge_count()) return middle(vertex);
  std::vector<Place> places;
  for (const std::uint8_t e : facet.points) places.push_back(middle(e));
  return mean_of(places);
}

namespace {

/// Draws one picture as an SVG element at x.
std::string drawn(const Picture& picture, bool alone, double x, double& width, double& height) {
  const int dim = picture.tiles.empty() ? 0 : picture.tiles.front().tile->dim;
  if (dim != 2 && dim != 3)
    throw Error(ErrorCode::Internal, fmt::format("a picture of tiles of dimension {}: expected 2 or 3", dim));
  const View view(dim);
  Canvas canvas(view, picture.scale);
  // tiles from far to near
  std::vector<PlacedTile> tiles = picture.tiles;
  std::stable_sort(tiles.begin(), tiles.end(), [&view](const PlacedTile& a, const PlacedTile& b) {
    return dot(a.at, view.eye) < dot(b.at, view.eye);
  });
  for (const PlacedTile& placed : tiles) {
    const Visible visible(*placed.tile, view);
    draw_edges(placed, visible, true, canvas);
    if (dim == 3)
      draw_facets(placed, view, canvas);
    else
      draw_segments(placed, canvas);
    draw_corners(placed, visible, true, canvas);
    draw_edges(placed, visible, false, canvas);
    draw_corners(placed, visible, false, canvas);
  }
  for (const auto& [a, b] : picture.marks) canvas.line(a, b, "mark");
  return canvas.svg(picture, alone, x, width, height);
}

}  // namespace

std::string to_svg(const Picture& picture) {
  double width = 0, height = 0;
  return drawn(picture, true, 0, width, height);
}

std::string to_svg(std::span<const Picture> row, const std::string& title) {
  double width = 0, height = 0;
  std::string elements;
  for (const Picture& picture : row) elements += drawn(picture, false, width, width, height);
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\">\n"
      "<title>{2}</title>\n{3}{4}</svg>\n",
      width, height, title, kStyle, elements);
}

}  // namespace tegl::gen
