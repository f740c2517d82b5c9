"""The package under the name that it has once it is installed, for the tests and the commands that they call."""

import os
import pathlib
import sys
import tempfile

_folder = tempfile.TemporaryDirectory()
os.symlink(pathlib.Path(__file__).parents[1] / "custom_components/pirsim/live", pathlib.Path(_folder.name) / "pirsim_live")
sys.path.insert(0, _folder.name)
os.environ["PYTHONPATH"] = os.pathsep.join([_folder.name, *filter(None, [os.environ.get("PYTHONPATH")])])


def pytest_configure(config):
    if config.pluginmanager.hasplugin("asyncio"):  # Home Assistant's harness brings it along
        config.option.asyncio_mode = "auto"
