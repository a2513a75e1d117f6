#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# C++ tests with ASan and UBSan: of some folders (tests/sanitized.sh map support), or of all of them.
set -eu
cd "$(dirname "$0")/.."
allowed=$(for file in tests/*/*_test.cpp; do basename "$(dirname "$file")"; done | sort -u)
for folder in "$@"; do
  echo "$allowed" | grep -qx -e "$folder" || { echo "tests/sanitized.sh: '$folder' is unknown; allowed:" $allowed >&2; exit 2; }
done
folders=$(echo "${*:-$allowed}" | tr ' \n' '||')
cmake --preset dev -DLEAPMAP_TEST_FOLDERS="$(echo "$*" | tr ' ' ';')"
cmake --build --preset dev --target leapmap-tests
ctest --preset dev --no-tests=error -j 2 -L "^($folders)\$"
