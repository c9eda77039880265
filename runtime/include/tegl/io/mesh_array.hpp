// SPDX-License-Identifier: BSD-3-Clause
//
// The container of a mesh's coordinates, normals and simplices: a plain array of numbers, or the rows of a contour.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <type_traits>
#include <utility>
#include <variant>

#include "tegl/contour.hpp"

namespace tegl {

/// Numbers in one contiguous block of memory, with the functions of a std::vector. Takes over a Buffer of numbers, or
/// of rows of 2 to 4 numbers as a contour has them, without a copy.
template <class T>
class MeshArray {
 public:
  using value_type = T;                                                             ///< the type of a number
  using size_type = std::size_t;                                                    ///< a number of numbers
  using difference_type = std::ptrdiff_t;                                           ///< a distance between two numbers
  using reference = T&;                                                             ///< a number
  using const_reference = const T&;                                                 ///< a constant number
  using iterator = T*;                                                              ///< in memory order
  using const_iterator = const T*;                                                  ///< in memory order
  MeshArray() noexcept = default;                                                   ///< no numbers
  MeshArray(Buffer<T> numbers) noexcept : held_(std::move(numbers)) { refresh(); }  ///< moves the numbers
  /// Moves rows; number i of row r becomes number r * Width + i.
  template <std::size_t Width>
  requires(Width >= 2 && Width <= 4) MeshArray(Buffer<std::array<T, Width>> rows)
  noexcept : held_(std::move(rows)) { refresh(); }
  MeshArray(std::initializer_list<T> numbers) : MeshArray(Buffer<T>(numbers)) {}  ///< copies the numbers
  explicit MeshArray(std::size_t count, T number = T()) : MeshArray(Buffer<T>(count, number)) {}  ///< equal numbers
  MeshArray(const MeshArray& other) : held_(other.held_) { refresh(); }                           ///< a copy
  MeshArray(MeshArray&& other) noexcept : held_(std::exchange(other.held_, Held())) {  ///< `other` becomes empty
    refresh();
    other.refresh();
  }
  MeshArray& operator=(const MeshArray& other) { return *this = MeshArray(other); }  ///< a copy
  MeshArray& operator=(MeshArray&& other) noexcept {                                 ///< `other` becomes empty
    held_ = std::exchange(other.held_, Held());
    refresh();
    other.refresh();
    return *this;
  }
  ~MeshArray() = default;

  [[nodiscard]] T* data() noexcept { return data_; }                                    ///< the first number
  [[nodiscard]] const T* data() const noexcept { return data_; }                        ///< the first number
  [[nodiscard]] std::size_t size() const noexcept { return size_; }                     ///< how many numbers
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }                      ///< whether size() is 0
  [[nodiscard]] T* begin() noexcept { return data_; }                                   ///< to the first number
  [[nodiscard]] const T* begin() const noexcept { return data_; }                       ///< to the first number
  [[nodiscard]] T* end() noexcept { return data_ + size_; }                             ///< past the last number
  [[nodiscard]] const T* end() const noexcept { return data_ + size_; }                 ///< past the last number
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return data_[i]; }              ///< number i < size()
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return data_[i]; }  ///< number i < size()
  [[nodiscard]] T& back() noexcept { return data_[size_ - 1]; }                         ///< precondition: not empty
  [[nodiscard]] const T& back() const noexcept { return data_[size_ - 1]; }             ///< precondition: not empty

  /// These functions are those of std::vector. They invalidate pointers, and copy rows that were taken over.
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
  void insert(const_iterator before, It first, It last) {  ///< inserts a range
    const auto at = before - data_;
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
    held_ = Held();
    refresh();
  }
  /// The numbers as a Buffer; copies rows that were taken over.
  [[nodiscard]] const Buffer<T>& numbers() & {
    change([](Buffer<T>&) {});
    return std::get<Buffer<T>>(held_);
  }
  [[nodiscard]] Buffer<T> numbers() && {  ///< becomes empty
    change([](Buffer<T>&) {});
    Buffer<T> result = std::move(std::get<Buffer<T>>(held_));
    clear();
    return result;
  }
  /// The numbers as rows of Width; numbers that do not fill a row are left out. Does not copy rows of this width that
  /// were taken over.
  template <std::size_t Width>
  requires(Width >= 2 && Width <= 4) [[nodiscard]] Buffer<std::array<T, Width>> rows() && {  ///< becomes empty
    Buffer<std::array<T, Width>> result;
    if (auto* const held = std::get_if<Buffer<std::array<T, Width>>>(&held_)) {
      result = std::move(*held);
    } else {
      result.resize(size_ / Width);
      for (std::size_t i = 0; i < result.size() * Width; ++i) result[i / Width][i % Width] = data_[i];
    }
    clear();
    return result;
  }

  friend bool operator==(const MeshArray& a, const MeshArray& b) {  ///< number by number
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  using Held = std::variant<Buffer<T>, Buffer<std::array<T, 2>>, Buffer<std::array<T, 3>>, Buffer<std::array<T, 4>>>;

  template <class Change>
  void change(const Change& change) {
    if (!std::holds_alternative<Buffer<T>>(held_)) held_ = Buffer<T>(begin(), end());
    Buffer<T>& numbers = std::get<Buffer<T>>(held_);
    change(numbers);
    data_ = numbers.data();
    size_ = numbers.size();
  }
  void refresh() noexcept {
    std::visit(
        [&]<class Item>(Buffer<Item>& held) {
          size_ = held.size() * (sizeof(Item) / sizeof(T));
          if constexpr (std::is_same_v<Item, T>)
            data_ = held.data();
          else
            data_ = held.empty() ? nullptr : held.data()->data();
        },
        held_);
  }

  Held held_;
  T* data_ = nullptr;  ///< the first number in `held_`
  std::size_t size_ = 0;
};

}  // namespace tegl
