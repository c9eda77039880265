// SPDX-License-Identifier: BSD-3-Clause
//
// What `gen` does, one function per command. They belong to the program, not to the library: they print to
// standard output. Each takes a checked command line, returns the exit status 0, and throws
// tegl::gen::Error, whose code is the exit status, if it cannot do its work.
#pragma once

#include "program/options.hpp"

namespace tegl::gen {

/// `--count`: orbits of the signatures by Burnside's lemma and, for dim <= 4, by enumeration.
/// Errors: CountMismatch if the two disagree.
int run_count(const Options& options);

/// `--transversal`: the smallest signature of every class, counted by orbit length, or listed. Honours `group`, `list`
/// and `json`. Errors: CountMismatch if their number is not Burnside's, or their orbits do not add up to all
/// signatures.
int run_transversal(const Options& options);

/// `--classes`: every class with its signature, orbit length, stabiliser, facets, components, Euler
/// characteristics and ambiguous faces. Honours `alternative` and `json`.
int run_classes(const Options& options);

/// `--certify`: the certificate of every signature and of all neighbours, and its figures. Honours `json`, and either
/// `table_by_class` with `group` and `inversion`, or `all_resolutions` or `sample` with `seed`, and `threads`.
/// Errors: CertificateFailed.
int run_certify(const Options& options);

/// `--out DIR`: certifies, then writes the tables into DIR. Honours `layout`, `triangulation` and
/// `languages`.
/// Errors: CertificateFailed (nothing is written), WriteFailed.
int run_out(const Options& options);

/// `--cases DIR`: writes the catalogue's page and pictures of a dimension into DIR. Errors: WriteFailed.
int run_cases(const Options& options);

}  // namespace tegl::gen
