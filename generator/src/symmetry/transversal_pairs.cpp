// SPDX-License-Identifier: BSD-3-Clause
//
// Representatives of dimension n from the classes of dimension n - 1.
//
// The upper half of a signature's bits is its upper face along the last axis. So the smallest signature of an orbit has
// as its upper face the smallest signature that any face gets under the group, which is the smallest of the faces'
// representatives, r. The symmetries that map a face with representative r to the upper face form cosets of r's
// stabiliser; the minimum over these determines the lower face.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "base/error.hpp"
#include "symmetry/transversal.hpp"

namespace tegl::gen {

namespace {

/// A symmetry of the (n-1)-cube on signatures, with one look-up table per byte of the signature.
class SignatureMap {
 public:
  SignatureMap(const Element& g, int dim) : bytes_(std::max(1, (1 << dim) / 8)) {
    const auto permutation = corner_permutation(g, dim);
    for (int byte = 0; byte < bytes_; ++byte)
      for (std::uint32_t value = 0; value < 256; ++value) {
        std::uint32_t image = 0;
        for (int b = 0; b < 8 && 8 * byte + b < 1 << dim; ++b)
          if ((value >> b & 1u) != 0) image |= 1u << permutation[static_cast<std::size_t>(8 * byte + b)];
        images_[static_cast<std::size_t>(byte)][value] = static_cast<std::uint16_t>(image);
      }
  }
  std::uint32_t operator()(std::uint32_t signature) const {
    std::uint32_t image = images_[0][signature & 0xff];
    if (bytes_ > 1) image |= images_[1][signature >> 8];
    return image;
  }

 private:
  int bytes_;
  std::array<std::array<std::uint16_t, 256>, 2> images_{};
};

/// The bits of a signature of dimension n at corners with x_axis = side, in the face's own numbering.
std::uint32_t face_of(std::uint64_t signature, int n, int axis, unsigned side) {
  std::uint64_t bits = signature >> (side << axis);
  // Compress runs of 2^axis bits separated by gaps of equal length: merge pairs of runs, then pairs of the results.
  for (int k = axis; k < n - 1; ++k) {
    const std::uint64_t run = (std::uint64_t{1} << (1u << k)) - 1;
    std::uint64_t kept = 0;
    for (int at = 0; at < 1 << n; at += 4 << k) {
      kept |= (bits >> at & run) << at;
      kept |= (bits >> (at + (2 << k)) & run) << (at + (1 << k));
    }
    bits = kept;
  }
  return static_cast<std::uint32_t>(bits & ((std::uint64_t{1} << (1u << (n - 1))) - 1));
}

class PairEnumeration {
 public:
  PairEnumeration(int n, GroupKind kind) : n_(n), elements_(group(n - 1, kind, false)) {
    classes_ = transversal(n - 1, elements_);
    for (const Element& g : elements_) maps_.emplace_back(g, n - 1);
    for (const Element& g : elements_) {
      const auto found = std::find(elements_.begin(), elements_.end(), inverse(g));
      inverse_of_.push_back(static_cast<std::uint32_t>(found - elements_.begin()));
    }
    // A cyclic exchange of axes and a flip map a face to the upper face. Half of these maps are reflections; for
    // rotations an additional flip of axis 0 makes them rotations.
    Element mirror;
    mirror.flip = 1;
    mirror.det = -1;
    mirror_ = kind == GroupKind::Rotations ? std::make_unique<SignatureMap>(mirror, n - 1) : nullptr;
    order_ = group_order(n, kind, false);
  }

  std::uint64_t run(const std::function<void(const Representative&)>& take) {
    const std::uint32_t half = 1u << (n_ - 1);
    std::uint64_t sum = 0;
    for (std::uint32_t c = 0; c < classes_.representatives.size(); ++c) {
      find_stabiliser(c);
      const std::uint64_t upper = std::uint64_t{classes_.representatives[c]} << half;
      for (std::uint32_t lower = 0; lower < std::uint32_t{1} << half; ++lower) {
        const std::uint32_t same = symmetries(c, upper | lower, lower);
        if (same == 0) continue;
        const auto length = static_cast<std::uint32_t>(order_ / same);
        take({static_cast<std::uint32_t>(upper | lower), length});
        sum += length;
      }
    }
    return sum;
  }

 private:
  void find_stabiliser(std::uint32_t c) {
    stabiliser_.clear();
    const std::uint32_t r = classes_.representatives[c];
    for (std::uint32_t g = 0; g < maps_.size(); ++g)
      if (maps_[g](r) == r) stabiliser_.push_back(g);
  }

  /// The number of symmetries that fix the signature, or 0 if one of them maps it to a smaller one.
  std::uint32_t symmetries(std::uint32_t c, std::uint64_t signature, std::uint32_t lower) const {
    // The upper face first: it rejects most signatures.
    std::uint32_t same = 0;
    for (const std::uint32_t k : stabiliser_) {
      const std::uint32_t image = maps_[k](lower);
      if (image < lower) return 0;
      same += image == lower ? 1 : 0;
    }
    for (int axis = 0; axis < n_; ++axis)
      for (unsigned side = 0; side < 2; ++side) {
        if (axis == n_ - 1 && side == 1) continue;
        std::uint32_t face = face_of(signature, n_, axis, side);
        std::uint32_t opposite = face_of(signature, n_, axis, side ^ 1u);
        const bool reflects = ((n_ - 1 - axis) % 2 != 0) != (side == 0);
        if (mirror_ && reflects) face = (*mirror_)(face), opposite = (*mirror_)(opposite);
        if (classes_.class_of[face] < c) return 0;  // representatives ascend with their classes
        if (classes_.class_of[face] > c) continue;
        const std::uint32_t back = maps_[inverse_of_[classes_.element_of[face]]](opposite);
        for (const std::uint32_t k : stabiliser_) {
          const std::uint32_t image = maps_[k](back);
          if (image < lower) return 0;
          same += image == lower ? 1 : 0;
        }
      }
    return same;
  }

  int n_;
  std::vector<Element> elements_;
  Transversal classes_;
  std::vector<SignatureMap> maps_;
  std::vector<std::uint32_t> inverse_of_;
  std::unique_ptr<SignatureMap> mirror_;
  std::size_t order_;
  std::vector<std::uint32_t> stabiliser_;
};

}  // namespace

std::uint64_t for_each_representative(int n, GroupKind kind, const std::function<void(const Representative&)>& take) {
  if (n < 2 || n > kMaxSignatureDim)
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("representatives in dimension {}: expected 2 to {}", n, kMaxSignatureDim));
  return PairEnumeration(n, kind).run(take);
}

}  // namespace tegl::gen
