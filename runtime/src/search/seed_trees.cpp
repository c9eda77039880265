// SPDX-License-Identifier: BSD-3-Clause
//
// Merging of links, and progress reports of the seed search.
#include "search/seed_trees.hpp"

#include <algorithm>
#include <tuple>

#include "base/progress.hpp"

namespace tegl::detail {

void report_progress(const Progress& progress, double fraction) {
  tell(progress, fraction, "seeds: cancelled by the progress callback");
}

void merge_links(std::vector<SeedLink>& links) {
  std::sort(links.begin(), links.end(), [](const SeedLink& p, const SeedLink& q) {
    return std::tie(p.a, p.b, p.first, p.end) < std::tie(q.a, q.b, q.first, q.end);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const bool one = kept > 0 && links[kept - 1].a == links[i].a && links[kept - 1].b == links[i].b &&
                     links[i].first <= links[kept - 1].end;
    if (one)
      links[kept - 1].end = std::max(links[kept - 1].end, links[i].end);
    else
      links[kept++] = links[i];
  }
  links.resize(kept);
}

}  // namespace tegl::detail
