# SPDX-License-Identifier: GPL-3.0-or-later
"""`cmake --install` gives a program that runs and a library that another project builds on, with its public
headers alone."""
import gzip
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

CONSUMER = Path(__file__).resolve().parents[1] / "consumer"


def run(*command, status=0, **options):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, **options)
    assert done.returncode == status, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def prefix(tmp_path_factory):
    prefix = tmp_path_factory.mktemp("prefix")
    run("cmake", "--install", os.environ["LEAPMAP_BUILD"], "--prefix", prefix)
    return prefix


def test_the_installed_program_runs(prefix):
    assert "0.982801" in run(prefix / "bin/leapmap", "hop")


def test_nothing_but_public_headers_is_installed_and_they_name_no_library(prefix):
    headers = [h for h in (prefix / "include").rglob("*") if h.is_file()]
    assert {h.parent for h in headers} == {prefix / "include/leapmap"}
    for header in headers:
        for included in re.findall(r"#include [<\"]([^>\"]+)", header.read_text()):
            assert "." not in included or included.startswith(
                "leapmap/"), f"{header.name} includes {included}"


def test_the_python_module_the_charts_and_the_page_are_installed(prefix, tmp_path):
    packages = list(prefix.glob("lib/python3*/dist-packages"))
    if not (Path(os.environ["LEAPMAP_BUILD"]) / "python").exists():
        pytest.skip("built without pybind11")
    environment = dict(os.environ, PYTHONPATH=str(packages[0]), MPLBACKEND="Agg")
    run(prefix / "bin/leapmap", "sweep", prefix / "share/leapmap/sweeps/smoke.toml", "-o", tmp_path / "m.h5",
        "--quiet")
    code = ("import leapmap; print(leapmap.__file__, leapmap.load('m.h5').jump_height.shape, "
            "leapmap.solve().jump_height)")
    told = run(sys.executable, "-c", code, cwd=tmp_path, env=environment)
    assert str(packages[0]) in told and "(25, 24)" in told and "0.98280" in told
    run(sys.executable, "-m", "leapmap.charts", "design", "m.h5", "-o", "chart", cwd=tmp_path,
        env=environment)
    assert (tmp_path / "chart_jump_height.png").stat().st_size > 10_000
    if list(packages[0].glob("leapmap/leapmap.wasm")):
        run(sys.executable, "-m", "leapmap.charts", "explorer", "m.h5", cwd=tmp_path, env=environment)
        assert (tmp_path / "m.html").exists()
    assert "is not a chart" in subprocess.run([sys.executable, "-m", "leapmap.charts", "pie"],
                                              env=environment, capture_output=True, text=True).stderr


def test_the_man_page_and_completion_know_every_command(prefix, tmp_path):
    page = gzip.decompress((prefix / "share/man/man1/leapmap.1.gz").read_bytes()).decode()
    script = prefix / "share/bash-completion/completions/leapmap"
    for command in ("sweep", "hop", "info", "check", "precision", "stability"):
        assert f".SH LEAPMAP {command.upper()}" in page
    typed = (f"source {script}; COMP_WORDS=(leapmap hop --offset); COMP_CWORD=2; _leapmap; echo "
             f"${{COMPREPLY[@]}}")
    assert run("bash", "-c", typed).strip() == "--offset-ratio"
    (tmp_path / "my map.h5").touch()
    typed = (f"source {script}; COMP_WORDS=(leapmap info my); COMP_CWORD=2; _leapmap; printf '%s|' "
             f"\"${{COMPREPLY[@]}}\"")
    assert run("bash", "-c", typed, cwd=tmp_path) == "my map.h5|"


@pytest.mark.parametrize("flags", ["", pytest.param("-O0", marks=pytest.mark.slow)])
def test_another_project_builds_on_the_library(prefix, tmp_path, flags):
    run("cmake", "-G", "Ninja", "-S", CONSUMER, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}",
        f"-DCMAKE_CXX_FLAGS={flags} -Wall -Wextra -Werror")
    run("cmake", "--build", tmp_path / "build")
    told = run(tmp_path / "build/consumer", cwd=tmp_path)
    assert "all as it should be" in told
