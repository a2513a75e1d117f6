#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Fuzzes the spec's parser, all that reads maps in C++ and read_map in Python, side by side, for so many seconds (default 600) from the corpus
# here; ends with an error and the input that shows it if there is a finding.
set -eu
cd "$(dirname "$0")/../.."
seconds=${1:-600}
cmake --preset fuzz > /dev/null
cmake --build --preset fuzz --target spec-fuzz map-fuzz
work=$(mktemp -d "$([ -w /dev/shm ] && echo /dev/shm || echo /tmp)/leapmap-fuzz-XXXXXX")  # in memory: files are synced all the time
export TMPDIR="$work" LSAN_OPTIONS="suppressions=$PWD/tests/fuzz/leaks_of_others.txt:print_suppressions=0"
trap 'rm -rf "$work"' EXIT
for subject in spec map; do
  mkdir "$work/$subject"
  build/fuzz/tests/fuzz/$subject-fuzz -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4096 -max_len=4096 -print_final_stats=1 \
    -artifact_prefix="build/fuzz/$subject-" "$work/$subject" "tests/fuzz/corpus/$subject" > "$work/$subject.log" 2>&1 &
  eval "process_$subject=$!"
done
# A program of another build will do to make the map that read_map is shown changes of.
program=$(ls build/release/leapmap build/dev/leapmap 2>/dev/null | head -1)
failed=0
[ -z "$program" ] || LEAPMAP=$program /usr/bin/python3 tests/fuzz/read_map_fuzz.py "$seconds" || failed=1
for subject in spec map; do
  eval "wait \$process_$subject" || failed=1
  echo "$subject: $(grep -E 'stat::number_of_executed_units|stat::new_units_added|SUMMARY|ERROR' "$work/$subject.log" | tr -s ' \n' ' ')"
  [ $failed = 0 ] || tail -60 "$work/$subject.log"
done
exit $failed
