"""Examples in docstrings, and the examples that are scripts."""
import doctest
import importlib
import os
import pathlib
import pkgutil
import subprocess
import sys

import pytest

import orchard_geometry

EXAMPLES = sorted((pathlib.Path(__file__).resolve().parents[1] / "examples").glob("*.py"))
MODULES = [module.name for module in pkgutil.iter_modules(orchard_geometry.__path__) if not module.ispkg]


@pytest.mark.parametrize("name", [name for name in MODULES if not name.startswith(("_construction", "_runtime"))])
def test_examples_of_docstrings(name):
    module = importlib.import_module("orchard_geometry." + name)
    failed, _ = doctest.testmod(module, optionflags=doctest.NORMALIZE_WHITESPACE)
    assert failed == 0


@pytest.mark.parametrize("name", sorted(set(orchard_geometry.__all__)))
def test_public_names_say_what_they_are(name):
    value = getattr(orchard_geometry, name)
    assert value.__doc__ and not value.__doc__.startswith("dict(")


def test_there_is_a_version():
    assert orchard_geometry.__version__.count(".") == 2
    assert "collide" in dir(orchard_geometry) and "medial_axis" in dir(orchard_geometry)
    with pytest.raises(AttributeError, match="orchid"):
        orchard_geometry.orchid


@pytest.mark.parametrize("script", EXAMPLES, ids=lambda script: script.name)
def test_examples_run(script, tmp_path, data):
    environment = dict(os.environ, MPLBACKEND="Agg")
    done = subprocess.run([sys.executable, script, "--quick", "--data", data, "--output", tmp_path], cwd=tmp_path,
                          env=environment, capture_output=True, text=True, timeout=600)
    if "No module named 'matplotlib'" in done.stderr:
        pytest.skip("matplotlib, which this example draws with, is not installed")
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip()
