// SPDX-License-Identifier: BSD-3-Clause
//
// Assembles structured arrays from pieces.
#include "vtk/structured.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/common.hpp"
#include "base/raw_image.hpp"

namespace tegl::io_detail {

namespace {

std::uint64_t count_of(const std::array<std::uint64_t, 3>& sizes, std::uint64_t components, const VtkFile& file) {
  return checked_bytes(sizes, components, file.path());
}

/// Copies a piece to its place in the whole, row by row, and marks it as present.
template <class T>
void place(const ValueVector<T>& from, const VtkExtent& piece, const VtkExtent& whole, std::size_t components,
           bool of_cells, ValueVector<T>& to, std::vector<bool>& present) {
  const auto own = piece.sizes(of_cells), all = whole.sizes(of_cells);
  std::array<std::uint64_t, 3> shift{};
  for (std::size_t a = 0; a < 3; ++a) shift[a] = static_cast<std::uint64_t>(piece.first[a] - whole.first[a]);
  for (std::uint64_t z = 0; z < own[2]; ++z)
    for (std::uint64_t y = 0; y < own[1]; ++y) {
      const std::uint64_t row = ((z + shift[2]) * all[1] + y + shift[1]) * all[0] + shift[0];
      const std::uint64_t source = (z * own[1] + y) * own[0];
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(source * components), own[0] * components,
                  to.begin() + static_cast<std::ptrdiff_t>(row * components));
      std::fill_n(present.begin() + static_cast<std::ptrdiff_t>(row), own[0], true);
    }
}

}  // namespace

std::array<std::uint64_t, 3> VtkExtent::sizes(bool of_cells) const {
  std::array<std::uint64_t, 3> result{};
  for (std::size_t a = 0; a < 3; ++a) {
    result[a] = static_cast<std::uint64_t>(last[a] - first[a]) + 1;
    if (of_cells && result[a] > 1) --result[a];
  }
  return result;
}

VtkExtent read_extent(const VtkFile& file, const XmlElement& element, std::string_view key) {
  const std::vector<double> numbers = file.numbers(element, key, 6, {});
  if (numbers.empty()) fail(ErrorCode::MalformedFile, file.path(), "<{}> without {}", element.name, key);
  VtkExtent extent;
  constexpr double kMost = 0x1p40;
  for (std::size_t a = 0; a < 3; ++a) {
    const double first = numbers[2 * a], last = numbers[2 * a + 1];
    if (first != std::trunc(first) || last != std::trunc(last) || std::abs(first) > kMost || std::abs(last) > kMost ||
        last < first)
      fail(ErrorCode::MalformedFile, file.path(),
           "<{}> has {} from {} to {}; expected whole numbers in ascending order", element.name, key, first, last);
    extent.first[a] = static_cast<std::int64_t>(first);
    extent.last[a] = static_cast<std::int64_t>(last);
  }
  count_of(extent.sizes(false), sizeof(double), file);
  return extent;
}

VtkExtent whole_extent(const VtkFile& file) { return read_extent(file, file.data(), "WholeExtent"); }

ValueArray read_structured(const VtkFile& file, std::string_view parent, const std::string& name,
                           std::uint64_t components, bool of_cells, const Progress& progress) {
  const VtkExtent whole = whole_extent(file);
  const auto pieces = file.pieces();
  const auto read_piece = [&](const XmlElement& piece, const VtkExtent& extent) {
    const VtkArray array = file.array(piece, parent, name);
    if (array.components != components)
      fail(ErrorCode::MalformedFile, file.path(), "array {} has {} components; expected {}", shown(array.name),
           array.components, components);
    return file.read(array, count_of(extent.sizes(of_cells), components, file), progress);
  };
  if (pieces.size() == 1) {
    const VtkExtent extent = read_extent(file, *pieces.front(), "Extent");
    if (extent == whole) return read_piece(*pieces.front(), whole);
  }
  // All pieces are read first: their sizes, and the size of the whole, are then known to fit the data.
  std::vector<std::pair<VtkExtent, ValueArray>> parts;
  std::uint64_t sum = 0;
  for (const XmlElement* const piece : pieces) {
    const VtkExtent extent = read_extent(file, *piece, "Extent");
    for (std::size_t a = 0; a < 3; ++a)
      if (extent.first[a] < whole.first[a] || extent.last[a] > whole.last[a])
        fail(ErrorCode::MalformedFile, file.path(), "a piece from {} to {} along axis {}; expected {} to {} or less",
             extent.first[a], extent.last[a], a, whole.first[a], whole.last[a]);
    parts.emplace_back(extent, read_piece(*piece, extent));
    sum += count_of(extent.sizes(of_cells), 1, file);
  }
  const std::uint64_t total = count_of(whole.sizes(of_cells), 1, file);
  const auto fail_missing = [&](std::uint64_t found) {
    fail(ErrorCode::MalformedFile, file.path(), "{} pieces with {} of {} values; expected pieces of all values",
         pieces.size(), found, total);
  };
  if (sum < total) fail_missing(sum);
  ValueArray all = array_of_type(type_name(parts.front().second));
  std::vector<bool> present(static_cast<std::size_t>(total), false);
  std::visit(
      [&]<class T>(ValueVector<T>& to) {
        to.resize(static_cast<std::size_t>(total * components));
        for (const auto& [extent, values] : parts) {
          const auto* const from = std::get_if<ValueVector<T>>(&values);
          if (from == nullptr)
            fail(ErrorCode::MalformedFile, file.path(), "array '{}' has the type {} in one piece and {} in another",
                 name, type_name(parts.front().second), type_name(values));
          place(*from, extent, whole, static_cast<std::size_t>(components), of_cells, to, present);
        }
      },
      all);
  const auto found = static_cast<std::uint64_t>(std::count(present.begin(), present.end(), true));
  if (found < total) fail_missing(found);
  return all;
}

}  // namespace tegl::io_detail
