# SPDX-License-Identifier: GPL-3.0-or-later
"""A map as planes over two of its axes, one for each panel."""
import math

import numpy as np

import looks
import style
from read_map import NotAMap
from style import plt

MOST_PANELS = 12
FIELDS = ("jump_height", "jump_time", "agility")  # drawn unless others are asked for


def add_options(parser):
    """The options of every chart over two axes."""
    parser.add_argument("-x", metavar="AXIS",
                        help="the axis drawn to the right (default: slope, or the map's first)")
    parser.add_argument("-y", metavar="AXIS",
                        help="the axis drawn upwards (default: mass_ratio, or the map's next)")
    add_at(parser)


def add_fields(parser):
    """--fields, for charts of quantities over a line; fields_of reads it."""
    parser.add_argument("--fields", default=",".join(FIELDS),
                        help=f"what to draw, of {', '.join(looks.LOOKS)} (default: %(default)s)")


def fields_of(arguments):
    fields = arguments.fields.split(",")
    unknown = [f for f in fields if f not in looks.LOOKS]
    if unknown:
        raise NotAMap(f"--fields {unknown[0]}: is unknown; allowed: {', '.join(looks.LOOKS)}")
    return fields


def add_units(parser):
    """--units, for charts of a map's quantities; in_units takes them."""
    parser.add_argument("--units", default="",
                        help="units of the quantities, with blanks between them, for example \"mm ms\" "
                        "(default: the map's own)")


def in_units(m, units):
    """The map with its quantities in these units."""
    try:
        if units:
            looks.use_units(m, units, style.leapmap_module()._core.units_in_own)
    except ValueError as error:
        raise NotAMap(f"{m.path}: {error}") from None
    return m


def field_label(field):
    """A quantity and its unit in two short lines, for an axis upwards."""
    return "\n[".join(looks.LOOKS[field].title.replace(": height over time from release to apex",
                                                       "").split(" ["))


def add_at(parser):
    parser.add_argument(
        "--at", metavar="AXIS=VALUE", action="append", default=[], help=
        "keep only the designs nearest to this value (angles in degrees, weights in g and mm); may be given "
        "again"
    )


def fixed_at(m, wanted, option="--at"):
    """{axis: index of the value nearest to the one asked for}; option: what asked for it, for messages."""
    found = {}
    for text in wanted:
        name, _, value = text.partition("=")
        if name not in m.dims:
            raise NotAMap(f"{m.path}: {option} {text}: has no axis {name}; allowed: {', '.join(m.dims)}")
        try:
            number = float(value.removesuffix("deg").removesuffix(looks.parameter(name)[2].strip() or "°"))
        except ValueError:
            raise NotAMap(f"{m.path}: {option} {text}: is not a number after the =") from None
        number = math.radians(number) if looks.is_angle(name) else number / looks.factor(name)
        values = m.dims[name]
        # half a cell, and labels' rounding
        slack = 0.5 * np.ptp(values) / max(1, len(values) - 1) + 1e-3 * np.abs(values).max()
        if not values.min() - slack <= number <= values.max() + slack:
            raise NotAMap(
                f"{m.path}: {option} {text}: lies beyond the map; allowed: {looks.shown(name, values.min())} "
                f"to {looks.shown(name, values.max())}"
            )
        found[name] = int(np.argmin(np.abs(values - number)))
    return found


class Planes:
    """A grid's panels over the axes x and y, each sorted; panels run over the other axes."""

    def __init__(self, m, x=None, y=None, at=()):
        self.map = m
        if "design" in m.dims or len(m.dims) < 2:
            raise NotAMap(
                f"{m.path}: has fewer than two axes; allowed: a map of a sweep over two axes, for example "
                "slope and mass_ratio; charts cut draws one axis"
            )
        self.index = fixed_at(m, at)
        free = [n for n in m.dims if n not in self.index]
        rest = lambda taken, wish: wish if wish in free and wish != taken else next(
            (n for n in free if n != taken), None)
        self.x = x or rest(y, "slope")
        self.y = y or rest(self.x, "mass_ratio")
        if len(free) < 2:
            raise NotAMap(
                f"{m.path}: --at fixes all axes but {free[0] if free else 'none'}; leave two free to draw "
                "over"
            )
        for name in (self.x, self.y):
            if name not in free:
                raise NotAMap(
                    f"{m.path}: has no axis {name} to draw; it has "
                    f"{', '.join(free) or 'none that --at does not fix'}"
                )
            if len(m.dims[name]) < 2:
                raise NotAMap(f"{m.path}: has one {name} only; such a chart wants at least two")
        if self.x == self.y:
            raise NotAMap(f"{m.path}: -x and -y are both {self.x}")
        self.others = [n for n in free if n not in (self.x, self.y)]
        self.panels = list(np.ndindex(*(len(m.dims[n]) for n in self.others)))
        if len(self.panels) > MOST_PANELS:
            raise NotAMap(f"{m.path}: {len(self.panels)} panels are too many; fix an axis, for example --at "
                          f"{self.others[0]}={looks.shown(self.others[0], m.dims[self.others[0]][0])}")
        self.order = {n: np.argsort(m.dims[n]) for n in (self.x, self.y)}

    def values(self, name):
        """An axis's values as drawn: sorted, angles in degrees."""
        return looks.as_shown(name, self.map.dims[name][self.order[name]])

    def edges(self, name):
        """Where an axis's cells end: halfway between its values as they are drawn."""
        return edges_of(self.values(name))

    def cut(self, array):
        """An array along all of the map's axes as one plane a panel, rows along y."""
        names = list(self.map.dims)
        for name in sorted(self.index, key=names.index, reverse=True):
            array = np.take(array, self.index[name], axis=names.index(name))
        names = [n for n in names if n not in self.index]
        array = np.moveaxis(array, [names.index(n) for n in (*self.others, self.y, self.x)],
                            range(array.ndim))
        return [array[p][np.ix_(self.order[self.y], self.order[self.x])] for p in self.panels]

    def where(self, panel):
        """{axis: value} of a panel."""
        return {n: self.map.dims[n][i] for n, i in zip(self.others, panel)}

    def told(self):
        """{status: a plane a panel} of where designs do not jump, and why."""
        m = self.map
        if "status" in m.fields:
            return {c: self.cut(m.code("status", c)) for c in looks.STATUSES}
        done = m.computed()
        some = next(iter(m.fields.values()))
        missing = np.isnan(some) if some.dtype.kind == "f" else np.zeros(some.shape, bool)
        nothing = np.zeros(some.shape, bool)
        return {
            c: self.cut(missing & done if c == "no_jump" else ~done if c == "not_computed" else nothing)
            for c in looks.STATUSES
        }

    def figure(self, extra_height=0.95):
        """A figure with a panel each, titled, with its scales and labels; and the axes in use, in the panels'
        order."""
        columns = min(4, len(self.panels))
        rows = math.ceil(len(self.panels) / columns)
        width, height = (3.0, 2.75) if len(self.panels) > 1 else (6.0, 4.6)
        figure, axes = plt.subplots(rows, columns, squeeze=False, sharex=True, sharey=True,
                                    layout="constrained",
                                    figsize=(width * columns + 0.9, height * rows + extra_height))
        for axis, panel in zip(axes.flat, self.panels):
            axis.set_title("\n".join(looks.titled(k, v) for k, v in self.where(panel).items()))
            if looks.is_log(self.values(self.x)):
                style.log_scale(axis.xaxis)
            if looks.is_log(self.values(self.y)):
                style.log_scale(axis.yaxis)
        for axis in axes.flat[len(self.panels):]:
            axis.set_visible(False)
        figure.supxlabel(f"{axis_label(self.x)}\n{style.wrapped(self.caption(), figure)}", fontsize=9)
        figure.supylabel(axis_label(self.y), fontsize=9)
        if not self.map.whole:
            figure.text(0.01, 0.01,
                        f"INCOMPLETE: {self.map.computed().mean():.0%} of the designs are computed",
                        color="#d62728", fontsize=9)
        return figure, list(axes.flat[:len(self.panels)])

    def fixed(self):
        """{parameter: value} of what all panels share."""
        numbers = {**self.map.numbers(), **{n: self.map.dims[n][i] for n, i in self.index.items()}}
        return {k: v for k, v in numbers.items() if k not in self.map.dims or k in self.index}

    def caption(self):
        """What the axes do not tell: the parameters and the scene all panels share."""
        return looks.words_of(self.map, self.fixed())

    def paper(self, panel):
        """Where the paper's hoop is in a panel, as drawn: (x, y), or None if it does not belong there."""
        here = {**self.fixed(), **self.where(panel)}
        other = [k for k in looks.PAPER if k not in (self.x, self.y)]
        if self.map.slips or not all(
                math.isclose(here.get(k, math.nan), looks.PAPER[k], rel_tol=1e-6, abs_tol=1e-9)
                for k in other):
            return None
        place = []
        for name in (self.x, self.y):
            if name not in looks.PAPER:
                return None
            value = looks.as_shown(name, looks.PAPER[name])
            values = self.values(name)
            if not values[0] <= value <= values[-1]:
                return None
            place.append(value)
        return tuple(place)


def edges_of(values):
    """The edges of cells around sorted values: halfway to the neighbours, by ratio on a logarithmic axis."""
    at = np.log(values) if looks.is_log(values) else values
    middle = (at[1:] + at[:-1]) / 2
    edges = np.concatenate([[2 * at[0] - middle[0]], middle, [2 * at[-1] - middle[-1]]])
    return np.exp(edges) if looks.is_log(values) else edges


def axis_label(name):
    label, _, unit = looks.parameter(name)
    return f"{label} [{'degrees' if unit == '°' else unit}]" if unit else label
