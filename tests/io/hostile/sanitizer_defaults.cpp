// SPDX-License-Identifier: BSD-3-Clause
//
// Sanitizer options for other libraries on damaged files: they may request absurd amounts of memory if they handle the
// failure, and may leak memory when they give up, which must not hide leaks of tegl.
extern "C" {
const char* __asan_default_options();       // NOLINT: the names are the sanitizers'
const char* __lsan_default_suppressions();  // NOLINT

const char* __asan_default_options() { return "allocator_may_return_null=1"; }  // NOLINT
const char* __lsan_default_suppressions() {                                     // NOLINT
  return "leak:libhdf5\nleak:libnetcdf\nleak:libassimp\n";
}
}
