// SPDX-License-Identifier: BSD-3-Clause
//
// The container of an image's samples: memory of a std::vector, or memory that a child process has filled.
#pragma once

#include <cstddef>
#include <initializer_list>
#include <iterator>
#include <utility>
#include <variant>
#include <vector>

#include "tegl/memory.hpp"

namespace tegl {

namespace detail {
/// A std::vector whose new samples are uninitialised.
template <class T>
using ValueVector = std::vector<T, UninitialisedAllocator<T, ValueMemory>>;
}  // namespace detail

/// Samples in one contiguous block of memory, with the most used functions of a std::vector. Converts from a
/// std::vector without a copy. New samples are 0.
template <class T>
class Values {
 public:
  using value_type = T;                                                ///< the type of a sample
  using size_type = std::size_t;                                       ///< a number of samples
  using difference_type = std::ptrdiff_t;                              ///< a distance between two samples
  using reference = T&;                                                ///< a sample
  using const_reference = const T&;                                    ///< a constant sample
  using iterator = T*;                                                 ///< in memory order
  using const_iterator = const T*;                                     ///< in memory order
  Values() noexcept = default;                                         ///< no samples
  Values(std::vector<T> values) noexcept : held_(std::move(values)) {  ///< moves the samples
    refresh();
  }
  Values(detail::ValueVector<T> values) noexcept : held_(std::move(values)) {  ///< moves the samples
    refresh();
  }
  explicit Values(std::size_t count, T value = T()) : Values(std::vector<T>(count, value)) {}  ///< equal samples
  Values(std::initializer_list<T> values) : Values(std::vector<T>(values)) {}                  ///< these samples
  template <std::input_iterator It>
  Values(It first, It last) : Values(std::vector<T>(first, last)) {}             ///< copies a range
  Values(const Values& other) : held_(other.held_) { refresh(); }                ///< a copy
  Values(Values&& other) noexcept : held_(std::exchange(other.held_, Held())) {  ///< `other` becomes empty
    refresh();
    other.refresh();
  }
  Values& operator=(const Values& other) { return *this = Values(other); }  ///< a copy
  Values& operator=(Values&& other) noexcept {                              ///< `other` becomes empty
    held_ = std::exchange(other.held_, Held());
    refresh();
    other.refresh();
    return *this;
  }
  ~Values() = default;

  [[nodiscard]] T* data() noexcept { return data_; }                                    ///< the first sample
  [[nodiscard]] const T* data() const noexcept { return data_; }                        ///< the first sample
  [[nodiscard]] std::size_t size() const noexcept { return size_; }                     ///< number of samples
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }                      ///< whether size() is 0
  [[nodiscard]] T* begin() noexcept { return data_; }                                   ///< to the first sample
  [[nodiscard]] const T* begin() const noexcept { return data_; }                       ///< to the first sample
  [[nodiscard]] T* end() noexcept { return data_ + size_; }                             ///< past the last sample
  [[nodiscard]] const T* end() const noexcept { return data_ + size_; }                 ///< past the last sample
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return data_[i]; }              ///< sample i < size()
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return data_[i]; }  ///< sample i < size()
  [[nodiscard]] T& front() noexcept { return data_[0]; }                                ///< precondition: not empty
  [[nodiscard]] const T& front() const noexcept { return data_[0]; }                    ///< precondition: not empty
  [[nodiscard]] T& back() noexcept { return data_[size_ - 1]; }                         ///< precondition: not empty
  [[nodiscard]] const T& back() const noexcept { return data_[size_ - 1]; }             ///< precondition: not empty

  /// These functions are those of std::vector. They invalidate pointers to samples.
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
  operator std::vector<T>() const& { return {begin(), end()}; }
  operator std::vector<T>() && {  ///< becomes empty
    auto* const held = std::get_if<std::vector<T>>(&held_);
    std::vector<T> result = held != nullptr ? std::move(*held) : std::vector<T>(begin(), end());
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
  using Held = std::variant<std::vector<T>, detail::ValueVector<T>>;

  template <class Change>
  void change(Change&& change) {
    std::visit(change, held_);
    refresh();
  }
  void refresh() noexcept {
    std::visit(
        [&](auto& held) {
          data_ = held.data();
          size_ = held.size();
        },
        held_);
  }
  [[nodiscard]] bool equals(const T* first, const T* last) const {
    if (static_cast<std::size_t>(last - first) != size_) return false;
    for (std::size_t i = 0; i < size_; ++i)
      if (!(data_[i] == first[i])) return false;
    return true;
  }

  Held held_;
  T* data_ = nullptr;  ///< the first sample in `held_`
  std::size_t size_ = 0;
};

}  // namespace tegl
