// SPDX-License-Identifier: BSD-3-Clause
//
// Views of contours, vectors and matrices for Eigen, without a copy. The only public header that includes Eigen (3.4 or
// later): its users find and link Eigen themselves, with CMake by find_package(Eigen3) and the target Eigen3::Eigen.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "tegl/contour.hpp"
#include "tegl/vector.hpp"

namespace tegl {

/// #V x N, row = vertex.
template <int N, Coordinate Real = float>
using VertexMatrix = Eigen::Matrix<Real, Eigen::Dynamic, N, Eigen::RowMajor>;
/// #S x N, row = simplex.
template <int N>
using SimplexMatrix = Eigen::Matrix<Index, Eigen::Dynamic, N, Eigen::RowMajor>;

/// The vertices of a contour; valid until `contour.vertices` changes.
template <int N, Coordinate Real>
[[nodiscard]] Eigen::Map<const VertexMatrix<N, Real>> vertex_matrix(const Contour<N, Real>& contour) {
  return {contour.vertices.empty() ? nullptr : contour.vertices.data()->data(),
          static_cast<Eigen::Index>(contour.vertices.size()), N};
}
/// Deleted: the matrix of a temporary would dangle.
template <int N, Coordinate Real>
void vertex_matrix(const Contour<N, Real>&&) = delete;

/// The simplices of a contour; valid until `contour.simplices` changes.
template <int N, Coordinate Real>
[[nodiscard]] Eigen::Map<const SimplexMatrix<N>> simplex_matrix(const Contour<N, Real>& contour) {
  return {contour.simplices.empty() ? nullptr : contour.simplices.data()->data(),
          static_cast<Eigen::Index>(contour.simplices.size()), N};
}
/// Deleted: the matrix of a temporary would dangle.
template <int N, Coordinate Real>
void simplex_matrix(const Contour<N, Real>&&) = delete;

/// A vector as a column of Eigen's; valid as long as the vector.
template <std::size_t N>
[[nodiscard]] auto as_eigen(const std::array<double, N>& vector) {
  return Eigen::Map<const Eigen::Matrix<double, static_cast<int>(N), 1>>(vector.data());
}
/// As above. Assignments to the view change the vector.
template <std::size_t N>
[[nodiscard]] auto as_eigen(std::array<double, N>& vector) {
  return Eigen::Map<Eigen::Matrix<double, static_cast<int>(N), 1>>(vector.data());
}
/// Deleted: the view of a temporary would dangle.
template <std::size_t N>
void as_eigen(const std::array<double, N>&&) = delete;

/// A matrix, or any list of vectors, one in each row; valid as long as the matrix.
template <std::size_t Rows, std::size_t Columns>
requires(Columns > 1) [[nodiscard]] auto as_eigen(const std::array<std::array<double, Columns>, Rows>& matrix) {
  using RowMajor = Eigen::Matrix<double, static_cast<int>(Rows), static_cast<int>(Columns), Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(matrix.data()->data());
}
/// As above. Assignments to the view change the matrix.
template <std::size_t Rows, std::size_t Columns>
requires(Columns > 1) [[nodiscard]] auto as_eigen(std::array<std::array<double, Columns>, Rows>& matrix) {
  using RowMajor = Eigen::Matrix<double, static_cast<int>(Rows), static_cast<int>(Columns), Eigen::RowMajor>;
  return Eigen::Map<RowMajor>(matrix.data()->data());
}
/// Deleted: the view of a temporary would dangle.
template <std::size_t Rows, std::size_t Columns>
void as_eigen(const std::array<std::array<double, Columns>, Rows>&&) = delete;

/// A copy of an Eigen vector of fixed size. Vectors of dynamic size are assigned to a view: as_eigen(to) = from.
template <class Derived>
[[nodiscard]] auto to_vector(const Eigen::MatrixBase<Derived>& from) {
  static_assert(Derived::IsVectorAtCompileTime && Derived::SizeAtCompileTime > 0, "expected a vector of fixed size");
  Vector<Derived::SizeAtCompileTime> to;
  for (int a = 0; a < Derived::SizeAtCompileTime; ++a) to[static_cast<std::size_t>(a)] = from.derived()[a];
  return to;
}

/// A copy of a square Eigen matrix of fixed size. Matrices of dynamic size are assigned to a view: as_eigen(to) = from.
template <class Derived>
[[nodiscard]] auto to_matrix(const Eigen::MatrixBase<Derived>& from) {
  static_assert(Derived::RowsAtCompileTime > 1 && Derived::RowsAtCompileTime == Derived::ColsAtCompileTime,
                "expected a square matrix of fixed size");
  Matrix<Derived::RowsAtCompileTime> to;
  as_eigen(to) = from;
  return to;
}

}  // namespace tegl
