#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# clang-tidy, with the checks of .clang-tidy, over the sources that have changed since a revision.
#   tests/tidy.sh [REVISION] [MOST]   default: HEAD~1, 12 files
set -eu
cd "$(dirname "$0")/.."
base=${1:-HEAD~1} most=${2:-12}
git rev-parse -q --verify "$base" > /dev/null || { echo "tidy: there is no revision $base to compare with"; exit 0; }
changed=$(git diff --name-only --diff-filter=d "$base" -- 'src/*.cpp' | grep -v -e '^src/python/' -e '^src/web/' || :)
[ -n "$changed" ] || { echo "tidy: no source has changed since $base"; exit 0; }
all=$(echo "$changed" | wc -l)
some=$(echo "$changed" | head -n "$most")
echo "tidy: $(echo "$some" | wc -l) of $all sources that have changed since $base"
echo "$some" | xargs -P 2 -n 2 sh -c 'clang-tidy --quiet "$@" -- -std=c++20 -fopenmp -Isrc -Ibuild/release/generated -DLEAPMAP_VERSION=\"\" -DLEAPMAP_GIT_REVISION=\"\" -DLEAPMAP_MODULE_FOLDER=\"\" \
  -isystem /usr/include/hdf5/serial -isystem /usr/include/eigen3' tidy
