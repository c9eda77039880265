// SPDX-License-Identifier: BSD-3-Clause
//
// The container of a mesh's coordinates, normals and simplices: a plain array of numbers, or the rows of a contour.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <utility>

#include "tegl/contour.hpp"

namespace tegl {

namespace detail {
template <class T>
using HeldNumbers = HeldArray<T, Buffer<T>, Buffer<std::array<T, 2>>, Buffer<std::array<T, 3>>,
                              Buffer<std::array<T, 4>>, Buffer<std::array<T, 5>>>;
}  // namespace detail

/// Numbers in one contiguous block of memory, with the functions of a std::vector, such as data, size, begin, end, back
/// and []. Takes over a Buffer of numbers, or of rows of 2 to 5 numbers as a contour has them, without a copy.
template <class T>
class MeshArray : public detail::HeldNumbers<T> {
  using Held = detail::HeldNumbers<T>;

 public:
  MeshArray() noexcept = default;                                      ///< no numbers
  MeshArray(Buffer<T> numbers) noexcept : Held(std::move(numbers)) {}  ///< moves the numbers
  /// Moves rows; number i of row r becomes number r * Width + i.
  template <std::size_t Width>
  requires(Width >= 2 && Width <= 5) MeshArray(Buffer<std::array<T, Width>> rows)
  noexcept : Held(std::move(rows)) {}
  MeshArray(std::initializer_list<T> numbers) : MeshArray(Buffer<T>(numbers)) {}  ///< copies the numbers
  explicit MeshArray(std::size_t count, T number = T()) : MeshArray(Buffer<T>(count, number)) {}  ///< equal numbers

  /// These functions work as in a std::vector. They invalidate pointers, and copy rows that were taken over.
  /// New numbers are uninitialised, as in a Buffer.
  void resize(std::size_t count) {
    change([&](Buffer<T>& numbers) { numbers.resize(count); });
  }
  void reserve(std::size_t count) {  ///< allocates memory for `count` numbers
    change([&](Buffer<T>& numbers) { numbers.reserve(count); });
  }
  void push_back(T number) {  ///< appends a number
    change([&](Buffer<T>& numbers) { numbers.push_back(number); });
  }
  void pop_back() {  ///< removes the last number
    change([](Buffer<T>& numbers) { numbers.pop_back(); });
  }
  template <std::input_iterator It>
  void insert(const T* before, It first, It last) {  ///< inserts a range
    const auto at = before - this->data();
    change([&](Buffer<T>& numbers) { numbers.insert(numbers.begin() + at, first, last); });
  }
  void assign(std::size_t count, T number) {  ///< `count` equal numbers
    change([&](Buffer<T>& numbers) { numbers.assign(count, number); });
  }
  template <std::input_iterator It>
  void assign(It first, It last) {  ///< copies a range
    change([&](Buffer<T>& numbers) { numbers.assign(first, last); });
  }
  void clear() noexcept {  ///< removes all numbers
    this->hold(Buffer<T>());
  }
  /// The numbers as a Buffer; copies rows that were taken over.
  [[nodiscard]] const Buffer<T>& numbers() & {
    change([](Buffer<T>&) {});
    return *this->template held_as<Buffer<T>>();
  }
  [[nodiscard]] Buffer<T> numbers() && {  ///< becomes empty
    change([](Buffer<T>&) {});
    Buffer<T> result = std::move(*this->template held_as<Buffer<T>>());
    clear();
    return result;
  }
  /// The numbers as rows of Width; numbers that do not fill a row are left out. Does not copy rows of this width that
  /// were taken over.
  template <std::size_t Width>
  requires(Width >= 2 && Width <= 5) [[nodiscard]] Buffer<std::array<T, Width>> rows() && {  ///< becomes empty
    Buffer<std::array<T, Width>> result;
    if (auto* const held = this->template held_as<Buffer<std::array<T, Width>>>()) {
      result = std::move(*held);
    } else {
      result.resize(this->size() / Width);
      for (std::size_t i = 0; i < result.size() * Width; ++i) result[i / Width][i % Width] = (*this)[i];
    }
    clear();
    return result;
  }

  friend bool operator==(const MeshArray& a, const MeshArray& b) {  ///< number by number
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  /// Calls change(numbers) for the numbers as a Buffer; copies rows that were taken over.
  template <class Change>
  void change(const Change& change) {
    if (this->template held_as<Buffer<T>>() == nullptr) this->hold(Buffer<T>(this->begin(), this->end()));
    Buffer<T>& numbers = *this->template held_as<Buffer<T>>();
    change(numbers);
    this->find_elements(numbers);
  }
};

}  // namespace tegl
