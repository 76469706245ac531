#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The hmtmap authors
# SPDX-License-Identifier: BSD-3-Clause
# Checks the source tree against the layout rules and prints one line for each broken one:
#   - includes point one way: apps -> public headers of libsubmap and libgraph; a stage of libsubmap
#     -> earlier stages and libgraph; libgraph -> itself
#   - public headers use Eigen and the standard library only, so other libraries stay in src
#   - libgraph does not know what a sensor is
#   - each file of ours starts with the two SPDX lines
#   bash check_layout.sh ROOT
set -euo pipefail
cd "$1"

# The stages in the order of the data. A file directly in hmt/submap or src serves every stage if it
# is one of common_files and joins all stages otherwise.
stages=(common observation log registration overlap partition local link map export all)
common_files=' run.hpp '

broken=0
complain() {
  echo "$*"
  broken=$((broken + 1))
}

# Prints "FILE PATH" for every include of PATH below the folders.
includes() {
  grep -rE --include='*.hpp' --include='*.cpp' '^[[:space:]]*#[[:space:]]*include' "$@" |
    sed -nE 's/^([^:]+):[^<"]*[<"]([^>"]+)[>"].*/\1 \2/p' | LC_ALL=C sort
}

# Sets `rank` to the place of the stage of a path below hmt/submap or src, -1 if it is in no stage.
set_rank() {
  local folder=${1%%/*} i
  if [[ $1 != */* ]]; then
    folder=all
    if [[ $common_files == *" $1 "* ]]; then folder=common; fi
  fi
  rank=-1
  for i in "${!stages[@]}"; do
    if [[ ${stages[i]} == "$folder" ]]; then rank=$i; fi
  done
}

is_public_header() { [[ -e libgraph/include/$1 || -e libsubmap/include/$1 ]]; }

check_graph() {
  local file path
  while read -r file path; do
    if [[ $path == hmt/submap/* ]]; then complain "$file includes $path: libgraph stands alone"; fi
  done < <(includes libgraph)
  while read -r file; do
    complain "$file: libgraph knows numbers and graphs only, no scan, sensor, cloud or laser"
  done < <(grep -rliE 'scan|sensor|cloud|laser' libgraph --include='*.hpp' --include='*.cpp' || true)
}

check_submap() {
  local file path own rank
  while read -r file path; do
    own=${file#libsubmap/include/hmt/submap/}
    set_rank "${own#libsubmap/src/}"
    own=$rank
    if ((own < 0)); then
      complain "$file: its folder is none of the stages ${stages[*]:1:9}"
    elif [[ $path == hmt/submap/* ]]; then
      set_rank "${path#hmt/submap/}"
      if ((rank < 0 || rank > own)); then
        complain "$file includes $path: a stage uses earlier stages only"
      fi
    fi
  done < <(includes libsubmap)
}

check_public_headers() {
  local file path
  while read -r file path; do
    case $path in
      hmt/*) is_public_header "$path" || complain "$file includes $path: not a public header" ;;
      Eigen/*) ;;
      */* | *.h | *.hpp) complain "$file includes $path: only Eigen and std in public headers" ;;
    esac
  done < <(includes libgraph/include libsubmap/include)
}

check_apps() {
  local file path
  while read -r file path; do
    case $path in
      hmt/*) is_public_header "$path" || complain "$file includes $path: not a public header" ;;
      *lib*/src/* | ceres/* | pcl/* | octomap/* | tbb/* | oneapi/* | boost/* | sqlite3.h | cholmod.h)
        complain "$file includes $path: apps use our public headers" ;;
    esac
  done < <(includes apps)
}

check_licence_lines() {
  local file
  while read -r file; do
    if [[ $(head -3 "$file" | grep -cE '^(//|#) SPDX-(FileCopyrightText: 2026 The hmtmap authors|License-Identifier: BSD-3-Clause)$') != 2 ]]; then
      complain "$file: the two SPDX lines are missing"
    fi
  done < <(find CMakeLists.txt apps libgraph libsubmap tests .ci -type f \
    \( -name '*.hpp' -o -name '*.cpp' -o -name '*.sh' -o -name CMakeLists.txt -o -path .ci/run \) |
    LC_ALL=C sort)
}

check_graph
check_submap
check_public_headers
check_apps
check_licence_lines
if ((broken > 0)); then
  echo "layout: $broken rules broken"
  exit 1
fi
echo "layout: all rules kept"
