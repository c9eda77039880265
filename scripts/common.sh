# SPDX-License-Identifier: BSD-3-Clause
#
# What scripts/setup, scripts/test and scripts/demo share; to be sourced by bash, not run.
# Sets `root` (the checkout) and goes there, so that the scripts work from any folder.

set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

# say TEXT...: one line on what happens next, apart from the output of the tools.
say() { printf '\n==> %s\n' "$*"; }

# fail TEXT...: an error message, and the end.
fail() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# missing_packages PACKAGE...: those of them that dpkg does not know as installed, one per line.
missing_packages() {
  local package
  for package in "$@"; do
    if [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) != installed ]]; then
      echo "$package"
    fi
  done
}

# install_packages PACKAGE...: installs the Debian packages that are missing. If none is, it touches nothing and needs
# neither network nor root.
install_packages() {
  local missing as_root=()
  command -v apt-get >/dev/null || fail "needs apt-get (Debian 12 or a relative); packages to install by other means: $*"
  mapfile -t missing < <(missing_packages "$@")
  if [[ ${#missing[@]} -eq 0 ]]; then
    echo "Set-up: all $# packages are installed."
    return
  fi
  say "Installing ${#missing[@]} of $# Debian packages: ${missing[*]}"
  if [[ $(id -u) -ne 0 ]]; then
    command -v sudo >/dev/null || fail "not root, and no sudo: let root run: apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"
  mapfile -t missing < <(missing_packages "$@")
  [[ ${#missing[@]} -eq 0 ]] || fail "apt-get succeeded, but these packages are still not installed: ${missing[*]}"
}

# The number of compilers to run at a time: one per core, but at most one per 2 GiB of memory, which is what
# the sources that include ITK need at worst. JOBS overrides it.
job_count() {
  if [[ -n ${JOBS:-} ]]; then
    echo "$JOBS"
    return
  fi
  local cores by_memory
  cores=$(nproc)
  by_memory=$(awk '/^MemAvailable:/ { n = int($2 / 2097152); print n < 1 ? 1 : n }' /proc/meminfo)
  echo $((cores < by_memory ? cores : by_memory))
}

# build PRESET [TARGET...]: configures and builds build/PRESET; generates the tables on the way.
build() {
  local preset=$1
  shift
  # ccache, where it is installed, makes a rebuild after a change of branch quick. CMake reads these variables.
  if command -v ccache >/dev/null; then
    export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
  fi
  say "Configuring build/$preset"
  cmake --preset "$preset"
  say "Building build/$preset with $(job_count) jobs (the build runs the generator for 2D, 3D and 4D first)"
  cmake --build --preset "$preset" -j "$(job_count)" ${1:+--target "$@"}
}
