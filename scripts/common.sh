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

# system_name: what the system says it is called.
system_name() { (. /etc/os-release 2>/dev/null && echo "${PRETTY_NAME:-unknown}") || echo "unknown"; }

# is_debian_12: whether this is the system that tegl is built and tested on.
is_debian_12() { (. /etc/os-release 2>/dev/null && [[ ${ID:-} == debian && ${VERSION_ID:-} == 12 ]]); }

# elsewhere: what helps on a system that lacks packages.
elsewhere() {
  printf '%s' "tegl is built and tested on Debian 12, and this is $(system_name). Either install them in another way and build " \
    "by hand ($root/docs/getting-started.md), or work in a container: " \
    "docker run -it -v '$root:/tegl' -w /tegl debian:12"
}

# install_packages PACKAGE...: installs the Debian packages that are missing. If none is, it touches nothing and needs
# neither network nor root.
install_packages() {
  local missing unknown as_root=() current=yes
  command -v apt-get >/dev/null || fail "no apt-get to install these packages: $*. $(elsewhere)"
  mapfile -t missing < <(missing_packages "$@")
  if [[ ${#missing[@]} -eq 0 ]]; then
    echo "Set-up: all $# packages are installed."
    return
  fi
  is_debian_12 || say "This is $(system_name). tegl is built and tested on Debian 12; packages may be missing here"
  say "Installing ${#missing[@]} of $# Debian packages: ${missing[*]}"
  if [[ $(id -u) -ne 0 ]]; then
    command -v sudo >/dev/null || fail "neither root nor sudo. Run this as root once, then start again:
  apt-get update && apt-get install --no-install-recommends ${missing[*]}"
    as_root=(sudo)
  fi
  fetch_package_lists "${as_root[@]}" || current=
  mapfile -t unknown < <(unknown_packages "${missing[@]}")
  if [[ ${#unknown[@]} -ne 0 ]]; then
    [[ -n $current ]] || fail "some lists of packages could not be fetched (see the messages before), and the others do not contain: ${unknown[*]}"
    fail "packages that this system does not provide: ${unknown[*]}. $(elsewhere)"
  fi
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}" ||
    fail "apt-get could not install them (see its messages). If the network failed, start again: fetched packages are kept"
  mapfile -t missing < <(missing_packages "$@")
  [[ ${#missing[@]} -eq 0 ]] || fail "apt-get succeeded, but these packages are still not installed: ${missing[*]}"
}

# fetch_package_lists [sudo]: what packages there are. Fails if one of the sources could not be asked, and ends if none could.
fetch_package_lists() {
  local log status=0
  log=$(mktemp)
  "$@" apt-get -o APT::Update::Error-Mode=any update 2>&1 | tee "$log" || status=$?
  if [[ $status -ne 0 ]] && ! grep -qE '^(Hit|Get):' "$log"; then
    rm "$log"
    fail "no list of packages could be fetched: check the network (behind a proxy: http_proxy), then start again"
  fi
  rm "$log"
  return "$status"
}

# unknown_packages PACKAGE...: those of them that apt has nothing to install of, one per line.
unknown_packages() {
  local package policy
  for package in "$@"; do
    policy=$(apt-cache policy "$package" 2>/dev/null) || true
    [[ $policy =~ Candidate:\ [^\(] ]] || echo "$package"
  done
}

# The number of compilers to run at a time: one per core, but at most one per 2.2 GB of memory, which is what the
# largest sources need. JOBS overrides it.
job_count() {
  if [[ -n ${JOBS:-} ]]; then
    echo "$JOBS"
    return
  fi
  local cores by_memory
  cores=$(nproc)
  by_memory=$(awk '/^MemAvailable:/ { n = int($2 / 2200000); print n < 1 ? 1 : n }' /proc/meminfo)
  echo $((cores < by_memory ? cores : by_memory))
}

# build PRESET [TARGET...]: configures and builds it in build/PRESET (`program`: build/release); generates the tables first.
build() {
  local preset=$1
  shift
  # ccache, where it is installed, makes a rebuild after a change of branch quick. CMake reads these variables. The presets
  # test, demo and program compile many sources together, which it rarely has, and test precompiles headers instead.
  if [[ ! $preset =~ ^(test|demo|program)$ ]] && command -v ccache >/dev/null; then
    export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
    # Checkouts in other folders share what is in the cache: paths below the checkout count from it.
    export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}
  fi
  local version
  version=$(cmake --version | sed -n 's/^cmake version //p')
  printf '3.25\n%s\n' "$version" | sort -C -V || fail "CMake 3.25 or later is needed; $(command -v cmake) is $version"
  say "Configuring the preset $preset"
  cmake --preset "$preset"
  say "Building the preset $preset with $(job_count) jobs (the build runs the generator for 2D, 3D and 4D first)"
  cmake --build --preset "$preset" -j "$(job_count)" ${1:+--target "$@"}
}
