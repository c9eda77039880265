// SPDX-License-Identifier: BSD-3-Clause
//
// Invariants of a simplicial complex, vertex by vertex. Everything that `check` counts is visible in the star of a
// vertex (the simplices around it) and is counted at the smallest vertex of the face. So `check` needs one table, from
// vertices to simplices, and small sorts in each star, but no sort of all faces. For D = 3 the faces come from the
// incidence of the simplices, and nearly all links are tested by a search through their triangles.
//
// Based on: H. Seifert and W. Threlfall, Lehrbuch der Topologie, 1934, chapters 3, 6 and 7 (a complex is a manifold iff
// all links are spheres or balls; surfaces are classified by boundary, orientability and Euler characteristic).
#include "tegl/check.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/atomic_minimum.hpp"
#include "base/disjoint_sets.hpp"
#include "base/progress.hpp"
#include "base/workers.hpp"
#include "mesh/incidence_data.hpp"
#include "mesh/oriented_link.hpp"
#include "mesh/star_search.hpp"
#include "mesh/validate.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/error.hpp"
#include "tegl/tile/complex.hpp"
#include "tegl/work.hpp"

namespace tegl {
namespace {

/// Links between two progress calls; if each link is a surface of thousands of triangles, this takes some hundredths of
/// a second.
constexpr std::size_t kVerticesAtOnce = 1024;

/// A complex of D-simplices, valid vertex numbers only.
template <int D>
struct Complex {
  std::span<const Index> rows;  // #S x (D + 1)
  std::size_t vertex_count = 0;

  [[nodiscard]] std::size_t size() const { return rows.size() / (D + 1); }
  [[nodiscard]] const Index* operator[](std::size_t s) const { return rows.data() + s * (D + 1); }
  /// Whether a simplex repeats a vertex.
  [[nodiscard]] bool is_collapsed(std::size_t s) const { return detail::is_collapsed<D + 1>((*this)[s]); }
};

/// The link of one vertex at a time: a complex of (D-1)-simplices ("pieces"), oriented so that the vertex followed by a
/// piece is the simplex that it comes from.
template <int D>
class LinkChecker {
 public:
  explicit LinkChecker(const Complex<D>& complex)
      : complex_(complex), usual_(complex.rows.data(), complex.vertex_count), seen_(complex.vertex_count, kNever) {
    if constexpr (D == 4) number_.resize(complex.vertex_count);
  }

  /// Adds the counts at the star of `v` to the report.
  void visit(Index v, std::span<const Index> star, MeshReport& report) {
    if constexpr (D == 2) {
      detail::FacesAbove faces;
      if (usual_.settle(v, star, faces)) {
        edges_ += faces.edges;
        report.boundary_simplices += faces.boundary;
        return;
      }
    }
    load(v, star);
    const std::uint64_t link_vertices = count_link_vertices(v);
    if constexpr (D == 4) count_link_edges(v);
    sets_.reset(pieces_.size() * D);  // one set per corner of a piece, joined around the vertices of the link
    scan_ridges(v, report);
    if (!is_sphere_or_ball(link_vertices)) ++report.bad_links;
    if constexpr (D >= 2) edges_ += edges_above_;
  }
  /// Numbers of faces met since the last call.
  [[nodiscard]] std::uint64_t take_edges() { return std::exchange(edges_, 0); }            ///< D >= 2
  [[nodiscard]] std::uint64_t take_triangles() { return std::exchange(triangles_, 0); }    ///< D >= 3
  [[nodiscard]] std::uint64_t take_tetrahedra() { return std::exchange(tetrahedra_, 0); }  ///< D = 4

 private:
  static constexpr Index kNever = std::numeric_limits<Index>::max();
  using Piece = std::array<Index, D>;
  using Key = std::conditional_t<(D < 4), std::uint64_t, std::array<Index, 3>>;

  /// A (D-2)-face of the link in one of its pieces. Ridges with equal keys are the same face.
  struct Ridge {
    Key key;
    Index piece;
    std::uint8_t omitted;  // the piece's corner that is not in the ridge
    bool reversed;         // the orientation that the piece induces
    bool operator<(const Ridge& other) const { return key < other.key; }
  };

  void load(Index v, std::span<const Index> star) {
    pieces_.clear();
    ridges_.clear();
    for (const Index s : star) {
      const Index* row = complex_[s];
      Piece piece{};
      bool odd = false;  // parity of moving v to the front
      for (int i = 0, k = 0; i <= D; ++i) {
        if (row[i] == v)
          odd = (i & 1) != 0;
        else
          piece[k++] = row[i];
      }
      const auto number = static_cast<Index>(pieces_.size());
      pieces_.push_back(piece);
      for (int j = 0; j < D; ++j) ridges_.push_back(make_ridge(piece, number, j, odd));
    }
    std::sort(ridges_.begin(), ridges_.end());
  }

  /// Key: the vertices of the ridge, ascending: three if D = 4, two if D = 3, one if D = 2, none if D = 1.
  static Ridge make_ridge(const Piece& piece, Index number, int omitted, bool odd) {
    bool reversed = odd != ((omitted & 1) != 0);
    Key key{};
    if constexpr (D == 2) key = piece[1 - omitted];
    if constexpr (D == 3) {
      Index a = piece[omitted == 0 ? 1 : 0];
      Index b = piece[omitted == 2 ? 1 : 2];
      if (a > b) {
        std::swap(a, b);
        reversed = !reversed;
      }
      key = (std::uint64_t{a} << 32) | b;
    }
    if constexpr (D == 4) {
      std::copy_n(piece.begin(), omitted, key.begin());
      std::copy(piece.begin() + omitted + 1, piece.end(), key.begin() + omitted);
      for (const auto& [i, j] : {std::pair{0, 1}, std::pair{1, 2}, std::pair{0, 1}})
        if (key[i] > key[j]) {
          std::swap(key[i], key[j]);
          reversed = !reversed;
        }
    }
    return {key, number, static_cast<std::uint8_t>(omitted), reversed};
  }

  std::uint64_t count_link_vertices(Index v) {
    std::uint64_t count = 0;
    edges_above_ = 0;
    for (const Piece& piece : pieces_)
      for (const Index a : piece) {
        if (seen_[a] == v) continue;
        seen_[a] = v;
        if constexpr (D == 4) number_[a] = static_cast<Index>(count);
        ++count;
        if (a > v) ++edges_above_;
      }
    return count;
  }

  void count_link_edges(Index v) {
    link_edges_.clear();
    for (const Piece& piece : pieces_)
      for (int i = 0; i < D; ++i)
        for (int j = 0; j < i; ++j)
          link_edges_.push_back(std::uint64_t{std::min(piece[i], piece[j])} << 32 | std::max(piece[i], piece[j]));
    std::sort(link_edges_.begin(), link_edges_.end());
    link_edges_.erase(std::unique(link_edges_.begin(), link_edges_.end()), link_edges_.end());
    const auto above = std::upper_bound(link_edges_.begin(), link_edges_.end(), std::uint64_t{v} << 32 | kNever);
    triangles_ += static_cast<std::uint64_t>(link_edges_.end() - above);
  }

  /// Whether v is the smallest vertex of the face spanned by v and this ridge. The face is then counted here.
  static bool is_counted_at(Index v, const Key& key) {
    if constexpr (D == 1) return true;
    if constexpr (D == 2) return key > v;
    if constexpr (D == 3) return (key >> 32) > v;
    if constexpr (D == 4) return key[0] > v;
  }

  void scan_ridges(Index v, MeshReport& report) {
    ridge_count_ = 0;
    fans_ = pieces_.size() * D;
    connections_ = 0;
    closed_ = true;
    branching_ = false;
    whole_.reset(pieces_.size());
    for (std::size_t i = 0, j = 0; i < ridges_.size(); i = j) {
      while (j < ridges_.size() && ridges_[j].key == ridges_[i].key) ++j;
      ++ridge_count_;
      const std::size_t cofaces = j - i;
      closed_ = closed_ && cofaces != 1;
      branching_ = branching_ || cofaces > 2;
      if (cofaces == 2) join_across(ridges_[i], ridges_[i + 1]);
      if (is_counted_at(v, ridges_[i].key)) count_face(std::span(ridges_).subspan(i, cofaces), report);
    }
  }

  void count_face(std::span<const Ridge> cofaces, MeshReport& report) {
    if constexpr (D == 3) ++triangles_;
    if constexpr (D == 4) ++tetrahedra_;
    if (cofaces.size() == 1) ++report.boundary_simplices;
    if (cofaces.size() > 2) ++report.nonmanifold_simplices;
    if (cofaces.size() == 2 && cofaces[0].reversed == cofaces[1].reversed) ++report.orientation_conflicts;
  }

  /// Joins two pieces that share a ridge: they are connected, and in the same fan around each vertex of the ridge.
  void join_across(const Ridge& a, const Ridge& b) {
    if (whole_.join(a.piece, b.piece)) ++connections_;
    for (int i = 0; i < D; ++i) {
      if (i == a.omitted) continue;
      for (int j = 0; j < D; ++j)
        if (j != b.omitted && pieces_[a.piece][i] == pieces_[b.piece][j] &&
            sets_.join(a.piece * D + static_cast<Index>(i), b.piece * D + static_cast<Index>(j)))
          --fans_;
    }
  }

  [[nodiscard]] bool is_sphere_or_ball(std::uint64_t link_vertices) {
    if (branching_) return false;                            // a ridge in three pieces
    if (connections_ + 1 != pieces_.size()) return false;    // several components
    if (D >= 2 && fans_ != link_vertices) return false;      // a vertex of the link with several fans: pinched
    auto euler = static_cast<std::int64_t>(pieces_.size());  // of the link
    if constexpr (D == 2) euler = static_cast<std::int64_t>(link_vertices) - euler;
    if constexpr (D == 3) euler += static_cast<std::int64_t>(link_vertices) - static_cast<std::int64_t>(ridge_count_);
    if constexpr (D == 4)
      euler = static_cast<std::int64_t>(link_vertices + ridge_count_) -
              static_cast<std::int64_t>(link_edges_.size() + pieces_.size());
    constexpr std::int64_t kSphere = D % 2 == 1 ? 2 : 0;  // S^0, S^1, S^2, S^3: 2, 0, 2, 0
    if (euler != (closed_ ? kSphere : 1)) return false;
    if constexpr (D == 4) return link_vertices < tile::kNoVertex && link_shape() != tile::Shape::other;
    return true;
  }

  [[nodiscard]] tile::Shape link_shape() {
    link_.assign(pieces_.size(), tile::kNoSimplex);
    for (std::size_t p = 0; p < pieces_.size(); ++p) {
      for (int i = 0; i < D; ++i) link_[p][i] = static_cast<tile::VertexId>(number_[pieces_[p][i]]);
      tile::sort_vertices(link_[p]);
    }
    return tile::shape_of(link_);
  }

  /// In place of OrientedLink in other dimensions.
  struct NoLink {
    NoLink(const Index*, std::size_t) {}
  };

  const Complex<D>& complex_;
  std::conditional_t<D == 2, detail::OrientedLink, NoLink> usual_;
  std::vector<Index> seen_;  // by vertex: the last vertex in whose link it was met
  std::vector<Piece> pieces_;
  std::vector<Ridge> ridges_;
  detail::DisjointSets sets_;
  detail::DisjointSets whole_;
  std::uint64_t ridge_count_ = 0;
  std::uint64_t fans_ = 0;
  std::uint64_t connections_ = 0;
  std::uint64_t edges_above_ = 0;
  std::uint64_t edges_ = 0;
  std::uint64_t triangles_ = 0;
  std::uint64_t tetrahedra_ = 0;
  // D = 4
  std::vector<Index> number_;              // by vertex: its number in the current link
  std::vector<std::uint64_t> link_edges_;  // smaller end in the upper 32 bits, ascending
  tile::Simplices link_;
  bool closed_ = true;
  bool branching_ = false;
};

/// Coordinates of vertices, of either type.
class Coordinates {
 public:
  explicit Coordinates(std::span<const float> values) : singles_(values.data()), size_(values.size()) {}
  explicit Coordinates(std::span<const double> values) : doubles_(values.data()), size_(values.size()) {}
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  /// Calls f with a pointer to the first coordinate.
  template <class F>
  decltype(auto) with_values(const F& f) const {
    return singles_ != nullptr ? f(singles_) : f(doubles_);
  }

 private:
  const float* singles_ = nullptr;
  const double* doubles_ = nullptr;
  std::size_t size_;
};

/// Edge vectors of a simplex from its first corner.
template <int D, int Space, class Real>
std::array<std::array<double, Space>, D> edges_of(const Index* row, std::size_t space_dim, const Real* values) {
  std::array<std::array<double, Space>, D> edges;
  for (int j = 0; j < D; ++j)
    for (std::size_t a = 0; a < Space && a < space_dim; ++a)
      edges[j][a] =
          static_cast<double>(values[row[j + 1] * space_dim + a]) - static_cast<double>(values[row[0] * space_dim + a]);
  return edges;
}

/// True only if no height of a simplex is less than 1e-6 of its longest edge: let V be the volume of the parallelepiped
/// of its edges, whose longest is L. A height is V over the volume of a face of it, which is at most (2 L)^(D-1). V² is
/// Gram's determinant, up to a few 1e-15 L^(2D). False if there is doubt. D = 2, 3.
template <int D, class Real>
bool is_surely_solid(const Index* row, const Real* values) {
  const auto edges = edges_of<D, D + 1>(row, D + 1, values);
  std::array<std::array<double, D>, D> gram;
  for (int i = 0; i < D; ++i)
    for (int j = i; j < D; ++j) {
      gram[i][j] = 0.0;
      for (int a = 0; a <= D; ++a) gram[i][j] += edges[i][a] * edges[j][a];
    }
  double longest = std::max(gram[0][0], gram[1][1]);
  double square = gram[0][0] * gram[1][1] - gram[0][1] * gram[0][1];
  double limit = longest * longest;
  if constexpr (D == 3) {
    square = square * gram[2][2] - gram[0][0] * gram[1][2] * gram[1][2] - gram[1][1] * gram[0][2] * gram[0][2] +
             2.0 * gram[0][1] * gram[0][2] * gram[1][2];
    longest = std::max(longest, gram[2][2]);
    limit = longest * longest * longest;
  }
  // false for NaN; extreme lengths are left to is_flat
  return square > 1e-10 * limit && limit > 1e-200 && limit < 1e200;
}

/// Whether D edge vectors from one corner span less than D dimensions, up to rounding. Gram–Schmidt with pivoting,
/// longest remainder first; the remainders are heights of the simplex in decreasing order.
template <int D, class Real>
bool is_flat_by_heights(const Index* row, int space_dim, const Real* values) {
  constexpr int kMaxSpace = 8;
  constexpr double kFlat = 1e-14;
  auto edges = edges_of<D, kMaxSpace>(row, static_cast<std::size_t>(space_dim), values);
  const auto dot = [space_dim](const auto& x, const auto& y) {
    double sum = 0.0;
    for (int a = 0; a < space_dim; ++a) sum += x[a] * y[a];
    return sum;
  };
  double longest = 0.0;
  for (int step = 0; step < D; ++step) {
    // pivot: the longest remainder
    int pivot = step;
    double best = -1.0;
    for (int j = step; j < D; ++j) {
      const double square = dot(edges[j], edges[j]);
      if (!std::isfinite(square)) return true;
      if (square > best) {
        best = square;
        pivot = j;
      }
    }
    std::swap(edges[step], edges[pivot]);
    longest = std::max(longest, best);
    if (best <= kFlat * kFlat * longest) return true;
    // subtract its direction from the others
    for (int j = step + 1; j < D; ++j) {
      const double along = dot(edges[j], edges[step]) / best;
      for (int a = 0; a < space_dim; ++a) edges[j][a] -= along * edges[step][a];
    }
  }
  return false;
}

template <int D, class Real>
bool is_flat(const Index* row, int space_dim, const Real* values) {
  if constexpr (D == 2 || D == 3)
    if (space_dim == D + 1 && is_surely_solid<D>(row, values)) return false;
  return is_flat_by_heights<D>(row, space_dim, values);
}

void require_vertex_numbers(std::span<const Index> rows, std::size_t vertices, std::size_t corners, unsigned threads,
                            const Progress& progress) {
  std::atomic<std::size_t> first = rows.size();  // with a wrong number
  detail::for_each_part(rows.size(), threads, progress, [&](std::size_t from, std::size_t to) {
    const auto at =
        std::find_if(rows.begin() + static_cast<std::ptrdiff_t>(from), rows.begin() + static_cast<std::ptrdiff_t>(to),
                     [&](Index v) { return v >= vertices; });
    const auto found = static_cast<std::size_t>(at - rows.begin());
    if (found == to) return;
    detail::lower_to(first, found);
  });
  if (first < rows.size())
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("simplex {} has vertex number {}; expected less than {}, the number of vertices",
                            first / corners, rows[first], vertices));
}

std::uint64_t count_nonfinite(const Coordinates& coordinates, std::size_t vertices, unsigned threads,
                              const Progress& progress) {
  const std::size_t space_dim = vertices == 0 ? 0 : coordinates.size() / vertices;
  std::atomic<std::uint64_t> count = 0;
  detail::for_each_part(vertices, threads, progress, [&](std::size_t from, std::size_t to) {
    count += coordinates.with_values([&](const auto* values) {
      const auto is_finite = [](auto x) { return std::isfinite(x); };
      std::uint64_t found = 0;
      for (const auto* at = values + from * space_dim; at != values + to * space_dim; at += space_dim)
        if (!std::all_of(at, at + space_dim, is_finite)) ++found;
      return found;
    });
  });
  return count;
}

/// Counts over simplices.
struct SimplexCounts {
  std::atomic<std::uint64_t> degenerate = 0;
  std::atomic<std::uint64_t> sound = 0;  ///< with different corners
};

template <int D>
void count_simplices(const Complex<D>& complex, int space_dim, const Coordinates& coordinates,
                     detail::SharedDisjointSets& connected, unsigned threads, const Progress& progress,
                     SimplexCounts& counts) {
  detail::for_each_part(complex.size(), threads, progress, [&](std::size_t from, std::size_t to) {
    coordinates.with_values([&](const auto* values) {
      const Complex<D> local = complex;  // stays in registers
      std::uint64_t degenerate = 0, sound = 0;
      for (std::size_t s = from; s < to; ++s) {
        const bool is_collapsed = local.is_collapsed(s);
        if (is_collapsed || is_flat<D>(local[s], space_dim, values)) ++degenerate;
        if (is_collapsed) continue;
        ++sound;
        for (int i = 1; i <= D; ++i) connected.join(local[s][0], local[s][i]);
      }
      counts.degenerate += degenerate;
      counts.sound += sound;
    });
  });
}

/// Sums over links, of one thread or all.
struct LinkCounts {
  MeshReport report;
  std::uint64_t edges = 0, triangles = 0, tetrahedra = 0;
};

/// Visits the links of all vertices.
template <int D>
LinkCounts count_links(const Complex<D>& complex, const detail::Stars& stars, detail::SharedDisjointSets& connected,
                       unsigned threads, const Progress& progress) {
  LinkCounts all;
  std::mutex mutex;
  detail::for_each_block(
      complex.vertex_count, kVerticesAtOnce, threads, progress, [&] { return LinkChecker<D>(complex); },
      [&](std::size_t, std::size_t from, std::size_t to, LinkChecker<D>& links) {
        MeshReport report;
        for (std::size_t v = from; v < to; ++v) {
          const std::span<const Index> star = stars.of(v);
          if (star.empty()) continue;
          ++report.vertices;
          if (connected.find(static_cast<Index>(v)) == v) ++report.components;
          links.visit(static_cast<Index>(v), star, report);
        }
        const std::lock_guard lock(mutex);
        for (const auto count :
             {&MeshReport::vertices, &MeshReport::components, &MeshReport::boundary_simplices,
              &MeshReport::nonmanifold_simplices, &MeshReport::bad_links, &MeshReport::orientation_conflicts})
          all.report.*count += report.*count;
        all.edges += links.take_edges();
        all.triangles += links.take_triangles();
        all.tetrahedra += links.take_tetrahedra();
      });
  return all;
}

/// The same for tetrahedra, whose faces are known.
LinkCounts count_links(const Complex<3>& complex, const detail::IncidenceData<4>& incidence,
                       detail::SharedDisjointSets& connected, unsigned threads, const Progress& progress) {
  struct Scratch {
    std::vector<std::uint8_t> is_good;
    std::optional<detail::StarSearch> search;  ///< made when it is needed, as is `others`
    std::optional<LinkChecker<3>> others;
  };
  LinkCounts all;
  std::mutex mutex;
  detail::for_each_block(
      complex.vertex_count, kVerticesAtOnce, threads, progress, [] { return Scratch(); },
      [&](std::size_t, std::size_t from, std::size_t to, Scratch& scratch) {
        LinkCounts found;
        scratch.is_good.resize(to - from);
        detail::find_spheres_and_discs(complex.rows.data(), incidence, from, scratch.is_good);
        for (std::size_t i = from; i < to; ++i) {
          const auto v = static_cast<Index>(i);
          const std::span<const Index> star = incidence.stars.of(v);
          if (star.empty()) continue;
          ++found.report.vertices;
          if (connected.find(v) == v) ++found.report.components;
          found.report.euler += incidence.euler_above[v];
          if (scratch.is_good[i - from] != 0) continue;
          if (!scratch.search) scratch.search.emplace(complex.rows, incidence);
          if (scratch.search->is_sphere_or_disc(v)) continue;
          if (!scratch.others) scratch.others.emplace(complex);
          MeshReport report;
          scratch.others->visit(v, star, report);
          found.report.bad_links += report.bad_links;
        }
        const std::lock_guard lock(mutex);
        all.report.vertices += found.report.vertices;
        all.report.components += found.report.components;
        all.report.bad_links += found.report.bad_links;
        all.report.euler += found.report.euler;
      });
  for (const detail::IrregularFaces& faces : incidence.irregular) {
    all.report.boundary_simplices += faces.boundary;
    all.report.nonmanifold_simplices += faces.several;
    all.report.orientation_conflicts += faces.conflicts;
  }
  return all;
}

/// `incidence`: null if it is not known.
template <int D>
MeshReport check_complex(std::span<const Index> rows, int space_dim, const Coordinates& coordinates,
                         const detail::IncidenceData<D + 1>* incidence, const WorkOptions& work) {
  using detail::part_of;
  const unsigned threads = work.threads;
  const Progress& progress = work.progress;
  const Complex<D> complex{rows, coordinates.size() / static_cast<std::size_t>(space_dim)};
  require_vertex_numbers(rows, complex.vertex_count, D + 1, threads, part_of(progress, 0.0, 0.02));
  const std::uint64_t nonfinite =
      count_nonfinite(coordinates, complex.vertex_count, threads, part_of(progress, 0.02, 0.03));
  detail::SharedDisjointSets connected(complex.vertex_count);
  SimplexCounts simplices;
  count_simplices<D>(complex, space_dim, coordinates, connected, threads, part_of(progress, 0.03, 0.2), simplices);
  LinkCounts links;
  if constexpr (D == 3) {
    std::optional<detail::IncidenceData<4>> made;
    if (incidence == nullptr)
      incidence = &made.emplace(
          detail::make_incidence<4>(rows, complex.vertex_count, true, threads, part_of(progress, 0.2, 0.7)));
    links = count_links(complex, *incidence, connected, threads, part_of(progress, 0.7, 1.0));
  } else if (incidence != nullptr) {
    links = count_links<D>(complex, incidence->stars, connected, threads, part_of(progress, 0.2, 1.0));
  } else {
    const detail::Stars stars =
        detail::make_stars<D + 1>(rows, complex.vertex_count, threads, part_of(progress, 0.2, 0.4));
    links = count_links<D>(complex, stars, connected, threads, part_of(progress, 0.4, 1.0));
  }
  MeshReport report = links.report;
  report.dim = D;
  report.simplices = complex.size();
  report.nonfinite_vertices = nonfinite;
  report.degenerate_simplices = simplices.degenerate;
  report.unused_vertices = complex.vertex_count - report.vertices;
  if (D == 3) return report;  // with the Euler characteristic
  // V - E + F - …, with the simplices last. For D < 2 there are no edges, for D < 4 no triangles and tetrahedra
  // in the counts.
  report.euler = static_cast<std::int64_t>(report.vertices) - static_cast<std::int64_t>(links.edges) +
                 static_cast<std::int64_t>(links.triangles) - static_cast<std::int64_t>(links.tetrahedra) +
                 (D % 2 == 0 ? 1 : -1) * static_cast<std::int64_t>(simplices.sound.load());
  return report;
}

MeshReport check_any(int d, std::span<const Index> simplices, int space_dim, const Coordinates& coordinates,
                     const WorkOptions& work) {
  if (d < 1 || d > 4)
    throw Error(ErrorCode::InvalidArgument, fmt::format("simplices of dimension {}; expected 1, 2, 3 or 4", d));
  if (space_dim < d || space_dim > 8)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("coordinates of {} numbers each for simplices of dimension {}; expected {} to 8", space_dim, d, d));
  const std::size_t width = static_cast<std::size_t>(d) + 1;
  if (simplices.size() % width != 0)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("{} vertex numbers; expected a multiple of {}, the number per simplex", simplices.size(), width));
  if (coordinates.size() % static_cast<std::size_t>(space_dim) != 0)
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("{} coordinates; expected a multiple of {}, the number per vertex", coordinates.size(), space_dim));
  constexpr std::size_t kLimit = std::numeric_limits<Index>::max();
  if (simplices.size() / width > kLimit || coordinates.size() / static_cast<std::size_t>(space_dim) > kLimit)
    throw Error(ErrorCode::TooLarge, fmt::format("{} simplices and {} vertices; expected at most {} of each",
                                                 simplices.size() / width, coordinates.size() / space_dim, kLimit));
  if (d == 1) return check_complex<1>(simplices, space_dim, coordinates, nullptr, work);
  if (d == 2) return check_complex<2>(simplices, space_dim, coordinates, nullptr, work);
  if (d == 3) return check_complex<3>(simplices, space_dim, coordinates, nullptr, work);
  return check_complex<4>(simplices, space_dim, coordinates, nullptr, work);
}

template <int N, class Real>
Coordinates coordinates_of(const Contour<N, Real>& contour) {
  return Coordinates(detail::flat_rows(std::span<const std::array<Real, N>>(contour.vertices)));
}

}  // namespace

MeshReport check(int d, std::span<const Index> simplices, int space_dim, std::span<const double> coordinates,
                 const WorkOptions& work) {
  return check_any(d, simplices, space_dim, Coordinates(coordinates), work);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> MeshReport check(const Contour<N, Real>& contour, const WorkOptions& work) {
  return check_any(N - 1, detail::flat_rows(std::span<const std::array<Index, N>>(contour.simplices)), N,
                   coordinates_of(contour), work);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 5> MeshReport check(const Contour<N, Real>& contour, const Incidence<N>& incidence,
                                                    const WorkOptions& work) {
  const auto rows = detail::flat_rows(std::span<const std::array<Index, N>>(contour.simplices));
  detail::require_incidence<N>(incidence.data(), rows, contour.vertices.size());
  return check_complex<N - 1>(rows, N, coordinates_of(contour), &incidence.data(), work);
}

#define TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real)                           \
  template MeshReport check(const Contour<N, Real>&, const WorkOptions&); \
  template MeshReport check(const Contour<N, Real>&, const Incidence<N>&, const WorkOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
