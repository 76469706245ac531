#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The hmtmap authors
# SPDX-License-Identifier: BSD-3-Clause
# Installs a build to a temporary prefix, builds the consumer project against it and runs both.
#   bash tests/install/run.sh BUILD_DIR
set -euo pipefail
build_dir=$(realpath "$1")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build_dir" --prefix "$work/first" >/dev/null
# The package must not know where it was installed first.
mv "$work/first" "$work/prefix"
cmake -S "$here" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$work/prefix" --log-level=WARNING
cmake --build "$work/build"
"$work/build/consumer"
"$work/prefix/bin/hmtmap" --version
