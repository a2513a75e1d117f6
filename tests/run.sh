#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The README's second command: installs what Debian provides, builds with ASan and UBSan, runs the C++ tests there,
# fuzzes the readers for ten seconds, then builds for use and runs all tests: C++, the program from outside, the readers of its files, the charts.
set -eu
cd "$(dirname "$0")/.."
sh sweeps/install_packages.sh tests

git ls-files 'src/*.[ch]pp' 'tests/*.[ch]pp' | xargs -r clang-format --dry-run -Werror

cmake --preset dev -DLEAPMAP_TESTS=ON
cmake --build --preset dev --target leapmap-tests
ctest --preset dev --no-tests=error -j 2 -LE slow -E '^(cli|python|analysis|mutation)\.'

sh tests/fuzz/run.sh 10

cmake --preset release -DLEAPMAP_STRICT=ON -DLEAPMAP_TESTS=ON -DLEAPMAP_BENCHMARKS=ON
cmake --build --preset release
ctest --preset release --no-tests=error -j 2 -LE slow
