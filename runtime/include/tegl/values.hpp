// SPDX-License-Identifier: BSD-3-Clause
//
// The container of an image's samples: memory of a std::vector, or memory that a child process has filled.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <utility>
#include <vector>

#include "tegl/memory.hpp"

namespace tegl {

namespace detail {
/// A std::vector whose new samples are uninitialised.
template <class T>
using ValueVector = std::vector<T, UninitialisedAllocator<T, ValueMemory>>;
}  // namespace detail

/// Samples in one contiguous block of memory, with the most used functions of a std::vector, such as data, size, begin,
/// end, front, back and []. Converts from a std::vector without a copy. New samples are 0.
template <class T>
class Values : public detail::HeldArray<T, std::vector<T>, detail::ValueVector<T>> {
  using Held = detail::HeldArray<T, std::vector<T>, detail::ValueVector<T>>;
  using Held::change;

 public:
  Values() noexcept = default;                                                                 ///< no samples
  Values(std::vector<T> values) noexcept : Held(std::move(values)) {}                          ///< moves the samples
  Values(detail::ValueVector<T> values) noexcept : Held(std::move(values)) {}                  ///< moves the samples
  explicit Values(std::size_t count, T value = T()) : Values(std::vector<T>(count, value)) {}  ///< equal samples
  Values(std::initializer_list<T> values) : Values(std::vector<T>(values)) {}                  ///< these samples
  template <std::input_iterator It>
  Values(It first, It last) : Values(std::vector<T>(first, last)) {}  ///< copies a range

  /// These functions work as in a std::vector. They invalidate pointers to samples.
  void resize(std::size_t count, T value = T()) {
    change([&](auto& held) { held.resize(count, value); });
  }
  void reserve(std::size_t count) {  ///< allocates room for `count` samples
    change([&](auto& held) { held.reserve(count); });
  }
  void push_back(T value) {  ///< appends a sample
    change([&](auto& held) { held.push_back(value); });
  }
  void assign(std::size_t count, T value) {  ///< `count` equal samples
    change([&](auto& held) { held.assign(count, value); });
  }
  template <std::input_iterator It>
  void assign(It first, It last) {  ///< copies a range
    change([&](auto& held) { held.assign(first, last); });
  }
  void clear() noexcept {  ///< removes all samples
    change([](auto& held) { held.clear(); });
  }

  /// Converts to a std::vector. Copies, except from a temporary that was made from a std::vector: its samples are
  /// moved.
  operator std::vector<T>() const& { return {this->begin(), this->end()}; }
  operator std::vector<T>() && {  ///< becomes empty
    auto* const held = this->template held_as<std::vector<T>>();
    std::vector<T> result = held != nullptr ? std::move(*held) : std::vector<T>(this->begin(), this->end());
    clear();
    return result;
  }

  friend bool operator==(const Values& a, const Values& b) {
    return a.equals(b.begin(), b.end());
  }                                                                   ///< sample by sample
  friend bool operator==(const Values& a, const std::vector<T>& b) {  ///< sample by sample
    return a.equals(b.data(), b.data() + b.size());
  }

 private:
  [[nodiscard]] bool equals(const T* first, const T* last) const {
    if (static_cast<std::size_t>(last - first) != this->size()) return false;
    for (std::size_t i = 0; i < this->size(); ++i)
      if (!((*this)[i] == first[i])) return false;
    return true;
  }
};

}  // namespace tegl
