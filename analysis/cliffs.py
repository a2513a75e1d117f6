# SPDX-License-Identifier: GPL-3.0-or-later
"""Discontinuities that `leapmap boundaries` found, over a map's planes: as curves, and as edges that nothing
is drawn across.

    leapmap boundaries MAP.h5 -o MAP.cliffs.h5    # charts of MAP.h5 then draw them
"""
import os

import numpy as np
from matplotlib import patheffects

import looks
import planes
import style
from read_map import NotAMap, read_map, read_table
from style import plt

# In the order of their numbers. Kind: the line's dashes and colour, and the words of the legend.
KINDS = {
    "threshold": ("-", style.EDGE, "discontinuity: a lift-off crosses the jump threshold"),
    "fold": ((0, (4, 2)), style.EDGE, "discontinuity: a lift-off appears (fold)"),
    "runway": (":", style.EDGE, "discontinuity: a lift-off crosses the rolling limit"),
    "turn": ("-.", style.EDGE, "discontinuity: the hoop barely reverses"),
    "release": ((0, (1, 1)), "#7570b3", "discontinuity: airborne from the release"),
    "phase": ((0, (3, 1, 1, 1)), style.EDGE, "discontinuity: a phase appears or vanishes"),
    "painleve": ("-", "#7570b3", "discontinuity: Painlevé's paradox"),
    "unresolved": (":", "#7570b3", "discontinuity: the method fails"),
}
MOST_PIXELS = 900  # along a panel's side


def add_options(parser):
    parser.add_argument(
        "--cliffs", metavar="FILE", help="what leapmap boundaries found of the map (default: MAP.cliffs.h5 "
        "beside MAP.h5, if it is there); 'none': draw cells, with stairs")


def run(doc, example, suffix, chart, units=False):
    """The main of a script whose chart(grid, curves) is one figure of a map over two axes. units: whether it
    draws quantities that --units converts."""
    p = style.parser(doc, f"a map over two axes or more, for example {example}", suffix)
    planes.add_options(p)
    add_options(p)
    if units:
        planes.add_units(p)
    arguments = p.parse_args()
    m = planes.in_units(read_map(arguments.source), arguments.units if units else "")
    grid = planes.Planes(m, arguments.x, arguments.y, arguments.at)
    style.save(chart(grid, read_cliffs(m, arguments.cliffs)), arguments.output)


def beside(path):
    """The cliffs of MAP.h5 are in MAP.cliffs.h5."""
    return os.path.splitext(path.removesuffix(".part"))[0] + ".cliffs.h5"


def read_cliffs(m, asked):
    """The curves of a map, or None: {"kind": ..., axis: values, ...} each. Raises NotAMap for cliffs of
    another map."""
    path = asked or beside(m.path)
    if asked == "none" or (not asked and not os.path.exists(path)):
        return None
    table = read_table(path, "leapmap cliffs")
    of_other = (f"{path}: holds other designs than {m.path}; make it again: leapmap boundaries {m.path} -o "
                f"{path}")
    if not isinstance(table.attributes.get("spec"),
                      str) or _designs(table.attributes["spec"]) != _designs(m.attributes["spec"]):
        raise NotAMap(of_other)
    if "curve" not in table.fields:
        return []
    columns = {n: np.asarray(table.fields[f"curve_{n}"]) for n in m.dims}
    numbers, kinds = np.asarray(table.fields["curve"]), np.asarray(table.fields["curve_kind"])
    are_places = all(len(v) == len(numbers) and v.dtype.kind == "f" and np.isfinite(v).all()
                     for v in columns.values())
    if not are_places or not set(kinds.tolist()) <= set(range(len(KINDS))):
        raise NotAMap(f"{path}: is damaged: its curves are no places along the axes")
    ends = np.flatnonzero(np.diff(numbers)) + 1
    return [{"kind": list(KINDS)[int(kinds[part[0]])], **{n: v[part] for n, v in columns.items()}}
            for part in np.split(np.arange(len(numbers)), ends) if len(part)]


def _designs(spec):
    """The lines of a resolved spec that say which designs, in which scene."""
    text = spec.split("[numerics]")[0]
    return [line for line in text.splitlines() if line.strip()]


class Panel:
    """One panel of planes.Planes with its curves; without any it is the map's cells as they are.

    Between designs values are linear, within the curves that go through a cell: a pixel takes part in what
    those corners of its cell have that no curve hides from it."""

    def __init__(self, grid, panel, curves):
        self.grid, self.curves = grid, []
        where = grid.where(panel) | {n: grid.map.dims[n][i] for n, i in grid.index.items()}
        for curve in curves or []:
            if all(np.allclose(curve[n], value, rtol=1e-12, atol=0) for n, value in where.items()):
                self.curves.append((curve["kind"], *(self._places(n, curve[n]) for n in (grid.x, grid.y))))
        # Cliffs are looked for in the planes of two axes: in others cells stay as they are.
        aside = [n for n in grid.map.dims if n not in (grid.x, grid.y)]
        self.crisp = curves is not None and all(np.ptp(curve[n]) == 0 for curve in curves for n in aside)
        shape = [len(grid.values(n)) for n in (grid.y, grid.x)]
        most = MOST_PIXELS if len(grid.panels) == 1 else MOST_PIXELS // 2
        self.fine = max(1, min(8, most // max(shape))) if self.crisp else 1
        self._weigh(shape)

    def _places(self, name, values):
        """Along an axis in cells, from 0 at its first design; as drawn, by ratio on a logarithmic axis."""
        drawn, at = self.grid.values(name), looks.as_shown(name, values)
        if looks.is_log(drawn):
            drawn, at = np.log(drawn), np.log(at)
        return np.interp(at, drawn, np.arange(len(drawn)))

    def _weigh(self, shape):
        """Of each pixel the four corners of its cell, as rows and columns, and their shares."""
        n = self.fine
        v, u = ((np.arange(size * n) + 0.5) / n - 0.5 for size in shape)
        rows, columns = (np.clip(np.floor(w), 0, max(size - 2, 0)).astype(int)
                         for w, size in zip((v, u), shape))
        self.row, self.column = rows[:, None], columns[None, :]
        fv, fu = np.clip(v - rows, 0, 1)[:, None], np.clip(u - columns, 0, 1)[None, :]
        if n == 1:
            fv, fu = np.round(fv), np.round(fu)
        self.shares = np.stack([(1 - fv) * (1 - fu), (1 - fv) * fu, fv * (1 - fu), fv * fu])
        self.torn = np.zeros(self.shares.shape[1:], bool)  # pixels that a curve passes near
        hidden = {}
        for _, x, y in self.curves:
            for a in zip(x[:-1], y[:-1], x[1:], y[1:]):
                hidden.setdefault((int((a[1] + a[3]) / 2), int((a[0] + a[2]) / 2)), []).append(a)
        for (row, column), segments in hidden.items():
            here = np.ix_(np.flatnonzero(rows == row), np.flatnonzero(columns == column))
            self._hide(here, row, column, v, u, segments)
        total = self.shares.sum(0)
        with np.errstate(invalid="ignore", divide="ignore"):
            self.shares = np.where(total > 0, self.shares / total, 0.0)

    def _hide(self, here, row, column, v, u, segments):
        pu, pv = np.meshgrid(u[here[1].ravel()], v[here[0].ravel()])
        for k, (dv, du) in enumerate(((0, 0), (0, 1), (1, 0), (1, 1))):
            seen = np.ones(pu.shape, bool)
            for segment in segments:
                seen &= ~_crosses(pu, pv, column + du, row + dv, *segment)
            # of a corner on the cell's other side, if it is all there is
            share = np.maximum(self.shares[k][here], 1e-9)
            self.shares[k][here] = np.where(seen, share, 0.0)
        for x1, y1, x2, y2 in segments:
            length2 = max((x2 - x1) ** 2 + (y2 - y1) ** 2, 1e-300)
            t = np.clip(((pu - x1) * (x2 - x1) + (pv - y1) * (y2 - y1)) / length2, 0, 1)
            near = np.hypot(pu - x1 - t * (x2 - x1), pv - y1 - t * (y2 - y1)) < 0.8 / self.fine
            self.torn[here] |= near

    def _corners(self, plane):
        below, right = np.minimum(self.row + 1, plane.shape[0] - 1), np.minimum(
            self.column + 1, plane.shape[1] - 1)
        return np.stack([
            plane[self.row, self.column], plane[self.row, right], plane[below, self.column], plane[below,
                                                                                                   right]
        ])

    def field(self, plane):
        """A quantity pixel by pixel; NaN where the design most near has none."""
        corners = self._corners(plane)
        present = np.where(np.isfinite(corners), self.shares, 0.0)
        total = present.sum(0)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean = np.where(total > 0, (np.nan_to_num(corners) * present).sum(0) / total, np.nan)
        return np.where(np.isfinite(self.code(plane)), mean, np.nan)

    def code(self, plane):
        """What each pixel shares with the most near of the designs that it sees."""
        corners = self._corners(plane)
        return np.take_along_axis(corners, self.shares.argmax(0)[None], 0)[0]

    def edges(self, name):
        """Where the pixels end along an axis."""
        edges = self.grid.edges(name)
        at = np.log(edges) if looks.is_log(self.grid.values(name)) else edges
        finer = np.interp(np.arange((len(at) - 1) * self.fine + 1) / self.fine, np.arange(len(at)), at)
        return np.exp(finer) if looks.is_log(self.grid.values(name)) else finer

    def centres(self, name):
        edges = self.edges(name)
        return np.sqrt(edges[1:] *
                       edges[:-1]) if looks.is_log(self.grid.values(name)) else (edges[1:] + edges[:-1]) / 2

    def draw(self, axis, halo="white"):
        """The curves, each kind in its dashes. Returns the kinds."""
        for kind, x, y in self.curves:
            dashes, colour, _ = KINDS[kind]
            places = [
                np.interp(at, np.arange(len(self.grid.values(n))),
                          np.log(v) if looks.is_log(v) else v)
                for n, at, v in ((n, at, self.grid.values(n))
                                 for n, at in ((self.grid.x, x), (self.grid.y, y)))
            ]
            places = [
                np.exp(at) if looks.is_log(self.grid.values(n)) else at
                for n, at in zip((self.grid.x, self.grid.y), places)
            ]
            axis.plot(*places, linestyle=dashes, color=colour, linewidth=1.0,
                      path_effects=[patheffects.withStroke(linewidth=1.8, foreground=halo, alpha=0.6)])
        return {kind for kind, _, _ in self.curves}


def _crosses(pu, pv, qu, qv, x1, y1, x2, y2):
    """Whether the way from each p to q crosses the segment."""
    side = lambda ax, ay, bx, by, cx, cy: (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (side(x1, y1, x2, y2, pu, pv) * side(x1, y1, x2, y2, qu, qv) <
            0) & (side(pu, pv, qu, qv, x1, y1) * side(pu, pv, qu, qv, x2, y2) <= 0)


def handles(kinds):
    """The legend's lines, in the order of KINDS."""
    return [plt.Line2D([], [], linestyle=dashes, color=colour, linewidth=1.0, label=words)
            for kind, (dashes, colour, words) in KINDS.items() if kind in kinds]
