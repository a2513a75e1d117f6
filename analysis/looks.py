# SPDX-License-Identifier: GPL-3.0-or-later
"""Names, units and colours of a map's quantities and outcomes, on charts and on the page."""
import math
import re
from dataclasses import dataclass, replace

import numpy as np

PAPER = {"slope": 0.40, "mass_ratio": 20 / 8.2, "offset_ratio": 1.0, "inertia_factor": 1.0,
         "release_angle": math.pi, "release_spin": 0.0}
# parameter -> its name on an axis, its symbol in a title, its unit as shown
PARAMETERS = {
    "slope": ("slope", "slope", "°"),
    "mass_ratio": ("mass ratio mₚ/m", "mₚ/m", ""),
    "offset_ratio": ("offset ratio L/R", "L/R", ""),
    "inertia_factor": ("inertia factor I/(m R²)", "I/(m R²)", ""),
    "release_angle": ("release angle", "release angle", "°"),
    "release_spin": ("release spin [√(g/R)]", "release spin", ""),
    "drive_torque": ("drive torque τ [(m + mₚ) g R]", "τ", ""),
    "resisting_torque": ("resisting torque [(m + mₚ) g R]", "resisting torque", ""),
    "mu_static": ("static friction coefficient μ", "μ", ""),
    "mu_kinetic": ("kinetic friction coefficient", "μ kinetic", ""),
    "restitution": ("restitution", "restitution", ""),
}
OF_PENDULUM = {
    "pendulum_inertia": ("pendulum's own inertia I/(mₚ L²)", "own inertia", ""),
    "pendulum_angle": ("pendulum's angle at release ψ", "ψ", "°"),
    "pendulum_spin": ("pendulum's spin at release [√(g/R)]", "pendulum's spin", ""),
    "motor_torque": ("motor's stall torque [(m + mₚ) g R]", "stall torque", ""),
    "no_load_speed": ("motor's no-load speed [√(g/R)]", "no-load speed", ""),
    "motor_target": ("motor's target [rad or √(g/R)]", "target", ""),
    "motor_gain": ("motor's gain", "gain", ""),
    "motor_damping": ("motor's damping", "damping", ""),
}
OF_HOOP = tuple(PARAMETERS)
PARAMETERS |= OF_PENDULUM
SI_OF_HELD = {"drive_torque": "N m", "resisting_torque": "N m", "release_spin": "rad/s"}
# status -> colour and words where there is no jump to draw
STATUSES = {
    "no_jump": ("#d9d9d9", "no jump within the rolling limit"),
    "stalled": ("#a6a6a6", "trapped (stalled)"),
    "airborne_at_release": ("#c6b7d6", "airborne at release"),
    "indeterminate": ("#8c6bb1", "indeterminate (Painlevé)"),
    "failed": ("#f4a582", "failed"),
    "not_computed": ("#ffffff", "not computed"),
}


@dataclass
class Look:
    """How a quantity is drawn. levels: of the isolines, None: chosen from the data."""
    label: str
    unit: str
    colours: str = "viridis"
    exponent: float = 1.0  # of the colour scale
    log: bool = False
    levels: tuple = None
    ink: str = "white"  # of the isolines
    star: str = "#d62728"  # of the paper's hoop

    @property
    def title(self):
        return f"{self.label} [{self.unit}]" if self.unit else self.label


HEIGHTS = (0.05, 0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0)
LOOKS = {
    "jump_height": Look("jump height", "hoop diameters", exponent=0.6, levels=HEIGHTS),
    "jump_time": Look("time from release to the jump", "s", "cividis_r", ink="black"),
    "yield": Look("yield: fraction of manufactured hoops that reach every goal", "", "cividis",
                  levels=(0.5, 0.9, 0.99)),
    "jump_height_q05": Look("5 % quantile of the jump height, manufactured", "hoop diameters", exponent=0.6,
                            levels=HEIGHTS),
    "jump_height_q50": Look("median jump height, manufactured", "hoop diameters", exponent=0.6,
                            levels=HEIGHTS),
    "jump_height_q95": Look("95 % quantile of the jump height, manufactured", "hoop diameters", exponent=0.6,
                            levels=HEIGHTS),
    "jump_height_mean": Look("mean jump height, manufactured", "hoop diameters", exponent=0.6,
                             levels=HEIGHTS),
    "jump_height_sd": Look("standard deviation of the jump height, manufactured", "hoop diameters", "magma"),
    "jump_time_mean": Look("mean jump time, manufactured", "s", "cividis_r", ink="black"),
    "jump_time_sd": Look("standard deviation of the jump time, manufactured", "s", "magma"),
    "jump_time_q05": Look("5 % quantile of the jump time, manufactured", "s", "cividis_r", ink="black"),
    "jump_time_q50": Look("median jump time, manufactured", "s", "cividis_r", ink="black"),
    "jump_time_q95": Look("95 % quantile of the jump time, manufactured", "s", "cividis_r", ink="black"),
    "jump_height_low": Look("least proved jump height of the cell", "hoop diameters", exponent=0.6,
                            levels=HEIGHTS),
    "jump_height_high": Look("largest proved jump height of the cell", "hoop diameters", exponent=0.6,
                             levels=HEIGHTS),
    "proof": Look("what is proved of the cell: 1 one outcome, 2 crossed, 3 open", "", levels=()),
    "agility": Look("agility: height over time from release to apex", "m/s", "plasma", log=True, star="black",
                    levels=(0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 1.0, 2.0)),
    # it has cliffs of its own
    "first_jump_height": Look("height of the first lift-off", "hoop diameters", exponent=0.6, levels=()),
    "first_jump_time": Look("time from release to the first lift-off", "s", "cividis_r", ink="black",
                            levels=()),
    "jump_angle": Look("angle at the jump's lift-off", "rad"),
    "jump_spin": Look("spin at the jump's lift-off", "√(g/R)"),
    "apex_time": Look("time from lift-off to apex", "s"),
    "flight_time": Look("time from lift-off to landing", "s"),
    "dip": Look("lowest height right after lift-off", "hoop diameters", "viridis_r"),
    "candidates": Look("number of lift-offs", "", levels=()),
    "slip_distance": Look("distance slid", "R"),
    "landing_spin": Look("spin after landing", "√(g/R)"),
    "jump_range": Look("range of the jump along the plane", "R"),
    "landing_normal_speed": Look("landing speed towards the plane", "√(g R)"),
    "landing_tangential_speed": Look("landing velocity along the plane", "√(g R)"),
    "landing_impulse": Look("normal impulse of the landing", "(m + mₚ) √(g R)"),
    "landing_energy_lost": Look("energy lost in the landing", "(m + mₚ) g R"),
    "clears_from": Look("first place where the wall is cleared", "R"),
    "clears_to": Look("last place where the wall is cleared", "R"),
    "max_normal_force": Look("largest normal force until the jump", "(m + mₚ) g"),
    "motor_energy": Look("work of the motor until the jump", "(m + mₚ) g R"),
    "motor_max_power": Look("largest power of the motor until the jump", "(m + mₚ) g √(g R)"),
    "motor_max_spin": Look("largest spin until the jump", "√(g/R)"),
    "motor_max_torque": Look("largest torque of the motor until the jump", "(m + mₚ) g R"),
    "efficiency": Look("weight times height over the motor's work", ""),
    "jump_distance": Look("distance travelled until the jump", "R"),
    "energy_lost": Look("energy lost until the jump", "(m + mₚ) g R"),
    "jumps": Look("number of jumps", "", levels=()),
    "sequence_condition": Look("growth of errors up to the last landing", "", log=True),
    "gait_period": Look("period of the gait (0: the jumps end)", "jumps", levels=()),
    "gait_multiplier": Look("Floquet multiplier of the gait", "", levels=(-0.5, 0.0, 0.5)),
    "gait_height": Look("mean height of the gait's jumps", "hoop diameters", exponent=0.6, levels=HEIGHTS),
    "gait_speed": Look("speed of the gait", "m/s"),
    "gait_jump_time": Look("time per jump of the gait", "s"),
    "gait_energy_lost": Look("energy lost per jump of the gait", "(m + mₚ) g R"),
}
# Vertical jumping agility of published jumpers [m/s]: Haldane, Plecnik, Yim and Fearing, "Robotic vertical
# jumping agility via series-elastic power modulation", Science Robotics 1 (2016) eaag2048.
JUMPERS = {"Salto": 1.75, "galago": 2.24}
JUMPERS_SOURCE = "Haldane et al., Science Robotics 1 (2016) eaag2048"


def scale_words(look):
    """How colours go with values, where it is not evenly."""
    return "logarithmic" if look.log else f"power {look.exponent:g}" if look.exponent != 1.0 else ""


def is_of_made(name):
    """Whether a quantity is of hoops as made, and so smooth across the cliffs of hoops as drawn."""
    return name == "yield" or name.endswith(("_q05", "_q50", "_q95", "_mean", "_sd"))


def is_of_gait(name):
    """Whether a quantity is of the gait that a hoop settles on, whatever its first jump was."""
    return name.startswith("gait_")


def quantity(m, name):
    """A field of the map, or what follows from several; NaN where it does not apply. None if the map cannot
    tell."""
    if name == "agility" and name not in m.fields:
        parts = [m.fields.get(k) for k in ("jump_height", "jump_time", "apex_time")]
        if any(p is None for p in parts):
            return None
        height, time, apex = (np.asarray(p, float) for p in parts)
        with np.errstate(divide="ignore", invalid="ignore"):
            return 2 * m.radii() * height / (time + apex)
    values = m.fields.get(name)
    return None if values is None or name not in LOOKS else np.asarray(values, float)


def use_units(m, text, units_in_own):
    """Gives the map's quantities in the units of a text such as "mm m/s ms", the first that fits.
    units_in_own(unit, field, scales): how large the field's own unit is in another."""
    gravity, radii, masses = m.numbers()["gravity"], m.radii(), m.masses()

    def size_of(word, name):
        """How large the field's own unit is, for each design if they differ in size or mass: a product of
        powers of both."""
        at = lambda radius, mass: units_in_own(word, name, {"gravity": gravity, "radius": radius} | (
            {} if masses is None else {"mass": mass}))
        if np.ndim(radii) == 0 and np.ndim(masses) == 0:
            return at(radii, masses)
        one, larger, heavier = at(1.0, 1.0), at(4.0, 1.0), at(1.0, 4.0)
        if one is None:
            return None
        power = lambda size: np.log(size / one) / np.log(4)
        return one * radii**power(larger) * (1.0 if masses is None else masses)**power(heavier)
    agility, used = quantity(m, "agility"), set()
    # Statistics of manufactured hoops that differ in what a unit is made of have none of the SI in common.
    scattered = {"radius": "hoop.diameter" in m.scatter(),
                 "mass": any(re.fullmatch(r"hoop\.(.+\.)?mass", name) for name in m.scatter())}

    def differs(word, name):
        one = {"gravity": gravity, "radius": 1.0, "mass": 1.0}
        of_one = units_in_own(word, name, one)
        return of_one is not None and any(units_in_own(word, name, one | {what: 2.0}) != of_one
                                          for what, scatters in scattered.items() if scatters)
    for name in set(m.fields) & set(LOOKS):
        for word in text.split():
            if is_of_made(name) and differs(word, name) or (size := size_of(word, name)) is None:
                continue
            m.fields[name] = np.asarray(m.fields[name], float) * size
            LOOKS[name] = replace(LOOKS[name], unit=word, levels=LOOKS[name].levels and None)
            used.add(word)
            break
    if agility is not None:
        m.fields["agility"] = agility
    if rest := [word for word in text.split() if word not in used]:
        raise ValueError(
            f"--units {rest[0]}: fits no quantity of the map; allowed: units with blanks between "
            "them, for example \"mm m/s ms\"")


def in_drawing(m, name, units_in_own):
    """The unit in which a drawing has a quantity, and how many of it are one of the map's; None: the map is
    not of a hoop from a drawing, its hoops differ in size, or no unit is better than the map's."""
    numbers = m.numbers()
    if "hoop" not in m.spec() or np.ndim(m.radii()) > 0:
        return None
    known = ("radius", "gravity", *(("mass", ) if np.ndim(m.masses()) == 0 else ()))
    scales = {key: numbers[key] for key in known if numbers.get(key)}
    for word in ("mm", "N", "N.s", "J", "W", "rpm"):
        factor = units_in_own(word, name, scales)
        if factor is not None:
            return word, factor
    return None


def levels_of(look, values):
    """Where the isolines lie: given, or 1-2-5 steps that give 8 to 16 of them over the middle of the data."""
    if look.levels is not None:
        return np.asarray(look.levels)
    finite = values[np.isfinite(values)]
    low, high = np.percentile(finite, [0.5, 99.0]) if finite.size else (0.0, 1.0)
    high = max(high, low + 1e-6 * abs(low) + 1e-9)
    for step in (s * 10.0**e for e in range(-9, 12) for s in (1, 2, 5)):
        if (high - low) / step <= 16:
            return np.arange(math.floor(low / step), math.ceil(high / step) + 1) * step
    return np.zeros(0)  # none is of use


# of [hoop]: its words, its unit as shown, how many of that are one of the SI's
BODY = {
    "diameter": ("diameter", "mm", 1e3), "mass": ("mass", "g", 1e3),
    "at": ("distance from the axis", "mm", 1e3),
    "angle": ("direction", "°", 180 / math.pi), "inertia": ("moment of inertia", "kg mm²", 1e6)
}


def _of_body(name):
    """The weight and the row of BODY of hoop.slug.mass or hoop.mass; None: another parameter."""
    parts = name.split(".")
    if parts[0] != "hoop" or parts[-1] not in BODY or len(parts) > 3:
        return None
    whole = "hoop" if parts[-1] == "diameter" else "ring"
    return parts[1] if len(parts) == 3 else whole, BODY[parts[-1]]


def listed(m):
    """The numbers that a list of designs gives: those of [hoop], and the parameters that do not follow from
    it."""
    of_hoop = [name for name in m.fields if _of_body(name)]
    follow = ("mass_ratio", "offset_ratio", "inertia_factor") if of_hoop else ()
    return of_hoop + [name for name in PARAMETERS if name in m.fields and name not in follow]


_held = {}  # of the map read last: parameters that its hoops share in the SI, with the size of the map's unit


def show_held(sizes):
    """Has parameters shown in the SI, {name: how many of its unit are one of the map's}, and no others."""
    _held.clear()
    _held.update(sizes)


def parameter(name):
    """A parameter's name on an axis, its symbol, its unit as shown; its own name for one that is unknown."""
    if body := _of_body(name):
        weight, (words, unit, _) = body
        return f"{words} of {weight}", f"{words} of {weight}", unit
    label, symbol, unit = PARAMETERS.get(name, (name, name, ""))
    return (label.split(" [")[0], symbol, SI_OF_HELD[name]) if name in _held else (label, symbol, unit)


def factor(name):
    """How many of the unit as shown are one of the map's."""
    body = _of_body(name)
    return body[1][2] if body else 180 / math.pi if is_angle(name) else _held.get(name, 1.0)


def is_angle(name):
    return parameter(name)[2] == "°"


def as_shown(name, values):
    """A parameter's values in the unit they are shown in: angles in degrees, masses in grams."""
    return np.degrees(values) if is_angle(name) else values if factor(name) == 1.0 else values * factor(name)


def shown(name, value):
    unit = parameter(name)[2]
    return f"{as_shown(name, value):.4g}{unit if unit == '°' else ' ' + unit}".rstrip()


def titled(name, value):
    return f"{parameter(name)[1]} = {shown(name, value)}"


def spread(name, law, width, percent):
    """How a parameter of hoops as made differs from the drawing, in words."""
    return f"{parameter(name)[0].split(' [')[0]} {'±' if law == 'uniform' else 'σ ='} " + (
        f"{width:g} %" if percent else shown(name, width))


def made_words(m):
    """How hoops of a map are made and what they must do, in words; [] of a map without [scatter]."""
    scatter = [spread(name, *law) for name, law in m.scatter().items()]
    return ["manufactured hoops: " +
            ", ".join(scatter), *(f"goal: {word}" for word in goal_words(m))] if scatter else []


def goal_words(m):
    words, text = [], lambda bound: bound if isinstance(bound, str) else f"{bound:g}"
    for field, (least, most) in m.goals().items():
        name = LOOKS[field].label if field in LOOKS else field
        if least == most:
            words.append(f"{name} is {least}")
        else:
            words.append(name + (f" at least {text(least)}" if least is not None else "") +
                         (f" at most {text(most)}" if most is not None else ""))
    return words


def words_of(m, fixed):
    """What a picture's axes do not tell: the parameters of `fixed`, {name: value}, the model and the
    scene."""
    contact = ("mu_static", "mu_kinetic", "restitution")
    told = [
        k for k in PARAMETERS
        if k in fixed and (k not in contact or m.slips) and (not k.endswith("_torque") or fixed[k] != 0)
        and (k not in OF_PENDULUM or (math.isfinite(fixed[k]) and fixed[k] != 0))
    ]
    numbers = m.numbers()
    return [
        *(titled(k, fixed[k]) for k in told), "Coulomb friction" if m.slips else "no slip",
        f"rolling limit {numbers['runway']:g} revolutions", f"jump from {numbers['hop_height']:g} diameters",
        *([f"R = {1e3 * numbers['radius']:g} mm"] if np.ndim(m.radii()) == 0 else [])
    ]


def fixed_numbers(m):
    """{parameter: value} of those that neither an axis nor a column of the map varies."""
    listed = {k: m.fields[k][0] for k in PARAMETERS if k in m.fields and len(set(m.fields[k].tolist())) == 1}
    return {
        k: v for k, v in m.numbers().items() if k in PARAMETERS and k not in m.dims and k not in m.fields
    } | listed


def is_log(values):
    """Whether an axis is drawn on a logarithmic scale: its values are spread like that."""
    if not (values[0] > 0 and values[-1] / values[0] > 10):
        return False
    middle, ends = values[len(values) // 2], (values[0] + values[-1]) / 2
    return len(values) > 2 and abs(math.log(middle / math.sqrt(values[0] * values[-1]))) < abs(
        math.log(middle / ends))


def course(m):
    """A complex number for each jump, either part of which changes by more than 1 from a design to the next
    only where the jump passes to another lift-off, an angle of more than 1 rad away, or its apex to another
    maximum of its flight, in time by a quarter. None if the map cannot tell."""
    if "jump_angle" not in m.fields:
        return None
    apex = np.asarray(m.fields["apex_time"], float) if "apex_time" in m.fields else 1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(m.fields["jump_angle"], float) + 4.0j * np.log(apex)


def cliffs(course, axis):
    """Between which neighbours along an axis the jump takes another course: isolines must not cross there."""
    with np.errstate(invalid="ignore"):
        change = np.diff(course, axis=axis)
        return (np.abs(change.real) > 1.0) | (np.abs(change.imag) > 1.0)
