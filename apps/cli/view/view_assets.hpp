// SPDX-License-Identifier: BSD-3-Clause
//
// The constant parts of every page, embedded by the build (apps/viewer). All are empty if it was configured without
// esbuild and three.js.
#pragma once

#include <string_view>

namespace tegl::cli {

extern const std::string_view kViewerMarkup;   ///< apps/viewer/src/page.html
extern const std::string_view kViewerStyle;    ///< apps/viewer/src/page.css
extern const std::string_view kViewerProgram;  ///< apps/viewer/src/main.js and its imports, bundled
extern const std::string_view kViewerNotice;   ///< the licence of three.js

}  // namespace tegl::cli
