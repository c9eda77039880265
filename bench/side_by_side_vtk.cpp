// SPDX-License-Identifier: BSD-3-Clause
//
// The functions of side_by_side.hpp for VTK.
#include <stdexcept>

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges2D.h>
#include <vtkFlyingEdges3D.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSMPTools.h>
#include <vtkVersion.h>

#include "side_measure.hpp"

namespace tegl::bench {
namespace {

template <class Filter>
void run_vtk(Filter* filter, int dim, const float* data, std::size_t samples, double isovalue, SideResult& result) {
  const auto count = static_cast<int>(samples);
  vtkNew<vtkFloatArray> values;
  vtkIdType total = 1;
  for (int a = 0; a < dim; ++a) total *= count;
  values->SetArray(const_cast<float*>(data), total, 1);  // VTK refers to the caller's array and only reads it
  vtkNew<vtkImageData> image;
  image->SetDimensions(count, count, dim == 3 ? count : 1);
  image->GetPointData()->SetScalars(values);
  filter->SetInputData(image);
  filter->SetValue(0, isovalue);
  filter->ComputeScalarsOff();
  measured(result, [&] {
    filter->Update();
    return 0;
  });
  vtkPolyData* output = filter->GetOutput();
  vtkCellArray* cells = dim == 3 ? output->GetPolys() : output->GetLines();
  result.vertices = static_cast<std::uint64_t>(output->GetNumberOfPoints());
  result.simplices = static_cast<std::uint64_t>(cells->GetNumberOfCells());
  const bool normals = output->GetPointData()->GetNormals() != nullptr;
  const std::uint64_t points = result.vertices * 3 * sizeof(float);
  set_output_bytes(result, {points, normals ? points : 0, result.simplices * (dim + 1) * sizeof(vtkIdType)});
}

void set_vtk_threads(int threads) {
  if (!vtkSMPTools::SetBackend(threads == 1 ? "Sequential" : "TBB"))
    throw std::runtime_error("VTK has neither backend: Sequential, TBB");
  vtkSMPTools::Initialize(threads);
}

}  // namespace
}  // namespace tegl::bench

using namespace tegl::bench;

const char* side_vtk_version() { return vtkVersion::GetVTKVersion(); }

int side_vtk(int dim, const float* data, std::size_t samples, double isovalue, int threads, int normals,
             SideResult* result) {
  return guarded([&] {
    set_vtk_threads(threads);
    if (dim == 2 && normals == 0) {
      vtkNew<vtkFlyingEdges2D> filter;
      return run_vtk(filter.Get(), 2, data, samples, isovalue, *result);
    }
    if (dim != 3) throw std::runtime_error("VTK has FlyingEdges2D without normals, and FlyingEdges3D");
    vtkNew<vtkFlyingEdges3D> filter;
    filter->SetComputeNormals(normals);
    filter->ComputeGradientsOff();
    run_vtk(filter.Get(), 3, data, samples, isovalue, *result);
  });
}
