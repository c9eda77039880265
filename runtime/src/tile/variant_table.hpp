// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of squares and cubes with resolved ambiguities, by key (cube_key.hpp), in the form of the other tables.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tegl/table_contract.hpp"
#include "tile/cube_key.hpp"
#include "tile/row_table.hpp"

namespace tegl::detail {

/// The table of all keys, N = 2 or 3. In the barycentric triangulation, discs of more than
/// one triangle are coned from their barycentre; tunnels are not.
template <int N>
class VariantTable {
 public:
  explicit VariantTable(Triangulation triangulation);
  VariantTable(const VariantTable&) = delete;
  VariantTable& operator=(const VariantTable&) = delete;

  /// By key.
  [[nodiscard]] const tables::TileTable& tile() const noexcept { return tile_; }
  [[nodiscard]] const RowTable& rows() const noexcept { return rows_.front(); }

 private:
  void add(unsigned key, const std::vector<std::uint8_t>& simplices, unsigned cones,
           const std::vector<std::uint64_t>& masks);
  void add_plain(unsigned key, const tables::TileTable& from, unsigned signature, bool reversed);
  void add_variants(Triangulation triangulation);
  void finish();
  void make_rows();

  std::vector<tables::List> lists_;
  std::vector<std::uint16_t> list_of_;
  std::vector<std::uint8_t> simplices_;
  std::vector<std::uint64_t> masks_;
  tables::TileTable tile_{};
  std::vector<RowTable> rows_;
};

/// The table of a triangulation, built at first use.
template <int N>
const VariantTable<N>& variant_table(Triangulation triangulation);

/// Whether a tile depends on the data beyond its signature: a square is ambiguous, or it may have several facets. By
/// signature.
template <int N>
const std::array<bool, std::size_t{1} << (1u << N)>& ambiguous_signatures() noexcept;
template <>
const std::array<bool, 16>& ambiguous_signatures<2>() noexcept;
template <>
const std::array<bool, 256>& ambiguous_signatures<3>() noexcept;
template <>
const std::array<bool, 65536>& ambiguous_signatures<4>() noexcept;  // tesseract_fill.cpp

/// Number of vertices that a cube owns, by key.
inline unsigned cube_vertices(Triangulation triangulation, CubeKey key) {
  return variant_table<3>(triangulation).rows().own_vertices(key.bits());
}

}  // namespace tegl::detail
