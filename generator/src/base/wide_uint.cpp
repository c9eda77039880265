// SPDX-License-Identifier: BSD-3-Clause
//
// Schoolbook arithmetic on 32-bit limbs with 64-bit carries.
#include "base/wide_uint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/error.hpp"

namespace tegl::gen {
namespace {

constexpr int kLimbBits = 32;
constexpr std::uint64_t kNineDigits = 1'000'000'000;  ///< the largest power of ten that divide() accepts

[[noreturn]] void overflow(const char* operation) {
  throw Error(ErrorCode::Internal,
              fmt::format("{} needs more than the {} bits of a WideUint", operation, WideUint::kBits));
}

}  // namespace

WideUint::WideUint(std::uint64_t value) noexcept {
  limbs_[0] = static_cast<std::uint32_t>(value);
  limbs_[1] = static_cast<std::uint32_t>(value >> kLimbBits);
}

WideUint WideUint::power_of_two(int exponent) {
  if (exponent < 0 || exponent >= kBits) {
    throw Error(ErrorCode::Internal,
                fmt::format("2^{} as a WideUint: expected an exponent of 0 to {}", exponent, kBits - 1));
  }
  WideUint result;
  result.limbs_[static_cast<std::size_t>(exponent / kLimbBits)] = 1U << (exponent % kLimbBits);
  return result;
}

WideUint& WideUint::operator+=(const WideUint& other) {
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    carry += std::uint64_t{limbs_[i]} + other.limbs_[i];
    limbs_[i] = static_cast<std::uint32_t>(carry);
    carry >>= kLimbBits;
  }
  if (carry != 0) {
    overflow("a sum");
  }
  return *this;
}

WideUint& WideUint::operator*=(std::uint64_t factor) {
  // Two passes with 32-bit factors: x * factor = x * low + (x * high shifted by one limb).
  const auto times = [](const WideUint& x, std::uint32_t small, std::size_t shift) {
    WideUint product;
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < kLimbs; ++i) {
      carry += std::uint64_t{x.limbs_[i]} * small;
      if (i + shift < kLimbs) {
        product.limbs_[i + shift] = static_cast<std::uint32_t>(carry);
      } else if (static_cast<std::uint32_t>(carry) != 0) {
        overflow("a product");
      }
      carry >>= kLimbBits;
    }
    if (carry != 0) {
      overflow("a product");
    }
    return product;
  };
  const WideUint high = times(*this, static_cast<std::uint32_t>(factor >> kLimbBits), 1);
  *this = times(*this, static_cast<std::uint32_t>(factor), 0);
  return *this += high;
}

std::uint64_t WideUint::divide(std::uint64_t divisor) {
  if (divisor == 0 || divisor >> kLimbBits != 0) {
    throw Error(ErrorCode::Internal, fmt::format("division by {}: expected a divisor of 1 to 2^32 - 1", divisor));
  }
  std::uint64_t remainder = 0;
  for (std::size_t i = kLimbs; i-- > 0;) {
    const std::uint64_t part = remainder << kLimbBits | limbs_[i];
    limbs_[i] = static_cast<std::uint32_t>(part / divisor);
    remainder = part % divisor;
  }
  return remainder;
}

WideUint WideUint::exactly_divided_by(std::uint64_t divisor) const {
  WideUint quotient = *this;
  if (const std::uint64_t remainder = quotient.divide(divisor); remainder != 0) {
    throw Error(ErrorCode::Internal,
                fmt::format("{} divided by {} leaves {}: expected 0", to_decimal(), divisor, remainder));
  }
  return quotient;
}

std::string WideUint::to_decimal() const {
  std::vector<std::uint64_t> groups;  // groups of nine digits, least significant first
  WideUint rest = *this;
  do {
    groups.push_back(rest.divide(kNineDigits));
  } while (!(rest == WideUint{}));
  std::string digits = fmt::format("{}", groups.back());
  for (std::size_t i = groups.size() - 1; i-- > 0;) {
    digits += fmt::format("{:09}", groups[i]);
  }
  return digits;
}

std::strong_ordering operator<=>(const WideUint& a, const WideUint& b) noexcept {
  return std::lexicographical_compare_three_way(a.limbs_.rbegin(), a.limbs_.rend(), b.limbs_.rbegin(), b.limbs_.rend());
}

}  // namespace tegl::gen
