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
#include <trajectory/rolling_integration.hpp>
int main() {
  leapmap::IntegrationOptions options;
  options.stepper = leapmap::find_gsl_stepper("gsl-rk8pd");
  const leapmap::Outcome outcome = leapmap::RollingIntegration(options).solve(leapmap::Design{}, leapmap::Scene{});
  std::printf("%.6f\\n", outcome.jump_height);
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
    assert run(other / "build/other").strip() == "0.982801"
