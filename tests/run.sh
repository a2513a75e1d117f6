#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The README's second command: installs what Debian provides, builds for use and runs the first tier of tests,
# all that find faults quickly: C++, the program from outside, the Python module, the charts and the page.
#   tests/run.sh --all    and the second tier: sanitizers, every instruction set, fuzzers, all planted errors, calls and
#                         allocations that fail, large random runs, both browsers. A night on two cores.
set -eu
cd "$(dirname "$0")/.."
case "${1:-}" in
  "") tier=tests ;;
  --all) tier=all ;;
  *) echo "tests/run.sh: '$1' is unknown; allowed: --all" >&2; exit 2 ;;
esac
sh sweeps/install_packages.sh $tier

rm -f build/release/first_tier.xml build/release/second_tier.xml
cmake --preset release
cmake --build --preset release --target all tests
first_tier() {  # three more at a time than there are cores, as some wait: browsers, kills
  ctest --preset release --no-tests=error -j $(($(nproc) + 3)) -LE slow --output-junit first_tier.xml
}
if [ $tier = tests ]; then
  first_tier
  exit
fi

failed=""
stage() {  # name, command...: all stages run, whichever fails
  echo; echo "== $1"
  name=$1; shift
  "$@" || failed="$failed, $name"
}
instruction_sets() {
  cmake --preset package && cmake --build --preset package --target all tests &&
    ctest --preset package --no-tests=error -R '^cli\.test_(instruction_sets|install|determinism)$'
}
stage "the first tier" first_tier
stage "large random runs and slow tests" ctest --preset release --no-tests=error -L slow --output-junit second_tier.xml
stage "sanitizers over all C++ tests" sh tests/sanitized.sh
stage "every instruction set" instruction_sets
stage "benchmarks compile" cmake --build --preset release --target benchmarks
stage "fuzzers" sh tests/fuzz/run.sh 600
stage "calls and allocations that fail" sh tests/faults/run.sh
[ -z "$failed" ] || { echo "failed: ${failed#, }" >&2; exit 1; }
/usr/bin/python3 tests/tiers.py --write
