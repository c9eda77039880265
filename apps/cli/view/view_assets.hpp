// SPDX-License-Identifier: BSD-3-Clause
//
// The parts of a page that are the same in all pages, put into the program by the build (apps/viewer). All are empty
// where it was configured without esbuild and three.js.
#pragma once

#include <string_view>

namespace tegl::cli {

extern const std::string_view kViewerMarkup;   ///< apps/viewer/src/page.html
extern const std::string_view kViewerStyle;    ///< apps/viewer/src/page.css
extern const std::string_view kViewerProgram;  ///< apps/viewer/src/main.js and what it imports, bundled
extern const std::string_view kViewerNotice;   ///< the licence of three.js

}  // namespace tegl::cli
