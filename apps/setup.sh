# SPDX-FileCopyrightText: 2026 The hmtmap authors
# SPDX-License-Identifier: BSD-3-Clause
# Set-up shared by apps/demo.sh, tests/run.sh and .ci/run, which source it: the Debian packages that
# the project needs (the only list of them) and the build. Made for Debian 12; all is idempotent.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

# What building and testing needs.
build_packages=(
  g++ cmake ninja-build
  libboost-iostreams-dev libbz2-dev libceres-dev libcli11-dev libeigen3-dev libgmock-dev libgtest-dev
  liblz4-dev liblzf-dev libmetis-dev liboctomap-dev libspdlog-dev libspectra-dev libsqlite3-dev
  libsuitesparse-dev libtbb-dev libzstd-dev nlohmann-json3-dev zlib1g-dev)
# What the further checks of .ci/run need.
check_packages=(clang clang-format clang-tidy libclang-rt-14-dev octomap-tools)

# CI stops at warnings; a user's compiler may know warnings that ours does not.
preset=release
if [[ ${CI:-} == true ]]; then preset=ci; fi
build_dir=$root/build/$preset

say() { printf '== %s\n' "$*"; }

# install_packages PACKAGE...: installs those that are missing; says what to do where it cannot.
install_packages() {
  local package missing=()
  for package in "$@"; do
    [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] ||
      missing+=("$package")
  done
  if ((${#missing[@]} == 0)); then
    say "packages: all $# installed"
    return
  fi
  say "packages: installing ${missing[*]}"
  if ! command -v apt-get >/dev/null; then
    say "error: no apt-get here; install the equivalents of: ${missing[*]}" >&2
    return 1
  fi
  local as_root=()
  if ((EUID != 0)); then
    if ! command -v sudo >/dev/null; then
      say "error: neither root nor sudo; as root run: apt-get install ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -qq -y --no-install-recommends "${missing[@]}" </dev/null
}

# Compilers at a time: one a core, but 1.5 GB of memory each.
build_jobs() {
  local cores memory_kb
  cores=$(nproc)
  memory_kb=$(awk '/^MemTotal/ {print $2}' /proc/meminfo)
  local by_memory=$((memory_kb / 1500000))
  ((by_memory >= 1)) || by_memory=1
  echo $((cores < by_memory ? cores : by_memory))
}

# build [TARGET...]: configures and builds with the preset.
build() {
  local targets=()
  if (($# > 0)); then targets=(--target "$@"); fi
  say "building $build_dir (preset $preset)"
  (
    cd "$root"
    cmake --preset "$preset" --log-level=WARNING
    cmake --build --preset "$preset" -j "$(build_jobs)" "${targets[@]}"
  )
}
