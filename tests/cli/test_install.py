# SPDX-License-Identifier: GPL-3.0-or-later
"""`cmake --install` gives a program that runs and a library that another project builds on, with its public headers alone."""
import os
import re
import subprocess
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
            assert "." not in included or included.startswith("leapmap/"), f"{header.name} includes {included}"


@pytest.mark.parametrize("flags", ["", "-O0"])
def test_another_project_builds_on_the_library(prefix, tmp_path, flags):
    run("cmake", "-G", "Ninja", "-S", CONSUMER, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={prefix}",
        f"-DCMAKE_CXX_FLAGS={flags} -Wall -Wextra -Werror")
    run("cmake", "--build", tmp_path / "build")
    told = run(tmp_path / "build/consumer", cwd=tmp_path)
    assert "all as it should be" in told
