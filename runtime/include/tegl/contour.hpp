// SPDX-License-Identifier: BSD-3-Clause
//
// The result of contouring: an indexed simplicial complex (segments, triangles, tetrahedra or 4-simplices).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "tegl/dimensions.hpp"

namespace tegl {

namespace detail {
/// Blocks of at least this many bytes (2 MiB) are allocated as huge pages, if the system has them.
inline constexpr std::size_t kLargeBlock = std::size_t{1} << 21;
/// Allocates memory without touching it: pages that are never written cost address space only. Throws std::bad_alloc.
void* allocate_large_block(std::size_t bytes);
void free_large_block(void* block, std::size_t bytes) noexcept;

/// Leaves trivial elements uninitialised on resize, so outputs are written once and not twice.
template <class T>
struct DefaultInitAllocator {
  using value_type = T;
  DefaultInitAllocator() = default;
  template <class U>
  DefaultInitAllocator(const DefaultInitAllocator<U>&) noexcept {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t n) {
    if (n > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
    const std::size_t bytes = n * sizeof(T);
    return static_cast<T*>(bytes < kLargeBlock ? ::operator new(bytes, std::align_val_t(alignof(T)))
                                               : allocate_large_block(bytes));
  }
  void deallocate(T* block, std::size_t n) noexcept {
    const std::size_t bytes = n * sizeof(T);
    if (bytes < kLargeBlock)
      ::operator delete(block, std::align_val_t(alignof(T)));
    else
      free_large_block(block, bytes);
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    if constexpr (sizeof...(Args) == 0)
      ::new (static_cast<void*>(p)) U;
    else
      ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
  friend bool operator==(const DefaultInitAllocator&, const DefaultInitAllocator&) noexcept { return true; }
};
}  // namespace detail

/// A std::vector whose new elements are uninitialised after `resize`.
template <class T>
using Buffer = std::vector<T, detail::DefaultInitAllocator<T>>;

/// The number of a vertex.
using Index = std::uint32_t;

/// How large a contour is.
struct ContourSize {
  std::uint64_t vertices = 0;                           ///< how many points
  std::uint64_t simplices = 0;                          ///< how many segments, triangles, tetrahedra or 4-simplices
  bool operator==(const ContourSize&) const = default;  ///< equal if both counts are equal
};

/// Named numbers of every vertex, or of every simplex.
struct Attribute {
  std::string name = {};       ///< such as "temperature"; not empty
  std::string unit = {};       ///< may be empty
  int width = 1;               ///< how many numbers each has
  Buffer<double> values = {};  ///< #V (or #S) x width, row = vertex (or simplex)
};

/// The side that the oriented contour and its normals face: low samples (descent) or high samples (ascent).
enum class GradientDirection { descent, ascent };

/// The contour of an N-dimensional image: an (N-1)-dimensional simplicial complex in N-space.
/// N = 2: segments, 3: triangles, 4: tetrahedra, 5: 4-simplices. tegl/eigen.hpp has views of vertices and simplices as
/// Eigen matrices.
template <int N, Coordinate Real = float>
requires DimensionBetween<N, 2, 5>
struct Contour {
  using Vertex = std::array<Real, N>;  ///< a point, N coordinates
  /// N vertex numbers.
  using Simplex = std::array<Index, N>;

  Buffer<Vertex> vertices = {};    ///< #V x N world coordinates, row = vertex; for time-varying images t is last
  Buffer<Simplex> simplices = {};  ///< #S x N vertex numbers, row = simplex, consistently oriented
  Buffer<Vertex> normals = {};     ///< #V x N, of length 1 or 0, if requested (ExtractOptions::normals); else empty
  std::array<std::string, N> axis_names = {};                ///< taken from the grid
  std::array<std::string, N> axis_units = {};                ///< taken from the grid; such as "mm"
  GradientDirection direction = GradientDirection::descent;  ///< which side simplices and normals face
  std::vector<Attribute> vertex_attributes = {};             ///< empty after `extract`
  std::vector<Attribute> simplex_attributes = {};            ///< empty after `extract`
};

}  // namespace tegl
