// SPDX-License-Identifier: BSD-3-Clause
//
// How the sanitizers are to treat what libraries do with damaged files: they may ask for absurd amounts of memory, as
// long as they bear the refusal, and keep memory when they give up, which is not to hide leaks of ours.
extern "C" {
const char* __asan_default_options();       // NOLINT: the names are the sanitizers'
const char* __lsan_default_suppressions();  // NOLINT

const char* __asan_default_options() { return "allocator_may_return_null=1"; }  // NOLINT
const char* __lsan_default_suppressions() {                                     // NOLINT
  return "leak:libhdf5\nleak:libnetcdf\nleak:libassimp\n";
}
}
