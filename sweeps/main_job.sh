#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The README's first command: installs what Debian provides, builds leapmap, sweeps slope x mass ratio x L/R around
# the paper's hoop, and draws its charts. Safe to run again: maps and charts are made anew.
set -eu
cd "$(dirname "$0")/.."

sh sweeps/install_packages.sh main
cmake --preset release -DLEAPMAP_TESTS=OFF -DLEAPMAP_BENCHMARKS=OFF
cmake --build --preset release
leapmap=build/release/leapmap

echo
echo "== the paper's hoop"
$leapmap hop sweeps/paper.toml
$leapmap hop sweeps/paper_figures.toml --trace maps/paper_figures.h5 --trace-interval 5e-4 > /dev/null
echo
echo "== 123,904 designs over slope x mass ratio x L/R"
$leapmap sweep sweeps/slope_mass_ratio_offset.toml --overwrite || [ $? = 1 ]  # 1: the audit disagrees, and says so
echo
echo "== charts"
/usr/bin/python3 analysis/design_chart.py maps/slope_mass_ratio_offset.h5 -o maps/design_chart
/usr/bin/python3 analysis/trace_chart.py maps/paper_figures.h5 -o maps/paper_figures
echo
echo "The design chart: $PWD/maps/design_chart_jump_height.png"
