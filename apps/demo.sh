#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The hmtmap authors
# SPDX-License-Identifier: BSD-3-Clause
# Makes a hybrid map from a robot log and exports it; without LOG from a simulated building.
#   bash apps/demo.sh [LOG]
set -euo pipefail

if (($# > 1)) || [[ ${1:-} == -* ]]; then
  echo "usage: bash apps/demo.sh [LOG]" >&2
  exit 2
fi
if (($# == 1)) && [[ ! -e $1 ]]; then
  echo "error: no such log: $1" >&2
  exit 1
fi
log=${1:+$(realpath "$1")}
source "$(dirname "${BASH_SOURCE[0]}")/setup.sh"

install_packages "${build_packages[@]}"
build hmtmap
hmtmap=$build_dir/apps/hmtmap

# try COMMAND...: shows the command; exit code 3 means done with losses, which hmtmap has told.
try() {
  say "hmtmap ${*}"
  local code=0
  "$hmtmap" "$@" || code=$?
  ((code == 3)) || return "$code"
}

run() {
  local code=0
  try "$@" || code=$?
  if ((code != 0)); then
    say "failed with exit code $code" >&2
    exit "$code"
  fi
}

if [[ -z $log ]]; then
  out=$root/build/demo/building
  log=$out/building.clf
  mkdir -p "$out"
  if [[ ! -e $log ]]; then run simulate building -o "$log"; fi
else
  name=$(basename "$log")
  out=$root/build/demo/${name%%.*}
  mkdir -p "$out"
fi

if [[ -e $out/map.hmt ]]; then
  code=0
  try map "$log" -o "$out/map.hmt" || code=$?
  # Refused: of another log of that name, or of an older version. Interrupted, it is gone on with.
  if ((code == 1)); then
    say "making it anew"
    run map "$log" -o "$out/map.hmt" --force
  elif ((code != 0)); then
    exit "$code"
  fi
else
  run map "$log" -o "$out/map.hmt"
fi
run export "$out/map.hmt" -o "$out/export" --force
say "done: map $out/map.hmt"
say "look at $out/export: map.pgm (grid), trajectory.tum, partition.csv, topology.dot, submaps/"
