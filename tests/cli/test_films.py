# SPDX-License-Identifier: GPL-3.0-or-later
"""Films in the forms that laboratories have: read without editing, and fitted to what they were made of."""
import json
import math
import zipfile

import h5py
import numpy as np
import pytest
from support.program import leapmap

RADIUS, OFFSET, FPS, RELEASE = 0.06, 0.8, 240.0, 0.35
HOOP = {
    "slope": 0.35, "mass_ratio": 1.6, "offset_ratio": OFFSET, "release_angle": math.radians(196.0),
    "mu_static": 0.55
}
SCALE, TILT = 2400.0, math.radians(3.0)  # pixels a metre; of the camera against the horizontal
SPEC = f"""[scene]
friction = "coulomb"
radius = {RADIUS}
[design]
slope = {HOOP['slope']}
mass_ratio = {HOOP['mass_ratio']}
offset_ratio = {OFFSET}
"""


@pytest.fixture(scope="module")
def motion(tmp_path_factory):
    """t, x, y of the centre over the plane, phi."""
    path = tmp_path_factory.mktemp("film") / "t.h5"
    flags = [word for key, value in HOOP.items() for word in (f"--{key.replace('_', '-')}", repr(value))]
    done = leapmap("hop", "--friction", "coulomb", *flags, "--set", f"radius={RADIUS}", "--trace", path,
                   "--trace-interval", "1e-4")
    assert done.returncode == 0, done.stderr
    with h5py.File(path) as trace:
        t, first = np.unique(trace["t"][()], return_index=True)
        return {"t": t} | {name: trace[name][()][first] for name in ("x", "y", "phi")}


class Film:
    """Marks on weight and centre, with 0.4 mm of noise, and six frames in which the weight was not marked."""

    def __init__(self, motion, seed):
        self.random = np.random.default_rng(seed)
        self.t = np.arange(int((motion["t"][-1] + RELEASE - 0.02) * FPS)) / FPS
        x, y, phi = (np.interp(self.t - RELEASE, motion["t"], motion[name]) for name in ("x", "y", "phi"))
        y = y + RADIUS
        self.weight = self.noisy(np.c_[x - OFFSET * RADIUS * np.sin(phi), y - OFFSET * RADIUS * np.cos(phi)])
        self.centre = self.noisy(np.c_[x, y])
        self.gone = self.random.choice(np.arange(5, len(self.t) - 5), 6, replace=False)

    def noisy(self, positions):
        return positions + self.random.normal(0, 4e-4, positions.shape)

    def seen(self, positions):
        seen = positions.copy()
        seen[self.gone] = np.nan
        return seen


def in_pixels(positions):
    """With y downwards, and x horizontal but for the camera's tilt."""
    a = HOOP["slope"] + TILT
    along, across = positions.T
    return np.c_[200 + SCALE * (along * math.cos(a) + across * math.sin(a)),
                 400 - SCALE * (across * math.cos(a) - along * math.sin(a))]


def cells(row, form):
    return ["" if math.isnan(value) else format(value, form) for value in row]


def tracker_text(film, folder):
    lines = ["rim\t\t\tcentre\t\t\t", "t\tx\ty\tt\tx\ty\t"]
    for t, p, c in zip(film.t, film.seen(film.weight), film.centre):
        lines.append("\t".join([f"{t:.4E}", *cells(p, ".4E"), f"{t:.4E}", *cells(c, ".4E")]) + "\t")
    (folder / "two.txt").write_text("\n".join(lines) + "\n")
    return ["two.txt"]


def tracker_files(film, folder):
    for name, positions in (("weight", film.weight), ("centre", film.centre)):
        lines = [f"mass_{name[0].upper()},,,", "t,x,y,"]
        lines += [f"{t:.5f},{x:.6f},{y:.6f}," for t, (x, y) in zip(film.t, film.seen(positions)) if x == x]
        (folder / f"{name}.csv").write_text("\n".join(lines) + "\n")
    return ["weight.csv", "centre.csv"]


def kinovea(film, folder):
    lines = ["Time;Weight/X;Weight/Y;Centre/X;Centre/Y"]
    for t, p, c in zip(film.t, film.weight, film.centre):
        lines.append(";".join([f"{1000 * t:.0f}", *(f"{1000 * v:.2f}" for v in (*p, *c))]).replace(".", ","))
    (folder / "kinovea.csv").write_bytes(("\ufeff" + "\r\n".join(lines) + "\r\n").encode())
    return ["kinovea.csv"]


def dltdv(film, folder):
    lines = ["pt1_cam1_X,pt1_cam1_Y,pt2_cam1_X,pt2_cam1_Y"]
    for p, c in zip(film.seen(in_pixels(film.weight)), in_pixels(film.centre)):
        lines.append(",".join("NaN" if math.isnan(v) else f"{v:.3f}" for v in (*p, *c)))
    (folder / "xypts.csv").write_text("\n".join(lines) + "\n")
    return ["xypts.csv", "--fps", str(FPS)]


def deeplabcut(film, folder):
    lines = [
        "scorer" + ",net" * 6, "bodyparts" + ",weight" * 3 + ",centre" * 3, "coords" + ",x,y,likelihood" * 2
    ]
    for i, (p, c) in enumerate(zip(in_pixels(film.weight), in_pixels(film.centre))):
        sure = 0.05 if i in film.gone else 0.99
        lines.append(f"{i},{p[0]:.3f},{p[1]:.3f},{sure},{c[0]:.3f},{c[1]:.3f},0.98")
    (folder / "net.csv").write_text("\n".join(lines) + "\n")
    return ["net.csv", "--fps", str(FPS)]


def of_class(name, content):
    return f'<object class="org.opensourcephysics.cabrillo.{name}">{content}</object>'


def of_property(name, value, kind="double"):
    return f'<property name="{name}" type="{kind}">{value}</property>'


def project(film):
    axes = of_class("media.ImageCoordSystem$FrameData", "".join(
        of_property(name, value) for name, value in (("xorigin", 200.0), ("yorigin", 400.0), ("angle", 0.0),
                                                     ("xscale", SCALE), ("yscale", SCALE))))
    points = "".join(
        of_property(f"[{i}]", of_class("tracker.PointMass$FrameData",
                                       of_property("x", float(x)) + of_property("y", float(y))),
                    "object") for i, (x, y) in enumerate(in_pixels(film.weight)) if i not in film.gone)
    mass = of_property("name", "weight", "string") + of_property("framedata", points, "array")
    clock = of_property("delta_t", f"{1000 / FPS:.6f}")
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + of_class("tracker.TrackerPanel", "".join([
        of_property("clipcontrol", of_class("media.StepperClipControl", clock), "object"),
        of_property("coords", of_class("media.ImageCoordSystem", of_property(
            "framedata", of_property("[0]", axes, "object"), "array")), "object"),
        of_property("tracks", of_property("item", of_class("tracker.PointMass", mass), "object"), "list")
    ]))


def one_marker_trk(film, folder):
    (folder / "one.trk").write_text(project(film))
    return ["one.trk"]


def one_marker_trz(film, folder):
    with zipfile.ZipFile(folder / "one.trz", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("html/info.html", "<html></html>")
        archive.writestr("one.trk", project(film))
    return ["one.trz"]


FORMS = [
    tracker_text, tracker_files, kinovea, dltdv, deeplabcut, one_marker_trk, one_marker_trz
]
TRUTH = {
    "release_angle": HOOP["release_angle"], "mu_static": HOOP["mu_static"], "time_offset": RELEASE,
    "scale": 1 / SCALE, "tilt": TILT
}


def fitted(form, motion, seed, folder, *more):
    (folder / "hoop.toml").write_text(SPEC)
    words = form(Film(motion, seed), folder)
    words = [folder / word if word.endswith((".csv", ".txt", ".trk", ".trz")) else word for word in words]
    done = leapmap("fit", *words, folder / "hoop.toml", "--json", "--model", "coulomb", *more)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def deviations(told):
    """Of the parameters from the truth, over their errors."""
    found = told["models"][0]["parameters"]
    return [(found[name]["value"] - TRUTH[name]) / found[name]["error"] for name in found]


@pytest.mark.parametrize("form", FORMS)
def test_a_film_is_read_without_editing_and_its_truth_is_found(form, motion, tmp_path):
    told = fitted(form, motion, 1, tmp_path)
    found = told["models"][0]["parameters"]
    assert {"release_angle", "mu_static", "time_offset"} <= set(found)
    assert ("scale" in found) == (form in (dltdv, deeplabcut))
    assert ("tilt" in found) == (form not in (tracker_text, tracker_files, kinovea))
    assert all(one["identified"] and not one["at_bound"] for one in found.values())
    # Two or three tens of parameters in all films: one in a thousand is beyond 3.5 errors.
    assert max(map(abs, deviations(told))) < 3.5, found
    assert told["models"][0]["explains"]


@pytest.mark.slow
@pytest.mark.parametrize("form", FORMS[:-1])
def test_errors_of_films_are_honest(form, motion, tmp_path):
    off = np.concatenate([deviations(fitted(form, motion, seed, tmp_path)) for seed in range(2, 42)])
    assert (np.abs(off) <= 3.0).mean() >= 0.95
    # Of 120 to 200 numbers, correlated within a film: 95 % and three deviations of that fraction.
    assert 0.88 <= (np.abs(off) <= 1.96).mean() <= 1.0


def test_a_dry_run_reports_how_columns_were_read(motion, tmp_path):
    (tmp_path / "hoop.toml").write_text(SPEC)
    dltdv(Film(motion, 1), tmp_path)
    done = leapmap("fit", tmp_path / "xypts.csv", tmp_path / "hoop.toml", "--fps", FPS, "--dry-run")
    assert done.returncode == 0, done.stderr
    for words in ("frames at 240 per second", "'pt1_cam1' x, y from columns 1, 2", "6 frames without one",
                  "'pt1_cam1' is the mass", "'pt2_cam1' is the hoop's centre", "y is downwards",
                  "scale is free, about 0.41", "axes: horizontal", "it has left its place at t = 0.3"):
        assert words in done.stdout, (words, done.stdout)
    assert done.stdout.count("\n") < 30, "five rows of each track"


def wheel(folder, seed=1, noise=1.0):
    """A wheel on a ramp with a bearing that resists, its angle by an encoder with a zero of its own."""
    g, ring, hub, weight, at, gyration, radius = 9.81, 11.7, 0.7, 3.4, 0.178, 0.203, 0.235
    slope, torque, zero = math.radians(5.3), 0.85, 0.4
    whole = ring + hub + weight

    def rates(phi, spin):
        inertia = (ring * gyration**2 + (ring + hub) * radius**2 + weight *
                   (radius**2 + at**2 - 2 * radius * at * math.cos(phi)))
        push = whole * g * radius * math.sin(slope) - weight * g * at * math.sin(slope + phi) - torque
        return (push - weight * radius * at * math.sin(phi) * spin**2) / inertia

    phi, spin, step, rows = math.pi + zero, 0.0, 1e-3, []
    for i in range(6000):
        if i % 100 == 0:
            rows.append((i * step, phi - math.pi - zero, spin))
        middle = spin + step / 2 * rates(phi, spin)
        phi, spin = phi + step * middle, spin + step * rates(phi + step / 2 * spin, middle)
    random = np.random.default_rng(seed)
    lines = ["%Time (s)\tTheta (rad)\tOmega (rad/s)", "\t%ramp 2, wheel 1"]
    for t, a, w in rows:
        quantum = 0.0126 * round((a + noise * random.normal(0, 4e-3)) / 0.0126)
        lines.append(f"{t:.4f}\t{quantum:.4f}\t{w + noise * random.normal(0, 0.04):.4f}")
    (folder / "encoder.txt").write_bytes(("\r\n".join(lines) + "\r\n").encode())
    (folder / "wheel.toml").write_text(f"""[hoop]
diameter = {2 * radius}
mass = {ring + hub}
inertia = {ring * gyration**2}
[[hoop.weight]]
name = "lead"
mass = {weight}
at = {at}
[design]
slope = {slope}
""")
    scale = whole * g * radius
    return {
        "angle_offset": math.pi + zero, "release_angle": math.pi + zero, "resisting_torque": torque / scale,
        "slope": slope
    }


@pytest.mark.parametrize("noise", [1.0])
def test_the_wheel_of_an_encoder_shows_its_zero_and_its_resistance(noise, tmp_path):
    truth = wheel(tmp_path, noise=noise)
    done = leapmap("fit", tmp_path / "encoder.txt", tmp_path / "wheel.toml", "--model", "sticking", "--json",
                   "--free", "angle_offset,release_angle,resisting_torque")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)["models"][0]["parameters"]
    for name in ("angle_offset", "release_angle", "resisting_torque"):
        assert abs(found[name]["value"] - truth[name]) < 3.5 * found[name]["error"], (name, found[name])
    assert found["resisting_torque"]["error"] < 0.1 * truth["resisting_torque"]


def test_what_cannot_be_distinguished_is_reported_with_what_would_measure_it(tmp_path):
    wheel(tmp_path)
    done = leapmap("fit", tmp_path / "encoder.txt", tmp_path / "wheel.toml", "--model", "sticking", "--free",
                   "angle_offset,release_angle,resisting_torque,slope")
    assert done.returncode == 0, done.stderr
    assert "slope and resisting_torque cannot be distinguished" in done.stdout, done.stdout
    assert "a spirit level on the plane" in done.stdout


MARK = "t,a x,a y\n0,0,.041\n0.1,0,.041\n0.2,0,.041\n"


@pytest.mark.parametrize(("text", "flags", "words"), [
    ("t,x,y\n0,0,1\n0.2,0,1\n0.1,0,1\n", [], ["film.csv:4", "ascending times"]),
    ("t,x,y\n0,0,1\n", [], ["1 rows with numbers", "three or more"]),
    ("t,x,y\n0,NaN,NaN\n0.1,NaN,\n0.2,,\n", [], ["0 rows with numbers"]),
    ("t,a x,a y,b x,b y\n0,0,.5,0,0\n0.1,0,.5,0,0\n0.2,0,.5,0,0\n", [], ["another unit", "--scale 0.08"]),
    ("t,a x,a y,b x,b y\n0,0,1,,\n0.1,0,1,,\n0.2,0,1,,\n0.3,,,0,0\n0.4,,,0,0\n0.5,,,0,0\n", [],
     ["0 times in common"]),
    (MARK, ["--marker", "b: at=10 mm"], ["no track", "allowed: a"]),
    (MARK, ["--marker", "at=100 mm"], ["out of range"]),
    (MARK, ["--marker", "angle=3"], ["--marker", "no place"]),
    (MARK, ["--free", "zoom"], ["zoom", "time_offset"]),
    (MARK, ["--free", "angle_offset"], ["angle_offset", "no effect"]),
    (MARK, ["--fps", "100"], ["--fps", "no effect"]),
    ("t,phi\n0,3\n0.1,3\n0.2,3\n", ["--marker", "at=10 mm"], ["angles", "no effect"]),
    ("t,a x [mm],a y [mm]\n0,0,41\n0.1,5,41\n0.2,9,41\n", ["--scale", "0.001"], ["--scale", "have a unit"]),
    ("t,centre x,centre y\n0,0,41\n0.1,5,41\n0.2,9,41\n", [], ["centre alone", "--scale"]),
    ("t,a x\n0,1,2\n0.1,1,2\n0.2,1,2\n", [], ["2 names above 3 columns"]),
    ("frame,a x,a y\n0,0,1\n1,0,1\n2,0,1\n", [], ["frame numbers", "--fps"]),
    ("t,a x,a y,b x,b y,d x,d y\n0,0,0,0,0,0,0\n0.1,1,1,1,1,1,1\n0.2,2,1,1,1,1,1\n", [],
     ["tracks a, b, d", "--marker"]),
])
def test_a_bad_film_is_one_line(text, flags, words, tmp_path):
    (tmp_path / "film.csv").write_text(text)
    done = leapmap("fit", tmp_path / "film.csv", *flags)
    assert done.returncode == 2 and done.stderr.count("\n") == 1, done.stderr
    for word in words:
        assert word in done.stderr, done.stderr
    assert "allowed" in done.stderr
