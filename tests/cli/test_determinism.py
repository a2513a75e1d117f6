# SPDX-License-Identifier: GPL-3.0-or-later
"""Same spec, same bits, whatever the number of threads."""
import h5py
import numpy as np
from support.program import SMALL, sweep

VOLATILE = {"date", "host", "threads", "wall_time"}


def contents(path):
    with h5py.File(path) as m:
        data = {name: (d[()].tobytes(), str(d.dtype), {k: np.asarray(v).tobytes() for k, v in d.attrs.items()
                                                       if k not in ("DIMENSION_LIST", "REFERENCE_LIST")})
                for name, d in m.items() if isinstance(d, h5py.Dataset)}
        return data, {k: np.asarray(v).tobytes() for k, v in m.attrs.items() if k not in VOLATILE}


def test_one_and_two_threads_give_bitwise_equal_maps(tmp_path):
    one = sweep(tmp_path, SMALL, "--threads", "1", name="one.h5")
    for threads in ("2", "5"):
        many = sweep(tmp_path, SMALL, "--threads", threads, name=f"{threads}.h5")
        assert contents(one) == contents(many)


def test_the_spec_in_a_map_makes_the_same_map_again(tmp_path):
    first = sweep(tmp_path, name="first.h5")
    with h5py.File(first) as m:
        spec = m.attrs["spec"]
    again = sweep(tmp_path, spec, name="again.h5")
    assert contents(first) == contents(again)
