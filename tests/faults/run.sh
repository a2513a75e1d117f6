#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Walks through every call of every command with every error, once and from there on, and through every allocation of
# C++: some two hours on two cores. Ends with an error if there is a finding.
#   tests/faults/run.sh [EVERY]    every so-many-th call only
set -eu
cd "$(dirname "$0")/../.."
sh sweeps/install_packages.sh tests
cmake --preset release -DLEAPMAP_TESTS=ON > /dev/null
cmake --build --preset release --target leapmap-program leapmap-faults leapmap-wasm
failed=0
/usr/bin/python3 tests/faults/walk.py --every "${1:-1}" || failed=1
/usr/bin/python3 tests/faults/walk.py --every "${1:-1}" --memory new --commands sweep resume overwrite trace info || failed=1
exit $failed
