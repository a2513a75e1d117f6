#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes every call of leapmap's commands fail, one run a call, and looks at what each run leaves behind.

Promised is: a run that ends with status 0 left the right file; any other says why in a line, ends by no
signal and in time, leaves older files as they were, and what it left is gone on with to the same values.
tests/faults/run.sh walks through every call; tests/cli/test_faults.py through some of them."""
import argparse
import concurrent.futures
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np

TOP = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("LEAPMAP", str(TOP / "build/release/leapmap"))
INJECTOR = os.environ.get("LEAPMAP_FAULTS", str(TOP / "build/release/tests/libleapmap-faults.so"))
SPEC = """
[design]
slope = { from = 0.1, to = 0.8, count = 9 }
mass_ratio = { from = 0.5, to = 10, count = 11 }
offset_ratio = { values = [0.7, 1.0] }
[numerics]
audit = 0.03
"""
FAILING = SPEC.replace("audit = 0.03", 'method = "gsl-rk8pd"\nmax_steps = 40\naudit = 0')
POINTS = "slope,mass_ratio\n0.4,2.4\n0.3,3\n0.5,1\n"
SMALL = SPEC.replace("count = 9", "count = 4").replace("count = 11", "count = 3").replace(
    "audit = 0.03", "audit = 0")
QUESTION = '[design]\nslope = { from = 0.3, to = 0.5 }\n[goal]\nmaximize = ["jump_height"]\n'
EVENTS = "event,value,error\njump_time,0.54,0.005\njump_height,0.98,0.02\n"
LIST = '[design]\npoints = "points.csv"\n'
SECONDS = 60  # a run that takes longer hangs: the longest takes two


@dataclass
class Command:
    """One command to walk through. In words {0} stands for the folder it works in."""
    name: str
    words: str
    files: dict = field(default_factory=dict)  # what is there before it: name -> text
    before: list = field(default_factory=list)  # commands that make what else is there
    output: str = ""  # the file it makes; empty: what it prints
    after: str = ""  # what goes on with what a failed run left; empty: the same command again
    keeps: tuple = ()  # files that a failed run may not change


SWEEP = "sweep {0}/spec.toml -o {0}/map.h5 --commit-interval 0 --threads 1"
COMMANDS = {
    c.name: c for c in (
        Command("sweep", SWEEP, {"spec.toml": SPEC}, output="map.h5", after=SWEEP + " --resume"),
        Command("list", "sweep {0}/spec.toml -o {0}/new/map.h5 --threads 1",
                {"spec.toml": LIST, "points.csv": POINTS}, output="new/map.h5",
                after="sweep {0}/spec.toml -o {0}/new/map.h5 --threads 1 --resume"),
        Command("overwrite", SWEEP +
                " --overwrite", {"spec.toml": SPEC}, [SWEEP + " --set runway=2"], "map.h5", SWEEP +
                " --resume --overwrite", ("map.h5", )),
        Command("resume", SWEEP + " --resume", {"spec.toml": SPEC}, ["!90 " + SWEEP], "map.h5", SWEEP +
                " --resume"),
        Command("retry", SWEEP + " --retry-failed", {"spec.toml": FAILING}, [SWEEP], "map.h5", SWEEP +
                " --retry-failed", ("map.h5", )),
        Command("trace", "hop --trace {0}/trace.h5", {}, ["hop --slope 0.3 --trace {0}/trace.h5"], "trace.h5",
                keeps=("trace.h5", )),
        Command("info", "info {0}/map.h5", {"spec.toml": SPEC}, [SWEEP], keeps=("map.h5", )),
        Command("failed", "info {0}/map.h5 --failed", {"spec.toml": FAILING}, [SWEEP], keeps=("map.h5", )),
        Command("check", "check {0}/map.h5", {"spec.toml": SPEC}, [SWEEP], keeps=("map.h5", )),
        Command("boundaries",
                "boundaries {0}/spec.toml -o {0}/cliffs.h5 --csv {0}/cliffs.csv --quiet --threads 1",
                {"spec.toml": SMALL, "cliffs.csv": "curve,kind,along\n"}, output="cliffs.csv", keeps=(
                    "cliffs.csv", )),
        Command(
            "design",
            "design {0}/question.toml -o {0}/best.h5 --csv {0}/best.csv --quiet --threads 1 --sample 256 "
            "--most 2 --overwrite",
            {"question.toml": QUESTION, "best.csv": "slope\n0.1\n"}, output="best.csv", keeps=("best.csv", )),
        Command("fit", "fit {0}/events.csv --model sticking --csv {0}/fit.csv --json --threads 1",
                {"events.csv": EVENTS, "fit.csv": "t,quantity,unit,measured\n"}, output="fit.csv", keeps=(
                    "fit.csv", "events.csv")),
        Command("gait", "gait {0}/hoop.toml --most-period 1", {
            "hoop.toml": "[scene]\nrunway = 2\n[design]\nslope = 0.2\nmass_ratio = 3\noffset_ratio = 0.5\n"
        }),
        Command("shard", SWEEP + " --shard 1/2", {"spec.toml": SMALL}, output="map.1-of-2.h5", after=SWEEP +
                " --shard 1/2 --resume"),
        Command("join", "join {0}/map.h5", {"spec.toml": SMALL},
                [SWEEP + " --shard 1/2", SWEEP +
                 " --shard 2/2"], "map.h5", "join {0}/map.h5 --overwrite", ("map.1-of-2.h5",
                                                                            "map.2-of-2.h5")),
        Command("python", "PYTHON {0}/spec.toml {0}/map.h5", {"spec.toml": SMALL}, output="map.h5",
                after="PYTHON {0}/spec.toml {0}/map.h5 overwrite"),
        Command("explorer", "EXPLORER {0}/map.h5", {"spec.toml": SPEC}, [SWEEP, "EXPLORER {0}/map.h5"],
                "map.html", keeps=("map.h5", "map.html")),
    )
}


def argv(words, folder):
    if words.startswith("EXPLORER"):
        return ["/usr/bin/python3", str(TOP / "analysis/explorer"), *shlex.split(words.format(folder))[1:]]
    if words.startswith("PYTHON"):
        # Allocations of libraries that are being loaded end the program by their own doing: later
        # ones count.
        script = (
            "import ctypes, os, sys, leapmap\nif 'FAULT_WAITS' in os.environ: "
            "ctypes.CDLL(None).begin_faults()\ntry: leapmap.sweep(*sys.argv[1:3], threads=1, "
            "overwrite=len(sys.argv) > 3)\n"
            "except (OSError, ValueError, MemoryError) as error: sys.exit(f'leapmap: {error!r}')")
        return ["/usr/bin/python3", "-c", script, *shlex.split(words.format(folder))[1:]]
    return [PROGRAM, *shlex.split(words.format(folder))]


def run(words, folder, **fault):
    """Runs a command; fault: the injector's environment without FAULT_."""
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", PYTHONDONTWRITEBYTECODE="1",
                       MPLCONFIGDIR="/tmp/leapmap-faults-mpl", PYTHONPATH=str(
                           Path(PROGRAM).parent / "python"))
    if fault:
        environment.update(
            {"LD_PRELOAD": INJECTOR, **{"FAULT_" + k.upper(): str(v) for k, v in fault.items()}})
        if words.startswith("PYTHON") and "memory" in fault:
            environment.update({"FAULT_WAITS": "1", "FAULT_TELLS": "1"})
    return subprocess.run(argv(words, folder), env=environment, stdin=subprocess.DEVNULL, capture_output=True,
                          timeout=SECONDS)


def content(path, folder):
    """What a file says, less what changes from run to run."""
    if path.suffix != ".h5":
        return path.read_bytes().replace(str(folder).encode(), b"")
    found = {}
    with h5py.File(path) as file:
        for name, dataset in file.items():
            if isinstance(dataset, h5py.Dataset):
                found[name] = np.asarray(dataset[()]).tobytes(), sorted(map(
                    str, dataset.attrs.items())) if "LIST" not in str(dict(dataset.attrs)) else None
        for name, value in file.attrs.items():
            if name not in ("date", "host", "wall_time", "threads"):
                found["@" + name] = str(value).replace(str(folder), "")
    return found


def prepare(command, folder):
    """Makes what is there before the command."""
    folder.mkdir()
    for name, text in command.files.items():
        (folder / name).write_text(text)
    for words in command.before:
        if words.startswith("!"):  # a call that fails on purpose
            number, words = words[1:].split(" ", 1)
            assert run(words, folder, under=folder, number=number).returncode == 3
        else:
            done = run(words, folder)
            assert done.returncode == 0, done.stderr
    return folder


@dataclass
class Walk:
    """A command, what is there before it, what it makes, and how many calls it takes."""
    command: Command
    before: Path
    right: object
    calls: int

    def judge(self, folder, done):
        """What is wrong with a run; empty: nothing."""
        told = done.stderr.decode(errors="replace").strip()
        # toml++ ends whoever calls it where it may throw nothing, and an interpreter's end is not ours to
        # change.
        # The last allocation that failed, by whom it was asked for.
        last = told.rpartition("libleapmap-faults")[2]
        ended_by_toml = self.command.name == "python" and done.returncode == -6
        ended_by_toml = ended_by_toml and "std::bad_alloc" in told and "libtomlplusplus" in last
        if (done.returncode < 0 or done.returncode > 3) and not ended_by_toml:
            return f"ended by signal or status {done.returncode}: {told[-300:]}"
        result = folder / self.command.output
        if done.returncode == 0:
            got = content(result, folder) if self.command.output else done.stdout.replace(
                str(folder).encode(), b"")
            return "" if got == self.right else "status 0, but the result is not the right one"
        if not told or "Traceback" in told or ("terminate" in told and not ended_by_toml):
            return f"status {done.returncode} without a clear line: {told[-300:]}"
        for name in self.command.keeps:
            unchanged = (folder / name).read_bytes() == (self.before / name).read_bytes()
            # Where the file was in its place already and only saying so failed, it is the right one.
            if not unchanged and (name != self.command.output or content(result, folder) != self.right):
                return f"status {done.returncode}, and {name} was changed: {told[-300:]}"
        again = run(self.command.after or self.command.words, folder)
        if again.returncode != 0:
            return f"cannot be gone on with: {told[-200:]}; then {again.stderr.decode()[-300:]}"
        got = content(result, folder) if self.command.output else again.stdout.replace(
            str(folder).encode(), b"")
        return "" if got == self.right else "gone on with, the result is not the right one"

    def fail(self, fault):
        """One run with a fault, in a folder of its own. Returns a finding, or nothing."""
        with tempfile.TemporaryDirectory(dir=self.before.parent) as name:
            folder = Path(name) / self.before.name
            shutil.copytree(self.before, folder)
            try:
                found = self.judge(
                    folder,
                    run(self.command.words, folder, **({} if "memory" in fault else {"under": folder}),
                        **fault))
            except subprocess.TimeoutExpired:
                found = "hangs"
            return f"{self.command.name} {fault}: {found}" if found else ""


def begin(command, folder, memory=""):
    """Runs the command once without a fault."""
    before = prepare(command, folder / command.name)
    work = folder / "right" / command.name
    work.parent.mkdir(exist_ok=True)
    shutil.copytree(before, work)
    kind = {"memory": memory} if memory else {"under": work}
    done = run(command.words, work, count=folder / "count", **kind)
    assert done.returncode == 0, done.stderr.decode()
    right = content(work /
                    command.output, work) if command.output else done.stdout.replace(str(work).encode(), b"")
    shutil.rmtree(work)
    return Walk(command, before, right, int((folder / "count").read_text()))


def walk(names, errors, sticky, every, memory="", report=print):
    """Walks through every so-many-th call of each command with each error, once and from there on. Returns
    how many runs were made, and the findings."""
    runs, findings = 0, []
    place = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(prefix="leapmap-faults-",
                                     dir=place) as name, concurrent.futures.ThreadPoolExecutor(
                                         os.cpu_count()) as pool:
        for number, command in enumerate(COMMANDS[n] for n in names):
            each = begin(command, Path(name), memory)
            faults = [
                {
                    "number": i, "error": e, **({"sticky": 1} if s else {}),
                    **({"memory": memory} if memory else {})
                } for e in errors for s in sticky
                for i in range(number % every, each.calls, every)
                # Python tries again for ever, as it should
                if not (e == "EINTR" and s and command.name in ("explorer", "python"))
            ]
            found = [f for f in pool.map(each.fail, faults) if f]
            runs, findings = runs + len(faults), findings + found
            report(f"{command.name}: {each.calls} calls, {len(faults)} runs, {len(found)} findings",
                   flush=True)
            shutil.rmtree(Path(name) / command.name)
    return runs, findings


def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("--commands", nargs="+", default=list(COMMANDS), choices=COMMANDS, metavar="NAME",
                   help=f"of {', '.join(COMMANDS)}; default: all")
    p.add_argument("--errors", nargs="+", default=["EIO", "ENOSPC", "EINTR", "EDQUOT", "short", "zero"])
    p.add_argument("--every", type=int, default=1, metavar="N", help="every N-th call only")
    p.add_argument("--memory", default="", choices=("new", "malloc"),
                   help="allocations fail, of C++ or all, not calls that touch files")
    arguments = p.parse_args()
    errors = ["ENOMEM"] if arguments.memory else arguments.errors
    runs, findings = walk(arguments.commands, errors, (False, True), arguments.every, arguments.memory)
    print("\n".join(findings))
    print(f"{runs} runs, {len(findings)} findings")
    sys.exit(1 if findings else 0)


if __name__ == "__main__":
    main()
