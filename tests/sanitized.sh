#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# C++ tests with ASan and UBSan: of some folders (tests/sanitized.sh map support), or of all of them.
set -eu
cd "$(dirname "$0")/.."
cmake --preset dev
cmake --build --preset dev --target leapmap-tests
folders=$(echo "$*" | tr ' ' '|')
ctest --preset dev --no-tests=error -j 2 -LE '^(slow|cli|python|analysis|mutation)$' ${folders:+-L "^($folders)\$"}
