# SPDX-License-Identifier: GPL-3.0-or-later
"""Read leapmap's files: maps of many designs, and traces of one.

    from read_map import read_map
    m = read_map("maps/slope_mass_ratio.h5")
    m.dims["slope"]            # values of an axis
    m.fields["jump_height"]    # an array along all axes; NaN: no jump
    m.code("status", "jumped") # a boolean array: has this meaning
"""
import math
import re
import tomllib
import zlib
from dataclasses import dataclass, field

import h5py
import numpy as np

import looks
from open_file import Refused, names_in, opened

FORMAT_MAJOR = 1  # the newest format this reader knows


class NotAMap(Exception):
    """The file is of another type, of a newer format, damaged, or lacks what was asked of it."""


class Unreadable(NotAMap, OSError):
    """The system failed to read it; errno says why."""

    def __init__(self, errno, text):
        super().__init__(text)
        self.errno = errno


class Fields(dict):
    """Arrays by name; one that is not there is said so in one line."""

    def __init__(self, path):
        super().__init__()
        self.path = path

    def __missing__(self, name):
        raise NotAMap(f"{self.path}: has no {name}; it has {', '.join(self) or 'no fields'}")


@dataclass
class Map:
    path: str
    attributes: dict
    dims: dict = field(default_factory=dict)  # name -> values, in the order of the fields' dimensions
    fields: Fields = None  # name -> array
    about: dict = field(default_factory=dict)  # name -> its attributes (units, long_name, ...)
    labels: np.ndarray = None  # of a list that has them: the names of its designs
    tile: tuple = ()  # how many designs a chunk holds along each axis

    @property
    def whole(self):
        """False for the .part that a stopped sweep left: designs not computed are holes, status
        not_computed."""
        return "tiles_done" not in self.attributes

    @property
    def slips(self):
        """Whether its contact slips by Coulomb's law."""
        return any(
            line.startswith("friction") and "coulomb" in line
            for line in self.attributes["spec"].splitlines())

    @property
    def has_pendulum(self):
        """Whether it is of a hoop with a driven pendulum."""
        return any(
            line.startswith("model") and "pendulum" in line for line in self.attributes["spec"].splitlines())

    def computed(self):
        """Where designs are computed, as a boolean array; in a whole map, everywhere. Fields without status
        hold the same values where a design does not jump and where it was not computed yet."""
        shape = [len(v) for v in self.dims.values()]
        if self.whole:
            return np.ones(shape, bool)
        tiles = [-(-n // k) for n, k in zip(shape, self.tile)]
        # tiles come in C order
        done = (np.arange(np.prod(tiles)) < self.attributes["tiles_done"]).reshape(tiles)
        for axis, k in enumerate(self.tile):
            done = np.repeat(done, k, axis)
        return done[tuple(slice(n) for n in shape)]

    def meanings(self, name):
        """{meaning: value} of a code."""
        about = self.about[name]
        words, values = about.get("flag_meanings"), np.atleast_1d(about.get("flag_values", []))
        if not isinstance(words, str) or len(
                words.split()) != len(values) or values.dtype.kind not in "iu" or (values > 255).any():
            raise NotAMap(f"{self.path}: {name} does not say what its codes mean")
        return dict(zip(words.split(), values.tolist()))

    def code(self, name, meaning):
        """Where the code `name` has this meaning; nowhere if it knows none such."""
        return self.fields[name] == self.meanings(name).get(meaning, 256)

    def spec(self):
        """The resolved spec that made it: {section: {key: value}}."""
        try:
            return tomllib.loads(self.attributes["spec"])
        except tomllib.TOMLDecodeError:
            raise NotAMap(f"{self.path}: is damaged: its spec is not TOML") from None

    def scatter(self):
        """How hoops of the map are made: {parameter: (law, width, whether that is in per cent)}; {}: they are
        as drawn."""
        made = {}

        def laws(prefix, table):
            """Those of [hoop] are nested, as hoop.slug.mass."""
            for name, law in table.items():
                if isinstance(law, dict) and not law.keys() & {"normal", "uniform"}:
                    yield from laws(f"{prefix}{name}.", law)
                elif name not in ("samples", "seed", "interpolate"):
                    yield prefix + name, law

        for name, law in laws("", self.spec().get("scatter", {})):
            try:
                (kind, width), = law.items()
                percent = isinstance(width, str)
                made[name] = (str(kind), float(width.removesuffix("%") if percent else width), percent)
            except (AttributeError, TypeError, ValueError):
                raise NotAMap(f"{self.path}: is damaged: its spec says scatter.{name} = {law}") from None
        return made

    def sampling(self):
        """How many hoops are made after each design, and the seed of the points they are made by."""
        told = self.spec().get("scatter", {})
        numbers = [told.get(key, usual) for key, usual in (("samples", 1024), ("seed", 1))]
        if not all(
                isinstance(number, int) and 0 <= number <= most
                for number, most in zip(numbers, (1 << 20, 10**15))):
            raise NotAMap(f"{self.path}: is damaged: its spec says scatter.samples, scatter.seed = {numbers}")
        return numbers

    def goals(self):
        """What hoops of the map must do: {field: (at least, at most)}, None: no bound; a code's name or a
        phase_sequence's letters twice; "0.05 m": the same for hoops of every size and mass."""
        goals = {
            field: goal
            for field, goal in self.spec().get("goal", {}).items()
            if field not in ("maximize", "minimize")
        }
        if not all(isinstance(goal, dict) for goal in goals.values()):
            raise NotAMap(f"{self.path}: is damaged: its spec says goal = {goals}")
        return {
            field: (goal.get("at_least", goal.get("is")), goal.get("at_most", goal.get("is")))
            for field, goal in goals.items()
        }

    def has_goals_in_si(self):
        return any(isinstance(bound, str) and bound[:1] in "-0123456789" for bounds in self.goals().values()
                   for bound in bounds)

    def objectives(self):
        """What the designs of a list were found for: [(field or parameter, whether it is to be large)]."""
        goal = self.spec().get("goal", {})
        named = {key: goal.get(key, []) for key in ("maximize", "minimize")}
        if not all(isinstance(names, list) for names in named.values()):
            raise NotAMap(f"{self.path}: is damaged: its spec says goal = {goal}")
        return [(str(name), key == "maximize") for key, names in named.items() for name in names]

    def numbers(self):
        """The numbers of the resolved spec that made it, by key; what an axis varies is not among them."""
        found = {}
        for section, keys in self.spec().items():
            if section != "hoop" and isinstance(keys, dict):
                found |= {key: float(value) for key, value in keys.items() if isinstance(value, (int, float))}
        return found | self._of_hoop()

    def radii(self):
        """R of the designs [m]: one number, or an array that goes with a field."""
        if "hoop.diameter" in self.fields:  # of a list
            return np.asarray(self.fields["hoop.diameter"]) / 2
        if "hoop.diameter" not in self.dims:
            return self.numbers()["radius"]
        axis = list(self.dims).index("hoop.diameter")
        shape = [-1 if k == axis else 1 for k in range(len(self.dims))]
        return np.asarray(self.dims["hoop.diameter"]).reshape(shape) / 2

    def held(self):
        """Parameters that the hoops share in the SI, and how many of its unit are one of the nominal hoop's,
        in which the map has them."""
        first = lambda value: value["values"][0] if isinstance(value, dict) else value
        try:
            names = self.spec().get("design", {}).get("nominal_units", [])
            if not names:
                return {}
            hoop, gravity = self.spec()["hoop"], self.numbers()["gravity"]
            radius = float(first(hoop["diameter"])) / 2
            mass = sum(float(first(part["mass"])) for part in (hoop, *hoop.get("weight", [])))
            sizes = {"N m": mass * gravity * radius, "rad/s": math.sqrt(gravity / radius)}
            return {name: sizes[looks.SI_OF_HELD[name]] for name in names}
        except (AttributeError, KeyError, IndexError, TypeError, ValueError, ZeroDivisionError):
            raise NotAMap(
                f"{self.path}: is damaged: its spec names no hoop that nominal_units are of") from None

    def masses(self):
        """Total masses of the designs [kg]: one number, an array that goes with a field, or None: unknown."""
        hoop = self.spec().get("hoop")
        if hoop is None:
            return self.numbers().get("mass") or None
        number = lambda value: float("nan") if isinstance(value, dict) else float(value)
        total = 0.0
        try:
            given = [("hoop.mass", number(hoop["mass"])),
                     *((f"hoop.{w['name']}.mass", number(w["mass"])) for w in hoop.get("weight", []))]
        except (AttributeError, KeyError, TypeError, ValueError):
            raise NotAMap(f"{self.path}: is damaged: its spec says hoop = {hoop}") from None
        for key, value in given:
            if key in self.fields:  # of a list
                total = total + np.asarray(self.fields[key], float)
            elif key in self.dims:
                axis = list(self.dims).index(key)
                shape = [-1 if k == axis else 1 for k in range(len(self.dims))]
                total = total + np.asarray(self.dims[key]).reshape(shape)
            else:
                total = total + value
        return total

    def _of_hoop(self):
        """What the numbers of [hoop] come to; only the radius where an axis varies one of them, of the first
        design if it is the diameter."""
        hoop = self.spec().get("hoop")
        if hoop is None:
            return {}
        try:
            diameter = hoop["diameter"]
            radius = (diameter["values"][0] if isinstance(diameter, dict) else diameter) / 2
            weights = hoop.get("weight", [])
            if any(isinstance(value, dict) for part in (hoop, *weights) for value in part.values()):
                return {"radius": radius}
            m, at, angle, own = (np.array([weight[key] for weight in weights], float)
                                 for key in ("mass", "at", "angle", "inertia"))
            place = at * np.exp(1j * angle)
            centre = (m * place).sum() / m.sum() if m.sum() > 0 else 0.0
            ring = hoop.get("inertia", hoop["mass"] * radius**2)
            inertia = ring + (own + m * np.abs(place - centre)**2).sum()
            return {"radius": radius, "mass": hoop["mass"] + m.sum(), "mass_ratio": m.sum() / hoop["mass"],
                    "offset_ratio": min(abs(centre) / radius, 1.0),
                    "inertia_factor": inertia / (hoop["mass"] * radius**2)}
        except (AttributeError, KeyError, TypeError, ValueError):
            raise NotAMap(f"{self.path}: is damaged: its spec says hoop = {hoop}") from None


def _read(path, filetype, most_designs=math.inf, texts=()):
    try:
        with opened(path, filetype, texts) as file:
            return _read_open(path, file, most_designs)
    except Refused as error:
        raise NotAMap(f"{path}: {error}") from None
    except FileNotFoundError:
        raise NotAMap(f"{path}: does not exist") from None
    except MemoryError:
        raise NotAMap(f"{path}: holds more than this machine has memory for") from None
    except OSError as error:
        if error.errno:
            raise Unreadable(error.errno, f"{path}: cannot be read ({error.strerror})") from None
        raise NotAMap(f"{path}: cannot be read as HDF5 ({error})") from None
    except (AttributeError, IndexError, KeyError, RuntimeError, TypeError, ValueError) as error:
        raise NotAMap(
            f"{path}: is damaged, or not written by leapmap ({' '.join(str(error).split())})") from None


def _read_open(path, file, most_designs):
    attributes = _attributes_of(file)
    version = np.asarray(attributes["version"])
    if version.shape != (2,) or version.dtype.kind not in "iu" or version[0] < 1 or version[1] < 0:
        raise ValueError("its version is no pair of whole numbers")
    if version[0] > FORMAT_MAJOR:
        raise NotAMap(
            f"{path}: has format {attributes['version'][0]}, this reader knows up to {FORMAT_MAJOR}: "
            "use a newer leapmap")
    result = Map(str(path), attributes, fields=Fields(str(path)))
    # the group is for viewers
    datasets = {name: file[name] for name in names_in(file) if isinstance(file.get(name), h5py.Dataset)}
    for name, dataset in datasets.items():
        if not re.fullmatch(r"[A-Za-z][\w.-]*", name, re.ASCII):
            raise NotAMap(f"{path}: is damaged: it has a dataset of the name {name!r}")
        if dataset.size > most_designs:
            raise NotAMap(
                f"{path}: holds {dataset.size} designs, too many for this (at most {most_designs}); sweep "
                "fewer"
            )
    for name, dataset in datasets.items():
        result.about[name] = _attributes_of(dataset)
        if h5py.h5ds.is_scale(dataset.id):
            continue
        result.fields[name] = _texts_of(dataset) if h5py.check_string_dtype(
            dataset.dtype) else _values_of(dataset)
        result.tile = dataset.chunks or result.tile
        for axis in _axes_of(file, dataset):  # the order of dimensions is the fields' own
            result.dims.setdefault(axis, _values_of(datasets[axis]))
    return result


MOST_ATTRIBUTE = 2**24  # bytes of an attribute's numbers; texts have one each


def _attributes_of(thing):
    """All attributes. What no file of ours has is refused: a list of texts may take far more memory than its
    file."""
    found = {}
    for name in thing.attrs:
        attribute = thing.attrs.get_id(name)
        is_list_of_texts = h5py.check_string_dtype(
            attribute.dtype) and attribute.get_space().get_simple_extent_npoints() > 1
        if is_list_of_texts or attribute.get_storage_size() > MOST_ATTRIBUTE:
            raise ValueError(f"its attribute {name!r} is larger than any of leapmap's")
        found[name] = thing.attrs[name]
    return found


def _values_of(dataset):
    """A dataset's values. A chunk that inflates to more than its values is refused, as HDF5 would take all
    the memory it needs."""
    if dataset.chunks and dataset.compression == "gzip":
        size = math.prod(dataset.chunks) * dataset.dtype.itemsize
        plan = dataset.id.get_create_plist()
        deflate = [plan.get_filter(i)[0] for i in range(plan.get_nfilters())].index(h5py.h5z.FILTER_DEFLATE)
        for i in range(dataset.id.get_num_chunks()):
            chunk = dataset.id.get_chunk_info(i)
            if chunk.size > size + size // 1000 + 64:
                raise ValueError(f"a chunk of {dataset.name} inflates to more than its values")
            # zlib packs no more into a byte; what cannot be large is left to HDF5
            if chunk.size * 1032 > 2**27:
                raw = dataset.id.read_direct_chunk(chunk.chunk_offset)[1]
                if not chunk.filter_mask >> deflate & 1 and len(zlib.decompressobj().decompress(
                        raw, size + 1)) > size:
                    raise ValueError(f"a chunk of {dataset.name} inflates to more than its values")
    return dataset[()]


def _texts_of(dataset, most=2**26):
    """A column of texts, which may all point at the same long one."""
    found, size = [], 0
    for i in range(len(dataset)):
        found.append(dataset.asstr()[i])
        size += len(found[-1])
        if size > most:
            raise ValueError(f"{dataset.name} holds more text than any table")
    return np.array(found, object)


def _axes_of(file, dataset):
    """The names of a dataset's dimension scales. h5py's own way through HDF5 crashes where the attribute is
    another."""
    attribute = h5py.h5a.open(dataset.id, b"DIMENSION_LIST")
    element = h5py.check_vlen_dtype(attribute.dtype)
    if element is None or h5py.check_ref_dtype(element) is not h5py.Reference or attribute.shape != (
            dataset.ndim, ):
        raise ValueError(f"{dataset.name} does not say what its dimensions are")
    return [file[scales[0]].name.lstrip("/") for scales in dataset.attrs["DIMENSION_LIST"]]


BEYOND = 1e100  # no quantity of a hoop is as large
BEYOND_SPEC = 1e15  # nor any number of a spec
MAY_BE_INFINITE = ("no_load_speed", "motor_gain")  # of motors


def _check_numbers(m, name, values, dimensions):
    """Real numbers of that many dimensions, NaN allowed; of fields, of sizes that can be drawn."""
    if not isinstance(values, np.ndarray) or values.ndim != dimensions or values.dtype.kind not in "fiu":
        raise NotAMap(f"{m.path}: is damaged: {name} is no array of numbers over its axes")
    known = values[~np.isnan(values)] if values.dtype.kind == "f" else values
    if name in MAY_BE_INFINITE:
        known = known[~np.isposinf(known)]
    if name in m.fields and values.dtype.kind == "f" and (np.abs(known) > BEYOND).any():
        raise NotAMap(f"{m.path}: is damaged: {name} holds numbers beyond all bounds")


def _check_scene(m):
    """What every chart says of the scene."""
    if not isinstance(m.attributes.get("spec"), str):
        raise NotAMap(f"{m.path}: is damaged: its attribute spec is no text")
    numbers = m.numbers()
    for key, value in numbers.items():
        if not abs(value) < BEYOND_SPEC and not (key in MAY_BE_INFINITE and value == math.inf):
            raise NotAMap(f"{m.path}: is damaged: its spec says {key} = {value}")
    for key, least in (("radius", 0.0), ("gravity", 0.0), ("runway", 0.0), ("tolerance", 0.0), ("hop_height",
                                                                                                -1e-300)):
        if not least < numbers.get(key, np.nan) < np.inf:
            raise NotAMap(f"{m.path}: is damaged: its spec says {key} = {numbers.get(key, 'nothing')}")


def read_map(path, most_designs=math.inf):
    """A map, as `leapmap sweep` writes it. Raises NotAMap with one clear line for anything else, and for a
    map of more than most_designs before it is read."""
    m = _read(path, "leapmap map", most_designs, ("label",))
    m.labels = m.fields.pop("label", None)
    _check_scene(m)
    for name, values in m.dims.items():
        _check_numbers(m, name, values, 1)
        if not np.isfinite(values).all() or len(np.unique(values)) != len(values) or len(values) == 0:
            raise NotAMap(f"{m.path}: is damaged: the values of its axis {name} are not distinct numbers")
    for name, values in m.fields.items():
        _check_numbers(m, name, values, len(m.dims))
        if values.shape != tuple(len(v) for v in m.dims.values()):
            raise NotAMap(
                f"{m.path}: is damaged: {name} has the shape {values.shape}, which is not that of its axes")
    if m.labels is not None and (m.labels.dtype.kind != "O" or m.labels.shape !=
                                 (len(m.dims.get("design", ())), )):
        raise NotAMap(f"{m.path}: is damaged: it has not a label for each design of a list")
    if not m.whole and not (isinstance(m.attributes["tiles_done"], np.integer)
                            and len(m.tile) == len(m.dims)):
        raise NotAMap(f"{m.path}: is damaged: it does not say which of its tiles are done")
    looks.show_held(m.held())
    return m


def read_trace(path):
    """One design's motion, as `leapmap hop --trace` writes it. Raises NotAMap likewise."""
    trace = _read(path, "leapmap trace")
    _check_scene(trace)
    for key in ("slope", "mass_ratio", "offset_ratio", "release_angle", "release_spin", "mu_static",
                "restitution"):
        if not np.isfinite(trace.numbers().get(key, np.nan)):
            raise NotAMap(f"{trace.path}: is damaged: its spec does not say the {key}")
    if not isinstance(trace.attributes.get("status"), str):
        raise NotAMap(f"{trace.path}: is damaged: its attribute status is no text")
    columns = ("phi", "spin", "x", "y", "normal_force", "friction", "phase")
    for name in (*columns, "candidate_time", "candidate_height",
                 *(["candidate_is_jump"] if "candidate_is_jump" in trace.fields else [])):
        along = trace.dims.get("t" if name in columns else "candidate", np.zeros(0))
        _check_numbers(trace, name, trace.fields[name], 1)
        if len(trace.fields[name]) != len(along):
            raise NotAMap(f"{trace.path}: is damaged: {name} is not as long as its axis")
    # Older traces end with their one jump.
    times = trace.fields["candidate_time"]
    if "candidate_is_jump" in trace.fields:
        trace.fields["candidate_is_jump"] = np.asarray(trace.fields["candidate_is_jump"]) == 1
    else:
        trace.fields["candidate_is_jump"] = (np.arange(len(times))
                                             == len(times) - 1) & (trace.attributes["status"] == "jumped")
    if trace.attributes["status"] == "jumped" and not (trace.fields["candidate_is_jump"].any() and len(
            trace.fields["candidate_time"]) and trace.code("phase", "flight").any()):
        raise NotAMap(f"{trace.path}: is damaged: it says that the hoop jumped, but holds no flight")
    return trace


def phases(sequence):
    """A phase_sequence as letters, for example "RSRSF": rolling, sliding, flight; the first 32."""
    return "".join("-RSF"[int(sequence) >> 2 * i & 3] for i in range(32) if int(sequence) >> 2 * i & 3)


def read_table(path, filetype):
    """A study's table, for example "leapmap precision": fields are its columns, numbers or texts."""
    return _read(path, filetype, texts=True)
