// SPDX-License-Identifier: BSD-3-Clause
//
// Memory of large arrays: allocators that leave new elements uninitialised, and an array over the memory of a
// container.
#pragma once

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>
#include <variant>

namespace tegl::detail {

/// Blocks of at least this many bytes (2 MiB) are allocated as huge pages, if the system has them.
inline constexpr std::size_t kLargeBlock = std::size_t{1} << 21;
/// Allocates memory without touching it: pages that are never written cost address space only. Throws std::bad_alloc.
void* allocate_large_block(std::size_t bytes);
void free_large_block(void* block, std::size_t bytes) noexcept;

/// Allocates memory for samples; blocks of 2 MiB or more are aligned to 64 bytes. Throws std::bad_alloc.
void* allocate_values(std::size_t bytes);
void free_values(void* block, std::size_t bytes) noexcept;

/// Memory of contours and of other results.
struct BufferMemory {
  static void* allocate(std::size_t bytes, std::align_val_t alignment) {
    return bytes < kLargeBlock ? ::operator new(bytes, alignment) : allocate_large_block(bytes);
  }
  static void free(void* block, std::size_t bytes, std::align_val_t alignment) noexcept {
    if (bytes < kLargeBlock)
      ::operator delete(block, alignment);
    else
      free_large_block(block, bytes);
  }
};

/// Memory of samples.
struct ValueMemory {
  static void* allocate(std::size_t bytes, std::align_val_t /*alignment*/) { return allocate_values(bytes); }
  static void free(void* block, std::size_t bytes, std::align_val_t /*alignment*/) noexcept {
    free_values(block, bytes);
  }
};

/// Leaves trivial elements uninitialised on resize, so outputs are written once and not twice. Memory: one of the
/// above.
template <class T, class Memory>
struct UninitialisedAllocator {
  using value_type = T;
  UninitialisedAllocator() = default;
  template <class U>
  UninitialisedAllocator(const UninitialisedAllocator<U, Memory>&) noexcept {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t n) {
    if (n > static_cast<std::size_t>(-1) / 2 / sizeof(T)) throw std::bad_array_new_length();
    return static_cast<T*>(Memory::allocate(n * sizeof(T), std::align_val_t(alignof(T))));
  }
  void deallocate(T* block, std::size_t n) noexcept {
    Memory::free(block, n * sizeof(T), std::align_val_t(alignof(T)));
  }
  template <class U, class... Args>
  void construct(U* p, Args&&... args) {
    if constexpr (sizeof...(Args) == 0)
      ::new (static_cast<void*>(p)) U;
    else
      ::new (static_cast<void*>(p)) U(std::forward<Args>(args)...);
  }
  friend bool operator==(const UninitialisedAllocator&, const UninitialisedAllocator&) noexcept { return true; }
};

/// Elements of type T in the memory of one of several containers, with the accessors of a std::vector: the common part
/// of Values and MeshArray. The items of a container are elements, or std::arrays of elements.
template <class T, class... Containers>
class HeldArray {
 public:
  using value_type = T;                                                       ///< the type of an element
  using size_type = std::size_t;                                              ///< a number of elements
  using difference_type = std::ptrdiff_t;                                     ///< a distance between two elements
  using reference = T&;                                                       ///< an element
  using const_reference = const T&;                                           ///< a constant element
  using iterator = T*;                                                        ///< in memory order
  using const_iterator = const T*;                                            ///< in memory order
  HeldArray(const HeldArray& other) : held_(other.held_) { refresh(); }       ///< a copy
  HeldArray(HeldArray&& other) noexcept : held_(other.take()) { refresh(); }  ///< `other` becomes empty
  HeldArray& operator=(const HeldArray& other) { return *this = HeldArray(other); }  ///< a copy
  HeldArray& operator=(HeldArray&& other) noexcept {                                 ///< `other` becomes empty
    held_ = other.take();
    refresh();
    return *this;
  }

  [[nodiscard]] T* data() noexcept { return data_; }                                    ///< the first element
  [[nodiscard]] const T* data() const noexcept { return data_; }                        ///< the first element
  [[nodiscard]] std::size_t size() const noexcept { return size_; }                     ///< number of elements
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }                      ///< whether size() is 0
  [[nodiscard]] T* begin() noexcept { return data_; }                                   ///< to the first element
  [[nodiscard]] const T* begin() const noexcept { return data_; }                       ///< to the first element
  [[nodiscard]] T* end() noexcept { return data_ + size_; }                             ///< past the last element
  [[nodiscard]] const T* end() const noexcept { return data_ + size_; }                 ///< past the last element
  [[nodiscard]] T& operator[](std::size_t i) noexcept { return data_[i]; }              ///< element i < size()
  [[nodiscard]] const T& operator[](std::size_t i) const noexcept { return data_[i]; }  ///< element i < size()
  [[nodiscard]] T& front() noexcept { return data_[0]; }                                ///< precondition: not empty
  [[nodiscard]] const T& front() const noexcept { return data_[0]; }                    ///< precondition: not empty
  [[nodiscard]] T& back() noexcept { return data_[size_ - 1]; }                         ///< precondition: not empty
  [[nodiscard]] const T& back() const noexcept { return data_[size_ - 1]; }             ///< precondition: not empty

 protected:
  HeldArray() noexcept = default;
  explicit HeldArray(std::variant<Containers...> container) noexcept : held_(std::move(container)) { refresh(); }
  ~HeldArray() = default;

  /// The container if it has this type, else null. Call `find_elements` after a change.
  template <class Container>
  [[nodiscard]] Container* held_as() noexcept {
    return std::get_if<Container>(&held_);
  }
  /// Replaces the container.
  void hold(std::variant<Containers...> container) noexcept {
    held_ = std::move(container);
    refresh();
  }
  /// Calls change(container) for the container.
  template <class Change>
  void change(const Change& change) {
    std::visit(change, held_);
    refresh();
  }
  /// Finds the elements of the container after a change.
  template <class Container>
  void find_elements(Container& container) noexcept {
    using Item = typename Container::value_type;
    size_ = container.size() * (sizeof(Item) / sizeof(T));
    if constexpr (std::is_same_v<Item, T>)
      data_ = container.data();
    else
      data_ = container.empty() ? nullptr : container.data()->data();
  }

 private:
  using Held = std::variant<Containers...>;

  void refresh() noexcept {
    std::visit([&](auto& container) { find_elements(container); }, held_);
  }
  /// The container; leaves this empty.
  Held take() noexcept {
    Held held = std::exchange(held_, Held());
    refresh();
    return held;
  }

  Held held_;
  T* data_ = nullptr;  ///< the first element in `held_`
  std::size_t size_ = 0;
};

}  // namespace tegl::detail
