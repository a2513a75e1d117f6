#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The README's first command: installs what Debian provides, builds leapmap, sweeps slope x mass ratio x L/R
# around the paper's hoop, draws its charts and makes the page to explore it. Safe to run again: it replaces what it
# made before.
set -eu
cd "$(dirname "$0")/.."

sh sweeps/install_packages.sh main
cmake --preset release
cmake --build --preset release --target leapmap-program  # the page's solver comes last
leapmap=build/release/leapmap

echo
echo "== the paper's hoop"
$leapmap hop sweeps/paper.toml
$leapmap hop sweeps/paper_figures.toml --trace maps/paper_figures.h5 --trace-interval 5e-4 > /dev/null
echo
echo "== 123,904 designs over slope x mass ratio x L/R"
$leapmap sweep sweeps/slope_mass_ratio_offset.toml --overwrite || [ $? = 1 ]  # 1: the audit disagrees, and says so
echo
echo "== 74,240 designs with friction, over slope x mass ratio x friction coefficient"
$leapmap sweep sweeps/adequacy_coulomb.toml --overwrite || [ $? = 1 ]
echo
echo "== where the outcomes of both jump"
for map in slope_mass_ratio_offset adequacy_coulomb; do $leapmap boundaries maps/$map.h5 -o maps/$map.cliffs.h5; done
echo
echo "== charts"
/usr/bin/python3 analysis/design_chart.py maps/slope_mass_ratio_offset.h5 -o maps/design_chart
/usr/bin/python3 analysis/design_chart.py maps/adequacy_coulomb.h5 -o maps/design_chart_friction
/usr/bin/python3 analysis/phase_diagram.py maps/slope_mass_ratio_offset.h5 -o maps/phase_diagram
/usr/bin/python3 analysis/status_chart.py maps/slope_mass_ratio_offset.h5 -o maps/status
/usr/bin/python3 analysis/cut_chart.py maps/slope_mass_ratio_offset.h5 -o maps/cut
/usr/bin/python3 analysis/trace_chart.py maps/paper_figures.h5 --paper -o maps/paper_figures
echo
echo "The design chart: $PWD/maps/design_chart_jump_height.png"
echo "The same with friction: $PWD/maps/design_chart_friction_jump_height.png"
echo
echo "== the page, with the solver in it, and the Python module"
cmake --build --preset release
/usr/bin/python3 analysis/explorer maps/slope_mass_ratio_offset.h5
/usr/bin/python3 analysis/explorer -o maps/leapmap.html
echo
echo "The design chart: $PWD/maps/design_chart_jump_height.png"
echo "The same with friction: $PWD/maps/design_chart_friction_jump_height.png"
echo "The page to explore, for any browser: $PWD/maps/slope_mass_ratio_offset.html"
echo "The page that computes, every parameter a slider: $PWD/maps/leapmap.html"
