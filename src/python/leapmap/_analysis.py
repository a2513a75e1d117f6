# SPDX-License-Identifier: GPL-3.0-or-later
"""The folder analysis/ beside this file: scripts that run by themselves, and the reader they share."""
import importlib
import os
import sys

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "analysis")


def module(name):
    """One of its modules, which find each other as neighbours on the path."""
    sys.path.insert(0, FOLDER)
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(FOLDER)
