# SPDX-License-Identifier: GPL-3.0-or-later
"""Sphinx's configuration of leapmap's site. sh docs/build.sh builds it."""
import os
import re
from pathlib import Path

TOP = Path(os.environ["LEAPMAP_TOP"])
project = "leapmap"
copyright = "the leapmap authors, GPL-3.0-or-later"
release = re.search(r"project\(leapmap[^)]*VERSION ([\d.]+)", (TOP / "CMakeLists.txt").read_text())[1]
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "breathe"]
myst_enable_extensions = ["colon_fence", "deflist"]
myst_heading_anchors = 3
breathe_projects = {"leapmap": os.environ["LEAPMAP_DOXYGEN"]}
breathe_default_project = "leapmap"
breathe_default_members = ("members",)
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_google_docstring = False
exclude_patterns = []
html_theme = "furo"
html_title = f"leapmap {release}"
html_static_path = []
html_copy_source = False
html_show_sphinx = False
pygments_style = "friendly"
