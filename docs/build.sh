#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the site into build/docs/html, without a warning, and checks its words and links. Needs the build tree,
# for the tables of parameters, fields and keys, the help of the commands and the Python module; LEAPMAP_BUILD
# names it, default build/release.
set -eu
cd "$(dirname "$0")/.."
sh sweeps/install_packages.sh docs
build=$(realpath "${LEAPMAP_BUILD:-build/release}")
if [ ! -x "$build/leapmap" ]; then
  echo "docs/build.sh: $build: lacks leapmap; first: cmake --preset release && cmake --build --preset release" >&2
  exit 2
fi
export LEAPMAP_TOP="$PWD" LEAPMAP_DOXYGEN="$PWD/build/docs/doxygen" PYTHONDONTWRITEBYTECODE=1
export PYTHONPATH="$build/python" PATH="$build:$PATH"
/usr/bin/python3 docs/lint_words.py
rm -rf build/docs
mkdir -p build/docs/source build/docs/doxygen
cp -r docs/. build/docs/source
ln -s ../../analysis build/docs/analysis
doxygen docs/Doxyfile
/usr/bin/python3 docs/reference_pages.py build/docs/source/reference
/usr/bin/python3 -m sphinx -q -W --keep-going -j auto -d build/docs/doctrees build/docs/source build/docs/html
/usr/bin/python3 docs/check_site.py build/docs/html
echo "The site: $PWD/build/docs/html/index.html"
