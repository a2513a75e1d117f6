# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder analysis/ beside this file: chart scripts, and the reader of maps that they share."""
import importlib
import os
import sys
import threading

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "analysis")
_NEIGHBOURS = ("read_map", "open_file")
_lock, _loaded = threading.Lock(), {}


def reader():
    """Import analysis/read_map.py.

    It finds its neighbour open_file on the path, as scripts do. Neither name stays in sys.modules, which may
    hold a user's own modules of those names."""
    with _lock:
        if not _loaded:
            others = {name: sys.modules.pop(name) for name in _NEIGHBOURS if name in sys.modules}
            sys.path.insert(0, FOLDER)
            try:
                _loaded["read_map"] = importlib.import_module("read_map")
            finally:
                sys.path.remove(FOLDER)
                for name in _NEIGHBOURS:
                    sys.modules.pop(name, None)
                sys.modules.update(others)
        return _loaded["read_map"]
