// SPDX-License-Identifier: BSD-3-Clause
//
// The libraries behind some formats keep memory when they give a damaged file up; under AddressSanitizer that is not
// to hide leaks of ours.
extern "C" const char* __lsan_default_suppressions();  // NOLINT: the name is the sanitizer's

extern "C" const char* __lsan_default_suppressions() {  // NOLINT
  return "leak:libhdf5\nleak:libnetcdf\nleak:libITKNrrdIO\nleak:libITKMetaIO\nleak:libassimp\n";
}
