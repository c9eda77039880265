// SPDX-License-Identifier: BSD-3-Clause
//
// An unsigned integer of fixed width for Burnside sums: at n = 8 they reach 2^256 times the group's order.
// Only the operations that these sums need; each is exact or throws, none wraps around.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>

namespace tegl::gen {

/// A whole number of up to 320 bits, for counts of signatures: 2^256 of them in 8 dimensions.
class WideUint {
 public:
  static constexpr int kBits = 320;  ///< what it can hold

  WideUint() = default;
  /// A number of 64 bits.
  explicit WideUint(std::uint64_t value) noexcept;

  /// 2^exponent. Errors: Internal if exponent is not in [0, 320).
  static WideUint power_of_two(int exponent);

  /// Errors: Internal if the sum needs more than 320 bits; *this is then unspecified.
  WideUint& operator+=(const WideUint& other);

  /// Errors: Internal if the product needs more than 320 bits; *this is then unspecified.
  WideUint& operator*=(std::uint64_t factor);

  /// Divides and returns the remainder. Errors: Internal if divisor is 0 or does not fit in 32 bits (the
  /// orders and class sizes here do).
  std::uint64_t divide(std::uint64_t divisor);

  /// The quotient. Errors: Internal unless the remainder is 0; as divide() otherwise.
  [[nodiscard]] WideUint exactly_divided_by(std::uint64_t divisor) const;

  /// In decimal digits.
  [[nodiscard]] std::string to_decimal() const;

  friend bool operator==(const WideUint&, const WideUint&) = default;  ///< the same number
  /// Which is larger.
  friend std::strong_ordering operator<=>(const WideUint& a, const WideUint& b) noexcept;

 private:
  static constexpr std::size_t kLimbs = kBits / 32;
  std::array<std::uint32_t, kLimbs> limbs_{};  ///< least significant first
};

}  // namespace tegl::gen
