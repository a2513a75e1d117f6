#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Plants an error of a thousandth in each formula of src/physics, one at a time, and asks the referee to find
it.

The solvers are compiled with the error and judged against src/referee, which is of the paper's equations (7)
to (9) alone and includes nothing of src/physics: that is looked at first. An error that is not found, or a
right solver that is found wrong, ends this with status 1. Needs a built libleapmap.a in LEAPMAP_BUILD.

--by-proof: instead of the referee ten designs are the judge, and what the program there, which has no error,
proves of them; only of errors in the formulas without slip."""
import argparse
import concurrent.futures
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = [
    "src/" + name + ".cpp"
    for name in ("noslip/clock", "noslip/exact", "noslip/find", "noslip/halved_time", "noslip/leg",
                 "noslip/prepare", "noslip/rolling_time", "noslip/take_off", "integrate/rolling_integration",
                 "hoop/three_coordinates", "friction/rolling_leg", "friction/sliding_leg",
                 "friction/sliding_panel", "friction/coulomb", "friction/coulomb_integration")
] + ["tests/mutation/judge.cpp"]
LIBRARIES = ["-lgsl", "-lgslcblas", "-lfmt", "-lhdf5_serial", "-lhdf5_serial_hl", "-ldeflate", "-lz",
             "-ludunits2", "-lpugixml", "-lzip", "-lnlopt", "-lflint-arb", "-lflint", "-ltomlplusplus"]
OFF = "T(1.001)"

# What is planted: file, what is there, what takes its place. Each text must stand there exactly once.
MUTATIONS = {
    "mass of the bare hoop": ("parameters", "T(1) / (T(1) + beta)", f"{OFF} / (T(1) + beta)"),
    "rho": ("parameters", ".rho = alpha * lambda", f".rho = {OFF} * alpha * lambda"),
    "1 - rho": ("parameters", ".clearance = hub + alpha * gap", f".clearance = {OFF} * (hub + alpha * gap)"),
    "Ic": ("parameters", ".Ic = kappa * hub", f".Ic = {OFF} * kappa * hub"),
    "least J": ("parameters", ".J_min = (kappa + T(1))", ".J_min = (kappa + T(1.001))"),
    "J": ("rolling", "return hoop.J_min + T(2) * hoop.rho", "return hoop.J_min + T(2.002) * hoop.rho"),
    "sin(theta + phi)": ("rolling", "hoop.sin_slope * phi.cos + hoop.cos_slope * phi.sin",
                         f"hoop.sin_slope * phi.cos + {OFF} * hoop.cos_slope * phi.sin"),
    "cos(theta + phi)": ("rolling", "hoop.cos_slope * phi.cos - hoop.sin_slope * phi.sin",
                         f"hoop.cos_slope * phi.cos - {OFF} * hoop.sin_slope * phi.sin"),
    "phi'' rolling (10)": ("rolling", "(hoop.thrust - hoop.rho * (sin_from",
                           f"({OFF} * hoop.thrust - hoop.rho * (sin_from"),
    "N rolling (11)": ("rolling", "return hoop.cos_slope + hoop.rho * (phi.sin * acceleration",
                       f"return hoop.cos_slope + hoop.rho * ({OFF} * phi.sin * acceleration"),
    "F rolling (12)": ("rolling", "+ hoop.rho * phi.sin * spin * spin - hoop.sin_slope",
                       f"+ {OFF} * hoop.rho * phi.sin * spin * spin - hoop.sin_slope"),
    "w^2 by angle": ("rolling_by_angle", "T(2) * (roll.push * x +", "T(2.002) * (roll.push * x +"),
    "level of energy": ("rolling_by_angle", "released - T(2) * (release *",
                        "released - T(2.002) * (release *"),
    "energy's slope": ("rolling_by_angle", "return hoop.thrust - hoop.rho * sin_from",
                       f"return hoop.thrust - {OFF} * hoop.rho * sin_from"),
    "G, rest": ("rolling_by_angle", "h.cos_slope * (h.Ic + q * q)", f"h.cos_slope * ({OFF} * h.Ic + q * q)"),
    "G, energy": ("rolling_by_angle", ".K = h.J_min * c - h.rho", f".K = {OFF} * h.J_min * c - h.rho"),
    "stick, F": ("stick", "const T pull = t.q * push - h.sin_slope * t.J",
                 f"const T pull = t.q * push - {OFF} * h.sin_slope * t.J"),
    "thrust": ("parameters", ".thrust = direction.sin + tau", f".thrust = direction.sin + {OFF} * tau"),
    "G, motor": ("rolling_by_angle", "h.rho * s * (h.sin_slope * q + h.drive)",
                 f"h.rho * s * (h.sin_slope * q + {OFF} * h.drive)"),
    "slide, motor": ("sliding", "at.turn * n0 + hoop.drive", f"at.turn * n0 + {OFF} * hoop.drive"),
    "seen from behind": ("parameters", "seen.drive = way * hoop.drive",
                         f"seen.drive = {OFF} * way * hoop.drive"),
    "slide, lever": ("sliding", "return hoop.rho * phi.sin - friction",
                     f"return {OFF} * hoop.rho * phi.sin - friction"),
    "slide, pivot": ("sliding", "pivot = hoop.Ic + hoop.rho", f"pivot = {OFF} * hoop.Ic + hoop.rho"),
    "slide, N": ("sliding", "phi, friction) * inverse, hoop.Ic * inverse",
                 f"phi, friction) * inverse, {OFF} * hoop.Ic * inverse"),
    "slide, n0": ("sliding", "return hoop.cos_slope + hoop.rho * (phi.cos",
                  f"return hoop.cos_slope + {OFF} * hoop.rho * (phi.cos"),
    "slide, F": ("sliding", "F = -friction * N", f"F = -{OFF} * friction * N"),
    "slide, v'": ("sliding", "F + hoop.sin_slope - arm * angular",
                  f"F + {OFF} * hoop.sin_slope - arm * angular"),
    "landing, Wtt": ("landing", "W{S(1) + arm * arm", "W{S(1.001) + arm * arm"),
    "landing, Wtn": ("landing", "hoop.Ic, arm * lever / hoop.Ic",
                     "hoop.Ic, S(1.001) * arm * lever / hoop.Ic"),
    "landing, Wnn": ("landing", "S(1) + lever * lever", "S(1.001) + lever * lever"),
    "landing, friction": ("landing", "-mu * sign(", "S(-1.001) * mu * sign("),
    "landing, restitution": ("landing", "(S(1) + restitution)", "(S(1.001) + restitution)"),
    "landing, spin": ("landing", "before.spin - (arm * end.impulse.friction",
                      "before.spin - (S(1.001) * arm * end.impulse.friction"),
    "flight, y": ("flight", "c * turned.versine - T(0.5) * toss.gravity * psi * psi",
                  "c * turned.versine - T(0.5005) * toss.gravity * psi * psi"),
    "flight, y'": (
        "flight",
        "c * turned.sin - toss.gravity * psi,\n          s * turned.sin - c * turned.cos - toss.gravity, s * "
        "turned.cos + c * turned.sin};",
        f"c * turned.sin - {OFF} * toss.gravity * psi,\n          s * turned.sin - c * turned.cos - "
        "toss.gravity, s * turned.cos + c * turned.sin};"
    ),
    "flight, gravity": ("flight", "toss.gravity = hoop.cos_slope / (hoop.rho",
                        f"toss.gravity = {OFF} * hoop.cos_slope / (hoop.rho"),
    "flight, rebound's y": ("flight", "t * (normal_velocity - T(0.5) * hoop.cos_slope * t)",
                            "t * (normal_velocity - T(0.5005) * hoop.cos_slope * t)"),
    "flight, y' at landing": ("flight", "normal_velocity - hoop.cos_slope * t +",
                              f"normal_velocity - {OFF} * hoop.cos_slope * t +"),
    "flight, motor": ("flight", "rate = rate + hoop.aloft * t", f"rate = rate + {OFF} * hoop.aloft * t"),
    "flight, travel": ("flight", "hoop.sin_slope * t * t * T(0.5)", "hoop.sin_slope * t * t * T(0.5005)"),
    "flight, x' at landing": ("flight", "slip + spin + hoop.sin_slope * t",
                              f"slip + spin + {OFF} * hoop.sin_slope * t"),
    "near Painleve's edge, pivot": ("painleve", "rho * (T(S(2)) * m *", "rho * (T(S(2.002)) * m *"),
    "landing, speed": ("../trajectory/jump_measures", "return {range, -before.normal,",
                       f"return {{range, -{OFF} * before.normal,"),
    "landing, held impulse": ("landing", "hoop.rho * phi.sin * gained - before.normal",
                              f"{OFF} * hoop.rho * phi.sin * gained - before.normal"),
    "radius and gravity": ("../leapmap/scene", "std::sqrt(scene.radius / scene.gravity)",
                           "1.001 * std::sqrt(scene.radius / scene.gravity)"),
}


# Those that change height or time of a jump without slip. "flight, y'" does not, as the apex is found again
# by y itself, nor "seen from behind", as blocks of the solver know the torque by the thrust.
WITHOUT_SLIP = [
    "mass of the bare hoop", "rho", "1 - rho", "Ic", "least J", "J", "sin(theta + phi)", "cos(theta + phi)",
    "w^2 by angle", "level of energy", "energy's slope", "G, rest", "G, energy", "thrust", "G, motor",
    "flight, y", "flight, gravity", "flight, motor", "radius and gravity"
]
STATUSES = ["not_computed", "jumped", "no_jump", "stalled", "airborne_at_release"]


def proved_designs(folder):
    """A file of ten designs with what is proved of them: passive, driven, turning and going uphill."""
    program = pathlib.Path(os.environ.get("LEAPMAP_BUILD", ROOT / "build/release")) / "leapmap"
    draw, lines = random.Random(3), []
    while len(lines) < 10:
        n = len(lines)
        design = {
            "slope": draw.uniform(0.2, 0.7), "mass_ratio": draw.uniform(1, 10), "offset_ratio":
                draw.uniform(0.5, 1), "inertia_factor": draw.uniform(0.5, 1), "release_angle":
                    draw.uniform(2, 4.2), "release_spin": draw.uniform(-1, 1) if n % 2 else 0.0,
            "drive_torque": draw.uniform(-0.1, 0.3) if n % 3 else 0.0, "resisting_torque": 0.0
        }
        if n == 9:  # uphill by its motor
            design |= {"slope": 0.05, "drive_torque": -0.6, "release_angle": 3.0, "release_spin": 0.0}
        flags = [w for name, v in design.items() for w in (f"--{name.replace('_', '-')}", repr(v))]
        told = json.loads(subprocess.run([program, "hop", *flags, "--prove", "--json"], check=True,
                                         capture_output=True, text=True).stdout)
        proof = told["proof"]
        if not proof["proved"] or proof["status"] != "jumped":
            continue
        flag = 0 if proof["lift_offs"] == 1 else 1
        lines.append(" ".join(map(repr, [*design.values(), STATUSES.index("jumped"), flag, proof["lift_offs"],
                                         *proof["jump_height"], *proof["jump_time"]])))
    path = pathlib.Path(folder) / "proved"
    path.write_text("\n".join(lines) + "\n")
    return path


def stands_alone():
    """Whether the referee includes nothing of src/physics."""
    for source in sorted((ROOT / "src/referee").glob("*.cpp")):
        headers = subprocess.run(
            ["g++", "-std=c++20", "-MM", "-isystem", "/usr/include/eigen3", "-I", ROOT / "src", source],
            check=True, capture_output=True, text=True).stdout
        if shared := re.findall(r"\S*src/(?:physics|trajectory|rolling|coulomb|model)/\S*", headers):
            print(f"{source.name} includes {shared}")
            return False
    return True


def header_of(sources, file):
    return (sources / "hoop" / f"{file}.hpp").resolve()


def judged(name, folder, library, proofs):
    """The judge's words on a library with that error planted; empty: it finds nothing."""
    include = folder / "src"
    shutil.copytree(ROOT / "src", include)
    if name:
        file, old, new = MUTATIONS[name]
        header = header_of(include, file)
        text = header.read_text()
        if text.count(old) != 1:
            return f"BROKEN: \"{old}\" stands {text.count(old)} times in {file}.hpp"
        header.write_text(text.replace(old, new))
    objects = []
    for source in SOURCES:
        at = folder / source if source.startswith("src") else ROOT / source
        objects.append(folder / (at.stem + ".o"))
        subprocess.run([
            "g++", "-std=c++20", "-O1", "-march=native", "-fopenmp", "-w", "-isystem", "/usr/include/eigen3",
            "-DLEAPMAP_KERNELS=kernels", "-DLEAPMAP_SCALARS", "-I", include, "-c", at, "-o", objects[-1]
        ], check=True)
    subprocess.run(["g++", "-fopenmp", *objects, library, *LIBRARIES, "-o", folder / "judge"], check=True)
    try:
        done = subprocess.run([folder / "judge", *proofs], capture_output=True, text=True, timeout=120)
    except subprocess.TimeoutExpired:
        return "BROKEN: the judge never ends"
    if done.returncode not in (0, 1) or (done.returncode == 1) != bool(done.stdout):
        return f"BROKEN: the judge ends with status {done.returncode}"
    return done.stdout.strip()


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help="errors to plant; default: all")
    parser.add_argument("--by-proof", action="store_true", help="judge ten designs by what is proved of them")
    arguments = parser.parse_args()
    asked = arguments.names
    if unknown := [name for name in asked if name not in MUTATIONS]:
        parser.error(f"{unknown[0]} is unknown; allowed: {', '.join(MUTATIONS)}")
    library = pathlib.Path(os.environ.get("LEAPMAP_BUILD", ROOT / "build/release")) / "libleapmap.a"
    names = [None, *(asked or (WITHOUT_SLIP if arguments.by_proof else MUTATIONS))]
    if not stands_alone():
        sys.exit(1)
    missed = 0
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(
            os.cpu_count()) as pool:
        places = [pathlib.Path(folder) / str(i) for i in range(len(names))]
        proofs = [proved_designs(folder)] if arguments.by_proof else []
        for name, words in zip(names, pool.map(judged, names, places, [library] * len(names),
                                               [proofs] * len(names))):
            right = not words if name is None else words != "" and not words.startswith("BROKEN")
            missed += not right
            print(
                f"{'ok' if right else 'MISSED' if name else 'WRONG':7} {name or 'the solver as it is'}: "
                f"{words or 'agrees'}",
                flush=True)
    print(f"{len(names) - names.count(None)} errors planted, {missed} findings")
    sys.exit(missed > 0)


if __name__ == "__main__":
    main()
