"""What the tests share: the bundled models, the program, and meshes that are fast to work on."""
import os
import pathlib
import shutil
import tempfile

import hypothesis
import pytest

# The same cases at every run, and nothing left where the tests are.
hypothesis.settings.register_profile("orchard", database=None, derandomize=True)
hypothesis.settings.load_profile("orchard")
hypothesis.configuration.set_hypothesis_home_dir(os.path.join(tempfile.gettempdir(), "orchard-hypothesis"))

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def data():
    return ROOT / "data"


@pytest.fixture(scope="session")
def program():
    """The command line program, for what is to be the same; skipped where it was not built."""
    found = os.environ.get("ORCHARD_PROGRAM") or shutil.which("orchard")
    if not found or not os.path.exists(found):
        pytest.skip("the program orchard was not built")
    return found


@pytest.fixture(scope="session")
def box():
    import orchard_geometry

    return orchard_geometry.box_mesh([1, 0.7, 0.4])


@pytest.fixture(scope="session")
def box_axis(box):
    import orchard_geometry

    return orchard_geometry.medial_axis(box, samples=300)


@pytest.fixture(scope="session")
def lamp(data):
    import orchard_geometry

    return orchard_geometry.load(data / "lamp.obj")


@pytest.fixture(scope="session")
def lamp_axis(lamp):
    import orchard_geometry

    return orchard_geometry.medial_axis(lamp, samples=1500)


@pytest.fixture(scope="session")
def lamp_tree(lamp):
    import orchard_geometry

    return orchard_geometry.sphere_tree(lamp, depth=2, effort="low")
