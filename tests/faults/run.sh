#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Walks through every call of every command with every error, once and from there on, and through allocations:
# all of seven commands, and every 997th of C++ in the others, which make hundreds of thousands. Some hours on
# two cores. Ends with an error if there is a finding.
#   tests/faults/run.sh [EVERY]    every so-many-th of these only
set -eu
cd "$(dirname "$0")/../.."
sh sweeps/install_packages.sh tests
cmake --preset release > /dev/null
cmake --build --preset release --target leapmap-program leapmap-faults leapmap-wasm
failed=0
/usr/bin/python3 tests/faults/walk.py --every "${1:-1}" || failed=1
for memory in new malloc; do
  /usr/bin/python3 tests/faults/walk.py --every "${1:-1}" --memory $memory --commands sweep resume retry overwrite trace info check || failed=1
done
/usr/bin/python3 tests/faults/walk.py --every $((997 * ${1:-1})) --memory new --commands boundaries design fit gait shard join python || failed=1
exit $failed
