// SPDX-License-Identifier: BSD-3-Clause
//
// The C interface for side_by_side.py, which times tegl and VTK on memory that NumPy owns. Each function makes one
// contour and frees it after the clock has stopped. It returns 0, or 1 with a reason in side_error().
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

struct SideResult {
  double seconds = 0;  // wall time
  std::uint64_t vertices = 0;
  std::uint64_t simplices = 0;
  std::uint64_t active_tiles = 0;          // tegl only
  std::uint64_t output_bytes = 0;          // of vertices, simplices and normals
  std::uint64_t extra_bytes = 0;           // peak memory in addition to input and output
  std::uint64_t page_faults = 0;           // while the clock was running
  double stage_seconds[4] = {0, 0, 0, 0};  // tegl only: classify, find, generate, close
};

const char* side_error();
const char* side_vtk_version();

/// Bytes per second of reading memory, and of writing new memory with huge pages.
int side_memory_rates(int threads, double* read, double* fresh_write);

/// Fills samples^dim floats with a field of fields.hpp.
int side_field(const char* name, int dim, std::size_t samples, float* out);

int side_tegl(int dim, const float* data, std::size_t samples, double isovalue, int threads, int normals,
              SideResult* result);
/// dim 2 or 3: FlyingEdges2D, FlyingEdges3D. One thread: VTK's sequential backend; more: its TBB backend.
int side_vtk(int dim, const float* data, std::size_t samples, double isovalue, int threads, int normals,
             SideResult* result);
}
