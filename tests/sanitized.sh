#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# C++ tests with ASan and UBSan: of some folders and files (tests/sanitized.sh map spec/bad_spec), or all of them.
set -eu
cd "$(dirname "$0")/.."
allowed=$(for file in tests/*/*_test.cpp; do echo "${file%/*}" "${file%_test.cpp}"; done | tr ' ' '\n' | sed 's:^tests/::' | sort -u)
for part in "$@"; do
  echo "$allowed" | grep -qx -e "$part" || { echo "tests/sanitized.sh: '$part' is unknown; allowed:" $allowed >&2; exit 2; }
done
folders=$(echo "${*:-$allowed}" | tr ' ' '\n' | sed 's:/.*::' | sort -u | tr '\n' '|')
cmake --preset dev -DLEAPMAP_TEST_FOLDERS="$(echo "$*" | tr ' ' ';')"
cmake --build --preset dev --target leapmap-tests
ctest --preset dev --no-tests=error -j 2 -L "^(${folders%|})\$"
