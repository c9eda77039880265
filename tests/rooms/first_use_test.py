#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""No table of the libraries is computed at first use: the generator emits it, or the compiler computes it.

A static variable of a function that is initialised at the first call has a guard variable. Fails if a library has one
of tegl's own that ALLOWED does not name, and if ALLOWED names one that no library has.

    first_use_test.py NM LIBRARY...
"""

import re
import subprocess
import sys

# By the end of the name of the variable: why it may be initialised at first use.
ALLOWED = {
    "known_fields()::known": "names and texts for messages and lists of the fields' parameters; no contour reads it",
}


def guarded(symbols):
    """The names of tegl's own variables with guards, in the output of `nm -C`."""
    names = re.findall(r"guard variable for (.*)", symbols)
    return sorted({name for name in names if name.startswith("tegl::")})


def faults(symbols):
    """What is wrong with the symbols, by line."""
    names = guarded(symbols)
    found = [f"{name} is initialised at first use; expected constexpr, or a table that gen emits"
             for name in names if not any(name.endswith(allowed) for allowed in ALLOWED)]
    return found + [f"ALLOWED names {allowed}, which no library has; expected only variables that there are"
                    for allowed in ALLOWED if not any(name.endswith(allowed) for name in names)]


def main():
    # A library of this kind is found.
    table = "0000 u guard variable for tegl::detail::Table<2>::instance()::table\n"
    known = "0000 b guard variable for tegl::(anonymous namespace)::known_fields()::known\n"
    others = "0000 u guard variable for Eigen::internal::sizes()::m\n0000 T tegl::detail::Table<2>::instance()\n"
    assert len(faults(known + table + others)) == 1 and "Table<2>" in faults(known + table)[0]
    assert len(faults(others)) == 1 and not faults(known + others)

    nm, libraries = sys.argv[1], sys.argv[2:]
    symbols = "".join(subprocess.run([nm, "-C", library], check=True, capture_output=True, text=True).stdout
                      for library in libraries)
    if not symbols.strip():
        print(f"{', '.join(libraries)}: no symbols; expected libraries that are not stripped")
        return 1
    found = faults(symbols)
    print("\n".join(found) or f"{len(guarded(symbols))} variable(s) initialised at first use, as listed")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
