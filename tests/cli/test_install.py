# SPDX-License-Identifier: GPL-3.0-or-later
"""`cmake --install` gives a program that runs and a library that another project finds and links."""
import os
import subprocess

CMAKELISTS = """
cmake_minimum_required(VERSION 3.25)
project(other LANGUAGES CXX)
find_package(leapmap REQUIRED)
add_executable(other main.cpp)
target_link_libraries(other PRIVATE leapmap::leapmap)
"""
MAIN = """
#include <cstdio>
#include <map/reader.hpp>
#include <rolling/rolling_integration.hpp>
int main(int, char** arguments) {
  leapmap::IntegrationOptions options;
  options.stepper = leapmap::find_gsl_stepper("gsl-rk8pd");
  const leapmap::Outcome outcome = leapmap::RollingIntegration(options).solve(leapmap::Design{}, leapmap::Scene{});
  std::printf("%.6f\\n", outcome.jump_height);
  const leapmap::MapReader map(arguments[1]);
  const leapmap::Tile first_two{{0}, {2}, 2};
  std::printf("%.6f\\n", map.read("jump_height", first_two)[1]);
}
"""


def test_an_installed_leapmap_runs_and_is_found_by_another_project(tmp_path):
    prefix = tmp_path / "prefix"

    def run(*command):
        done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    run("cmake", "--install", os.environ["LEAPMAP_BUILD"], "--prefix", prefix)
    assert "0.982801" in run(prefix / "bin/leapmap", "hop")
    other = tmp_path / "other"
    other.mkdir()
    (other / "CMakeLists.txt").write_text(CMAKELISTS)
    (other / "main.cpp").write_text(MAIN)
    run("cmake", "-G", "Ninja", "-S", other, "-B", other / "build", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", other / "build")
    (tmp_path / "spec.toml").write_text("[design]\nmass_ratio = { values = [2, 2.4390243902439024] }\n")
    run(prefix / "bin/leapmap", "sweep", tmp_path / "spec.toml", "-o", tmp_path / "map.h5")
    assert run(other / "build/other", tmp_path / "map.h5").split() == ["0.982801", "0.982801"]
