"""What the tests of the Python package share. PIRSIM names the command line's program, which they are compared with;
without it (an installed wheel is being tried) those tests are left out. PIRSIM_SOURCE is the source tree."""

import os
import pathlib
import subprocess

import pytest

import pirsim

SOURCE = pathlib.Path(os.environ.get("PIRSIM_SOURCE", pathlib.Path(__file__).resolve().parents[2]))


@pytest.fixture(scope="session")
def data():
    return SOURCE / "data"


@pytest.fixture(scope="session")
def source():
    return SOURCE


@pytest.fixture(scope="session")
def room(data):
    return data / "rooms" / "meeting_room.gltf"


@pytest.fixture(scope="session")
def study_a(data):
    return data / "studies" / "studyA.yaml"


@pytest.fixture(scope="session")
def recipe():
    """The least that has all of a dataset, in two seconds."""
    return SOURCE / "tests" / "support" / "short_recipe.yaml"


@pytest.fixture(scope="session")
def dataset(data, tmp_path_factory):
    """With all four parts, made once for all who only read it."""
    folder = tmp_path_factory.mktemp("datasets") / "tiny"
    pirsim.dataset(data / "recipes" / "tiny.yaml", folder)
    return folder


@pytest.fixture(scope="session")
def command():
    """Calls the command line; returns what it printed."""

    def call(*args, code=0):
        done = subprocess.run([os.environ["PIRSIM"], *map(str, args)], capture_output=True, text=True)
        assert done.returncode == code, done.stderr
        return done.stdout

    return call


def pytest_configure(config):
    config.addinivalue_line("markers", "slow: only tools/check --all runs it")


def pytest_collection_modifyitems(config, items):
    if "PIRSIM" in os.environ:
        return
    compared = [item for item in items if "command" in item.fixturenames]
    items[:] = [item for item in items if item not in compared]
    config.hook.pytest_deselected(items=compared)
