# SPDX-License-Identifier: GPL-3.0-or-later
"""Every public name of the module is documented after numpydoc, and its examples print what they say."""
import doctest
import inspect
import re

import numpy as np
import pytest

import leapmap

FUNCTIONS = [name for name in leapmap.__all__ if inspect.isfunction(getattr(leapmap, name))]
CLASSES = [name for name in leapmap.__all__ if inspect.isclass(getattr(leapmap, name))]


def sections(text):
    return re.findall(r"^\s*(\w+)\n\s*-{3,}$", text, re.M)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_document_their_arguments_results_and_errors(name):
    function = getattr(leapmap, name)
    text = inspect.getdoc(function)
    assert text.splitlines()[0].endswith("."), "a summary on one line"
    assert "Returns" in sections(text) or name == "use_instruction_set"
    wanted = [p.name for p in inspect.signature(function).parameters.values() if p.kind is not p.VAR_KEYWORD]
    documented = re.findall(r"^(\w[\w, ]*) : ", text, re.M)
    documented = {one for names in documented for one in names.split(", ")}
    assert set(wanted) <= documented, set(wanted) - documented
    if name not in ("phase_letters", "instruction_set", "instruction_sets"):
        assert "Raises" in sections(text)


@pytest.mark.parametrize("name", CLASSES)
def test_classes_and_their_methods_are_documented(name):
    one = getattr(leapmap, name)
    assert one.__doc__.strip()
    for method, value in vars(one).items():
        if (
            not method.startswith("_")
            and (inspect.isfunction(value) or isinstance(value, property))
            and name not in ("Estimate", "Status")
        ):
            assert inspect.getdoc(value), f"{name}.{method}"


def test_the_examples_print_what_they_say():
    finder = doctest.DocTestFinder(recurse=False)
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE)
    ran = 0
    for name, one in [("leapmap", leapmap), *((n, getattr(leapmap, n)) for n in leapmap.__all__)]:
        for test in finder.find(one, name, module=leapmap, globs={"leapmap": leapmap, "np": np}):
            ran += len(test.examples)
            assert runner.run(test).failed == 0, name
    assert ran > 15
