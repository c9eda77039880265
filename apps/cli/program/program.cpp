// SPDX-License-Identifier: BSD-3-Clause
//
// Assembles the command line of the program: its description, its help and all commands.
#include "program/program.hpp"

#include "commands/demo.hpp"
#include "commands/image_makers.hpp"

namespace tegl::cli {

std::vector<std::unique_ptr<Command>> add_commands(CLI::App& program, const std::string& version) {
  program.description(
      "Contours (isosurfaces) of images and meshes in 2 to 5 dimensions: oriented manifolds.\n"
      "Reads NIfTI, NRRD, MetaImage, NumPy, netCDF, DICOM and VTK; writes PLY, STL, OBJ, glTF and VTKHDF.");
  program.set_version_flag("--version", "tegl " + version);
  program.require_subcommand(1);
  program.footer(
      "To start, run 'tegl demo'. 'tegl COMMAND --help' prints options and examples, 'tegl --man' the manual page,\n"
      "'tegl --completion bash' (zsh, fish) a script that completes commands and options in that shell.\n\n" +
      exit_code_help());
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(make_info_command(program));
  commands.push_back(make_contour_command(program));
  commands.push_back(make_slice_command(program));
  commands.push_back(make_elements_command(program));
  commands.push_back(make_check_command(program));
  commands.push_back(make_project_command(program));
  commands.push_back(make_index_command(program));
  commands.push_back(make_components_command(program));
  commands.push_back(make_measure_command(program));
  commands.push_back(make_track_command(program));
  commands.push_back(make_simplify_command(program));
  commands.push_back(make_filter_command(program));
  commands.push_back(make_scale_space_command(program));
  commands.push_back(make_sample_command(program));
  commands.push_back(make_view_command(program, version));
  commands.push_back(make_demo_command(program));
  return commands;
}

}  // namespace tegl::cli
