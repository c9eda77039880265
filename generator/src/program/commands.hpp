// SPDX-License-Identifier: BSD-3-Clause
//
// The commands of `gen`, one function each. They belong to the program, not to the library: they print to standard
// output. Each takes a checked command line and returns the exit status 0. On failure it throws tegl::gen::Error, whose
// code is the exit status.
#pragma once

#include "program/options.hpp"

namespace tegl::gen {

/// No command: makes and certifies all tables and the builder as `--out`, `--certify` and `--builder` do, writes
/// nothing, and prints the numbers of classes, the certificates' figures and the sizes. In 5D a sample of tiles takes
/// the place of tables. Uses `tile` and `json`. Errors: CountMismatch, CertificateFailed.
int run_summary(const Options& options);

/// `--count`: number of orbits of signatures by Burnside's lemma and, for dim <= 4, by enumeration. Errors:
/// CountMismatch if the two differ.
int run_count(const Options& options);

/// `--transversal`: the smallest signature of every class, counted by orbit length, or listed. Uses `group`, `list` and
/// `json`. Errors: CountMismatch if the number of classes differs from Burnside's, or the orbit lengths do not sum to
/// the number of signatures.
int run_transversal(const Options& options);

/// `--symmetries`: the elements of a group as words, with the signatures that they fix, and the isotropy group of every
/// class. Uses `group`, `inversion` and `json`. Errors: CountMismatch if the fixed points contradict the classes.
int run_symmetries(const Options& options);

/// `--classes`: every class with its signature, orbit length, stabiliser, facets, components, Euler characteristics and
/// ambiguous faces. Uses `alternative` and `json`.
int run_classes(const Options& options);

/// `--certify`: certifies every signature and all neighbours, and prints figures. Uses `json` and either
/// `table_by_class` with `group` and `inversion`, or `all_resolutions` or `sample` with `seed`, and `threads`. Errors:
/// CertificateFailed.
int run_certify(const Options& options);

/// `--out DIR`: certifies, then writes the tables into DIR. Uses `layout`, `triangulation` and `languages`. Errors:
/// CertificateFailed (nothing is written), WriteFailed.
int run_out(const Options& options);

/// `--cases DIR`: writes the catalogue's page and pictures of a dimension into DIR. Errors: WriteFailed.
int run_cases(const Options& options);

/// `--builder`: certifies, then prints the source of the builder of a tile or, with `out`, writes it and its manifest
/// into the folder `out`. Uses `leaf` and `languages`. Errors: InvalidArgument for a language that the dimension does
/// not have, CertificateFailed (nothing is written), WriteFailed.
int run_builder(const Options& options);

/// `--cells`: makes and certifies the tables of mesh cells, prints their figures, and with `out` writes them and their
/// manifest into the folder `out`. Errors: CountMismatch, CertificateFailed (nothing is written), WriteFailed.
int run_cells(const Options& options);

/// No command with a mesh cell as tile: counts the classes of its four groups, makes and certifies its tables, and
/// prints figures. Uses `cell` and `json`. Errors: CountMismatch, CertificateFailed.
int run_cell_summary(const Options& options);

/// `--certify` with a mesh cell: certifies every signature of both alternatives one by one, and the tables; their
/// figures must agree. Uses `cell` and `json`. Errors: CountMismatch, CertificateFailed.
int run_cell_certify(const Options& options);

/// `--out DIR` with a mesh cell: certifies its tables, then writes them into DIR. Uses `cell`, `triangulation` and
/// `languages`. Errors: CertificateFailed (nothing is written), WriteFailed.
int run_cell_out(const Options& options);

}  // namespace tegl::gen
