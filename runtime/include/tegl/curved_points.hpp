// SPDX-License-Identifier: BSD-3-Clause
//
// Coordinates of the samples of a curved grid (tegl/curved.hpp), stored sample by sample: a contour then needs one
// cache line per sample in place of one for each coordinate. Or coordinates in memory of the caller, without a copy.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <variant>

namespace tegl {

/// Numbers in memory of the caller, one for each sample.
struct CoordinateArray {
  std::variant<const float*, const double*> first;  ///< of the first sample
  std::ptrdiff_t step = 1;  ///< from a sample's number to the one of the next sample, counted in numbers
};

/// Up to four coordinates of each sample, side by side: a copy, or memory of the caller (`in_place`). A copy is stored
/// as float if float represents all numbers exactly, otherwise as double; three coordinates take the memory of four. So
/// three coordinates take 16 or 32 bytes per sample. Copies of this object share the memory, which does not change, so
/// all threads may use it.
class CurvedPoints {
 public:
  static constexpr std::size_t kMostColumns = 4;  ///< largest number of coordinates

  CurvedPoints() = default;  ///< no samples
  /// Copies the coordinates of `samples` samples. Columns are numbered as the arrays are. NaN and infinite numbers may
  /// be among them. `threads`: 0 for all of the machine. Errors: InvalidArgument for no or more than kMostColumns
  /// arrays. O(samples) time.
  CurvedPoints(std::size_t samples, std::span<const CoordinateArray> arrays, unsigned threads = 0);

  /// Coordinates in memory of the caller, which is not copied: those of a sample are `columns` consecutive numbers, and
  /// the next sample begins `pitch` numbers later. One column with the pitch 1 is a plain array; three with the pitch 3
  /// are the points of VTK's grids. The memory must not change; it must outlive all copies of this object, which keep
  /// `owner`, if it is not null. Errors: InvalidArgument for no or more than kMostColumns columns, and a pitch below
  /// their number.
  [[nodiscard]] static CurvedPoints in_place(std::variant<const float*, const double*> first, std::size_t samples,
                                             std::size_t columns, std::size_t pitch,
                                             std::shared_ptr<const void> owner = {});

  [[nodiscard]] std::size_t size() const noexcept { return size_; }        ///< number of samples
  [[nodiscard]] std::size_t columns() const noexcept { return columns_; }  ///< coordinates of each sample
  /// From a sample to the next one, counted in numbers; of copies 1, 2 or 4.
  [[nodiscard]] std::size_t pitch() const noexcept { return pitch_; }
  [[nodiscard]] const float* floats() const noexcept { return floats_; }     ///< the numbers; null: stored as double
  [[nodiscard]] const double* doubles() const noexcept { return doubles_; }  ///< the numbers; null: stored as float
  /// A coordinate of a sample. Preconditions: i < size(), column < columns().
  [[nodiscard]] double operator()(std::size_t i, std::size_t column) const noexcept {
    const std::size_t at = pitch_ * i + column;
    return floats_ != nullptr ? static_cast<double>(floats_[at]) : doubles_[at];
  }
  /// Whether both share their memory, as copies do.
  [[nodiscard]] bool is_same_memory(const CurvedPoints& other) const noexcept {
    return floats_ == other.floats_ && doubles_ == other.doubles_;
  }
  /// The points with a slice more behind each block of `block` samples: its first `row` samples with `added` added to
  /// the columns. Precondition: size() is a multiple of `block`, and row <= block. O(size()) time.
  [[nodiscard]] CurvedPoints continued(std::size_t row, std::size_t block, std::span<const double> added) const;

 private:
  template <class T>
  T* allocate();
  template <class T>
  void continue_blocks(const CurvedPoints& from, std::size_t row, std::size_t block, const double* added);

  std::shared_ptr<const void> memory_;
  const float* floats_ = nullptr;
  const double* doubles_ = nullptr;
  std::size_t size_ = 0;
  std::size_t columns_ = 0;
  std::size_t pitch_ = 0;
};

}  // namespace tegl
