#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The hmtmap authors
# SPDX-License-Identifier: BSD-3-Clause
# Builds hmtmap and runs all its tests; further arguments go to ctest (-L LABEL, -R NAME).
#   bash tests/run.sh [CTEST_ARGUMENT...]
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/../apps/setup.sh"

install_packages "${build_packages[@]}"
build
say "testing"
cd "$root"
ctest --preset "$preset" -j "$(nproc)" "$@"
