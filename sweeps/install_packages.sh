#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Installs what leapmap needs from Debian 12's packages, as root or with sudo; does nothing if all is there.
#   install_packages.sh main    to build, to run and to draw
#   install_packages.sh tests   for the tests as well
#   install_packages.sh docs    for the site
#   install_packages.sh all     for both tiers of tests and the benchmarks
# Several in one call take less time than one by one.
set -eu
for kind in "$@"; do
  case "$kind" in
    main | tests | docs | all) ;;
    *) echo "install_packages.sh: '$kind' is unknown; allowed: main, tests, docs, all" >&2; exit 2 ;;
  esac
done
kinds=" $* "
is_for() {  # kind
  case "$kinds" in *" $1 "* | *" all "*) ;; *) return 1 ;; esac
}
packages="g++ cmake ninja-build git file dpkg-dev libgsl-dev libhdf5-dev libfmt-dev libtomlplusplus-dev
  libcli11-dev libxsimd-dev nlohmann-json3-dev libdeflate-dev zlib1g-dev libudunits2-dev libeigen3-dev
  libpugixml-dev libzip-dev libnlopt-cxx-dev libboost-dev libflint-arb-dev emscripten esbuild
  node-d3-brush node-d3-drag node-d3-scale node-d3-selection pybind11-dev python3-dev python3 python3-numpy python3-h5py
  python3-matplotlib python3-xarray"
if is_for docs; then
  packages="$packages doxygen python3-sphinx python3-myst-parser python3-breathe furo codespell"
fi
if is_for tests; then
  packages="$packages libgtest-dev clang-format clang-tidy hdf5-tools netcdf-bin python3-scipy
    python3-openturns python3-pytest python3-netcdf4 python3-h5netcdf python3-selenium
    chromium chromium-driver node-typescript poppler-utils parallel"
fi
if is_for all; then
  packages="$packages libbenchmark-dev clang libclang-rt-14-dev libomp-dev qemu-user slurm-wlm munge
    firefox-esr"
fi
missing=""
for package in $packages; do
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing="$missing $package"
done
[ -z "$missing" ] && exit 0
echo "installing:$missing"
if [ "$(id -u)" = 0 ]; then
  root=""
elif command -v sudo > /dev/null; then
  root="sudo"
else
  echo "install_packages.sh: these Debian packages are missing and neither root nor sudo is at hand:$missing" >&2
  exit 1
fi
$root apt-get update -qq
$root env DEBIAN_FRONTEND=noninteractive apt-get install -qq -y --no-install-recommends $missing
