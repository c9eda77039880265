// SPDX-License-Identifier: BSD-3-Clause
//
// Sizes of contours, and extraction into memory of the caller.
#include <algorithm>
#include <memory>
#include <span>

#include <fmt/format.h>

#include "base/contour_room.hpp"
#include "base/function_ref.hpp"
#include "kernel/stream.hpp"
#include "kernel/tableless.hpp"

namespace tegl {

namespace detail {
namespace {

/// Discards everything.
template <int N, class Real>
class NoSink final : public ContourSink<N, Real> {
 public:
  using typename ContourSink<N, Real>::Vertex;
  using typename ContourSink<N, Real>::Simplex;
  void add_vertices(std::span<const Vertex> /*vertices*/) override {}
  void add_simplices(std::span<const Simplex> /*simplices*/) override {}
  void replace_corner(std::uint64_t /*simplex*/, int /*corner*/, std::uint64_t /*vertex*/) override {}
};

/// Names of items in error messages.
constexpr const char* kVertices = "vertices";
constexpr const char* kNormals = "normals";
constexpr const char* kSimplices = "simplices";

/// Counts only. It counts neither caps nor vertices doubled at missing values.
template <int N, class Real>
class CountOutput final : public ContourOutput<N, Real> {
 public:
  using typename ContourOutput<N, Real>::Room;
  Room open(const ContourPart& /*part*/) override { return {nullptr, nullptr}; }
  void finish(const ContourPart& all, const Caps<N, Real>* /*caps*/,
              const NonmanifoldCandidates& nonmanifold) override {
    size = {all.end_vertex, all.end_simplex};
    any_missing = nonmanifold.any_missing();
  }

  ContourSize size;
  bool any_missing = false;
};

/// Writes parts at their final places. It does not double vertices at missing values.
template <int N, class Real, class I>
class MemoryOutput final : public ContourOutput<N, Real> {
 public:
  using typename ContourOutput<N, Real>::Simplex;
  using typename ContourOutput<N, Real>::Room;
  MemoryOutput(const ContourRoom<N, Real, I>& room, bool with_normals) : room_(room), with_normals_(with_normals) {}

  Room open(const ContourPart& part) override {
    check(part.end_vertex, part.end_simplex);
    auto* const vertices = room_.vertices.data() + part.first_vertex;
    auto* const normals = with_normals_ ? room_.normals.data() + part.first_vertex : nullptr;
    if constexpr (sizeof(I) == sizeof(Index)) {
      return {vertices, room_.simplices.data() + part.first_simplex, normals};
    } else {
      narrow_.resize(part.end_simplex - part.first_simplex);
      return {vertices, narrow_.data(), normals};
    }
  }

  void close(const ContourPart& part, const NonmanifoldCandidates& /*nonmanifold*/) override {
    if constexpr (sizeof(I) != sizeof(Index)) {
      auto* wide = room_.simplices.data() + part.first_simplex;
      for (const Simplex& simplex : narrow_) {
        for (int j = 0; j < N; ++j) (*wide)[j] = before_ + static_cast<Index>(simplex[j] - static_cast<Index>(before_));
        ++wide;
      }
      before_ = part.first_vertex;
    }
  }

  void finish(const ContourPart& all, const Caps<N, Real>* caps, const NonmanifoldCandidates& nonmanifold) override {
    size = {all.end_vertex, all.end_simplex};
    any_missing = nonmanifold.any_missing();
    if (caps == nullptr || any_missing) return;
    check(size.vertices + caps->vertices().size(), size.simplices + caps->simplices().size());
    std::copy(caps->vertices().begin(), caps->vertices().end(), room_.vertices.data() + size.vertices);
    if (with_normals_) std::copy(caps->normals().begin(), caps->normals().end(), room_.normals.data() + size.vertices);
    size.vertices += caps->vertices().size();
    for (const auto& simplex : caps->simplices()) {
      auto& to = room_.simplices[size.simplices++];
      for (int j = 0; j < N; ++j) to[j] = static_cast<I>(caps->number(simplex[j], all.end_vertex));
    }
  }

  ContourSize size;
  bool any_missing = false;

 private:
  void check(std::uint64_t vertices, std::uint64_t simplices) const {
    check_room(room_, {vertices, simplices}, with_normals_);
  }

  ContourRoom<N, Real, I> room_;
  bool with_normals_;
  Buffer<Simplex> narrow_;
  std::uint64_t before_ = 0;  ///< first vertex of the previous part
};

/// Output for images with missing values: parts are copied, and corners are replaced at the end.
template <int N, class Real, class I>
class MemorySink final : public ContourSink<N, Real> {
 public:
  using typename ContourSink<N, Real>::Vertex;
  using typename ContourSink<N, Real>::Simplex;
  explicit MemorySink(const ContourRoom<N, Real, I>& room) : room_(room) {}

  void add_vertices(std::span<const Vertex> vertices) override {
    check_room(room_.vertices.size(), size_.vertices + vertices.size(), kVertices);
    std::copy(vertices.begin(), vertices.end(), room_.vertices.data() + size_.vertices);
    size_.vertices += vertices.size();
    if constexpr (sizeof(I) == sizeof(Index)) check_vertex_count(size_.vertices, kMaxVertices);
  }
  void add_normals(std::span<const Vertex> normals) override {
    check_room(room_.normals.size(), size_.vertices, kNormals);
    std::copy(normals.begin(), normals.end(), room_.normals.data() + (size_.vertices - normals.size()));
  }
  void add_simplices(std::span<const Simplex> simplices) override {
    check_room(room_.simplices.size(), size_.simplices + simplices.size(), kSimplices);
    for (const Simplex& simplex : simplices) {
      auto& to = room_.simplices[size_.simplices++];
      for (int j = 0; j < N; ++j) to[j] = static_cast<I>(simplex[j]);
    }
  }
  void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) override {
    room_.simplices[simplex][corner] = static_cast<I>(vertex);
  }

 private:
  ContourRoom<N, Real, I> room_;
  ContourSize size_;
};

/// Makes the samples of an image, once per pass.
template <int N>
using SourceOfPass = FunctionRef<std::unique_ptr<SampleSource<N>>()>;

template <int N>
ExtractedSize count_by_parts(const SourceOfPass<N>& make_source, const Grid<N>& grid, const ExtractOptions& options) {
  const ExtractPlan plan{.max_vertices = ~std::uint64_t{0}};
  const auto tables = generated_tables<N>(options);
  if (!options.close) {
    const auto source = make_source();
    CountOutput<N, float> output;
    const ExtractStats stats = extract_to<N, float>(*source, grid, tables, options, plan, output);
    if (!output.any_missing) return {output.size, stats};
  }
  const auto source = make_source();
  NoSink<N, float> sink;
  StreamOutput<N, float> output(sink, options.normals != Normals::none);
  const ExtractStats stats = extract_to<N, float>(*source, grid, tables, options, plan, output);
  return {output.size(), stats};
}

/// `extract_into`, compiled once for all value types.
template <int N, class Real, class I>
ExtractedSize extract_into_room(const SourceOfPass<N>& make_source, const Grid<N>& grid,
                                const ContourRoom<N, Real, I>& room, const ExtractOptions& options) {
  const auto tables = generated_tables<N>(options);
  ExtractPlan plan;
  if constexpr (sizeof(I) != sizeof(Index)) plan.max_vertices = ~std::uint64_t{0};
  const auto source = make_source();
  MemoryOutput<N, Real, I> output(room, options.normals != Normals::none);
  ExtractedSize result;
  result.stats = extract_to<N, Real>(*source, grid, tables, options, plan, output);
  result.size = output.size;
  if (output.any_missing) {
    const auto again = make_source();
    MemorySink<N, Real, I> sink(room);
    StreamOutput<N, Real> parts(sink, options.normals != Normals::none);
    result.stats = extract_to<N, Real>(*again, grid, tables, options, plan, parts);
    result.size = parts.size();
  } else if constexpr (sizeof(I) == sizeof(Index)) {
    check_vertex_count(result.size.vertices, kMaxVertices);
  }
  return result;
}

template <Value T, int N>
std::unique_ptr<SampleSource<N>> source_of(const Image<T, N>& image, double isovalue, double epsilon) {
  return std::make_unique<ImageSource<T, N>>(image, isovalue, epsilon);
}

}  // namespace
}  // namespace detail

template <Value T, int N>
requires DimensionBetween<N, 2, 5> ExtractedSize count_with_stats(const Image<T, N>& image, double isovalue,
                                                                  const ExtractOptions& asked) {
  detail::check_arguments(isovalue, asked);
  ExtractOptions options = asked;
  options.normals = Normals::none;  // not counted: one per vertex
  if constexpr (N > 4) {
    detail::ImageSource<T, N> source(image, isovalue, options.epsilon);
    return detail::count_tiles<N>(source, image.grid(), options);
  } else {
    return detail::count_by_parts<N>([&] { return detail::source_of(image, isovalue, options.epsilon); }, image.grid(),
                                     options);
  }
}

template <Value T, int N, Coordinate Real, VertexNumber I>
requires DimensionBetween<N, 2, 4> ExtractedSize extract_into(const Image<T, N>& image, double isovalue,
                                                              const ContourRoom<N, Real, I>& room,
                                                              const ExtractOptions& options) {
  detail::check_arguments(isovalue, options);
  return detail::extract_into_room<N, Real, I>([&] { return detail::source_of(image, isovalue, options.epsilon); },
                                               image.grid(), room, options);
}

#define TEGL_INSTANTIATE_INTO(T, N, Real, I)                                                                     \
  template ExtractedSize extract_into<T, N, Real, I>(const Image<T, N>&, double, const ContourRoom<N, Real, I>&, \
                                                     const ExtractOptions&);
#define TEGL_INSTANTIATE_DIM(T, N)                                                                  \
  template ExtractedSize count_with_stats<T, N>(const Image<T, N>&, double, const ExtractOptions&); \
  TEGL_INSTANTIATE_INTO(T, N, float, std::uint32_t)                                                 \
  TEGL_INSTANTIATE_INTO(T, N, float, std::uint64_t)                                                 \
  TEGL_INSTANTIATE_INTO(T, N, double, std::uint32_t)                                                \
  TEGL_INSTANTIATE_INTO(T, N, double, std::uint64_t)
#define TEGL_INSTANTIATE(T)                                                                         \
  template ExtractedSize count_with_stats<T, 5>(const Image<T, 5>&, double, const ExtractOptions&); \
  TEGL_INSTANTIATE_DIM(T, 2)                                                                        \
  TEGL_INSTANTIATE_DIM(T, 3)                                                                        \
  TEGL_INSTANTIATE_DIM(T, 4)
#include "base/instantiate.hpp"
#undef TEGL_INSTANTIATE_DIM
#undef TEGL_INSTANTIATE_INTO

}  // namespace tegl
