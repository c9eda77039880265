// SPDX-License-Identifier: BSD-3-Clause
//
// An unsigned integer of fixed width for Burnside sums, which reach 2^256 times the group's order at n = 8. It has only
// the operations that these sums need. Each is exact or throws; none wraps around.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>

namespace tegl::gen {

/// An unsigned integer of up to 320 bits, for counts of signatures: there are 2^256 in 8 dimensions.
class WideUint {
 public:
  static constexpr int kBits = 320;  ///< capacity in bits

  WideUint() = default;
  /// Converts a 64-bit number.
  explicit WideUint(std::uint64_t value) noexcept;

  /// 2^exponent. Errors: Internal if exponent is not in [0, 320).
  static WideUint power_of_two(int exponent);

  /// Errors: Internal if the sum needs more than 320 bits; *this is then unspecified.
  WideUint& operator+=(const WideUint& other);

  /// Errors: Internal if the product needs more than 320 bits; *this is then unspecified.
  WideUint& operator*=(std::uint64_t factor);

  /// Divides in place and returns the remainder. Errors: Internal if divisor is 0 or needs more than 32 bits (group
  /// orders and class sizes fit).
  std::uint64_t divide(std::uint64_t divisor);

  /// The quotient. Errors: Internal unless the remainder is 0; as divide() otherwise.
  [[nodiscard]] WideUint exactly_divided_by(std::uint64_t divisor) const;

  /// Decimal representation.
  [[nodiscard]] std::string to_decimal() const;

  friend bool operator==(const WideUint&, const WideUint&) = default;  ///< equality of values
  /// Comparison of values.
  friend std::strong_ordering operator<=>(const WideUint& a, const WideUint& b) noexcept;

 private:
  static constexpr std::size_t kLimbs = kBits / 32;
  std::array<std::uint32_t, kLimbs> limbs_{};  ///< least significant first
};

}  // namespace tegl::gen
