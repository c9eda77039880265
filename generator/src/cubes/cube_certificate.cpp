// SPDX-License-Identifier: BSD-3-Clause
//
// Certifies the lists of cubes.
#include "cubes/cube_certificate.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "cubes/cube_embedding.hpp"

namespace tegl::gen {

void CubeListCertifier::certify(const CubeTriangles& triangles, std::span<const std::uint32_t> masks,
                                const std::string& name) {
  if (!CubeEmbedding(frame_, masks).is_embedded(triangles))
    throw Error(ErrorCode::CertificateFailed, fmt::format("{}: triangles may intersect", name));
  ++proved_;
}

std::uint64_t certify_embedding(const ResolvedCube& table) {
  CubeListCertifier certifier;
  for (unsigned signature = 0; signature < table.first_entry.size(); ++signature) {
    const unsigned end = signature + 1 < table.first_entry.size() ? table.first_entry[signature + 1]
                                                                  : static_cast<unsigned>(table.entries.size());
    for (unsigned entry = table.first_entry[signature]; entry < end; ++entry) {
      const tables::ResolvedEntry& of = table.entries[entry];
      const char* choice = "separate";
      for (const tables::ResolvedList* list : {&of.separate, &of.low, &of.high}) {
        CubeTriangles triangles;
        for (std::size_t t = 3 * std::size_t{list->first_triangle}; triangles.size() < list->triangle_count; t += 3)
          triangles.push_back({table.triangles[t], table.triangles[t + 1], table.triangles[t + 2]});
        certifier.certify(triangles, {table.masks.data() + list->first_mask, list->own_vertices},
                          fmt::format("cube of signature {}, resolution {}, {}", signature,
                                      entry - table.first_entry[signature], choice));
        choice = list == &of.separate ? "low" : "high";
      }
    }
  }
  return certifier.proved();
}

}  // namespace tegl::gen
