#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Makes the pictures of the README and the first jump: charts, the animation, and the page as chromium shows it. Needs the
# first command's map and page (sweeps/main_job.sh); the README's other pictures come by the commands beside them.
set -eu
cd "$(dirname "$0")/.."
command -v chromium > /dev/null || sh sweeps/install_packages.sh tests
[ -f maps/slope_mass_ratio_offset.html ] || sh sweeps/main_job.sh

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
/usr/bin/python3 analysis/design_chart.py maps/slope_mass_ratio_offset.h5 -o "$work/design_chart" > /dev/null
cp "$work/design_chart_jump_height.png" analysis/pictures/
/usr/bin/python3 analysis/trace_chart.py maps/paper_figures.h5 --paper -o "$work/paper_figures" > /dev/null
cp "$work/paper_figures_flight.png" analysis/pictures/
build/release/leapmap hop --trace "$work/hop.h5" > /dev/null
/usr/bin/python3 analysis/jump_chart.py "$work/hop.h5" --animate -o "$work/jump" > /dev/null
cp "$work/jump.png" "$work/jump.gif" analysis/pictures/
# The paper's hoop, or the design nearest to it, at the apex of its jump.
chromium --headless=new --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking \
  --disable-component-update --disable-sync --hide-scrollbars --user-data-dir="$work/chromium" --window-size=1400,1470 \
  --virtual-time-budget=5000 --screenshot="$PWD/analysis/pictures/explorer.png" \
  "file://$PWD/maps/slope_mass_ratio_offset.html#time=0.66" 2> "$work/log" || { cat "$work/log" >&2; exit 1; }
ls -l analysis/pictures/design_chart_jump_height.png analysis/pictures/paper_figures_flight.png analysis/pictures/jump.* analysis/pictures/explorer.png
