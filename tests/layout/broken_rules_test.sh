#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The hmtmap authors
# SPDX-License-Identifier: BSD-3-Clause
# check_layout.sh accepts a small sound tree and names each rule that is broken in it.
set -euo pipefail
check=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/check_layout.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

spdx=$'// SPDX-FileCopyrightText: 2026 The hmtmap authors\n// SPDX-License-Identifier: BSD-3-Clause'
submap=libsubmap/include/hmt/submap

# put FILE LINE: a file with the licence lines and LINE.
put() {
  mkdir -p "$(dirname "$1")"
  printf '%s\n%s\n' "$spdx" "$2" >"$1"
}

sound_tree() {
  rm -rf "$work/tree"
  mkdir -p "$work"/tree/{tests,.ci}
  cd "$work/tree"
  echo "${spdx//\/\//#}" >CMakeLists.txt
  put libgraph/include/hmt/graph/pose.hpp '#include <Eigen/Core>'
  put $submap/log/log.hpp '#include "hmt/graph/pose.hpp"'
  put $submap/map/map.hpp '#include "hmt/submap/log/log.hpp"'
  put $submap/pipeline.hpp '#include "hmt/submap/map/map.hpp"'
  put libsubmap/src/map/map.cpp '#include <sqlite3.h>'
  put apps/main.cpp '#include "hmt/submap/map/map.hpp"'
}

# refused FILE LINE WORDS: with LINE as the content of FILE the check fails and says WORDS of it.
refused() {
  sound_tree
  put "$1" "$2"
  local said
  if said=$(bash "$check" .); then
    echo "accepted: $1 with $2"
    exit 1
  fi
  if [[ $said != *"$1"*"$3"* ]]; then
    echo "no word of '$3' about $1 in: $said"
    exit 1
  fi
}

sound_tree
bash "$check" .
refused libgraph/src/a.cpp '#include "hmt/submap/log/log.hpp"' 'stands alone'
refused libgraph/src/a.cpp '// the laser' 'numbers and graphs only'
refused $submap/log/log.hpp '#include "hmt/submap/map/map.hpp"' 'earlier stages'
refused $submap/map/map.hpp '#include "hmt/submap/pipeline.hpp"' 'earlier stages'
refused $submap/sonar/a.hpp '#include <vector>' 'none of the stages'
refused $submap/map/map.hpp '#include <octomap/octomap.h>' 'only Eigen and std'
refused $submap/map/map.hpp '#include "table.hpp"' 'only Eigen and std'
refused apps/main.cpp '#include "hmt/submap/map/table.hpp"' 'not a public header'
refused apps/main.cpp '#include <ceres/ceres.h>' 'our public headers'
sound_tree
echo '#include <vector>' >apps/main.cpp
if bash "$check" . >/dev/null; then
  echo "accepted: a file without SPDX lines"
  exit 1
fi
echo "all broken rules found"
