#!/usr/bin/env python3
"""Types the README's section "Build it" in one shell, from tools/demo to the rows. The demo is the real one, but what it
would install and build is there already: PIRSIM stands in build/dev, and cmake, tools/install_deps and tools/check
do nothing.

Usage: run_readme.py PIRSIM SOURCE_DIRECTORY
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from pages import blocks
from run_shell_blocks import check_output

DOES_NOTHING = "#!/bin/sh\n"


def script(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    path.chmod(0o755)


def clone(folder, pirsim, source):
    """What a fresh clone holds after its build, as far as the README needs it."""
    (folder / "tools").mkdir(parents=True)
    shutil.copy(source / "tools/demo", folder / "tools/demo")
    for name in ("install_deps", "check"):
        script(folder / "tools" / name, DOES_NOTHING)
    (folder / "data").symlink_to(source / "data")
    (folder / "build/dev").mkdir(parents=True)
    (folder / "build/dev/pirsim").symlink_to(pirsim)


def main():
    pirsim, source = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    begin, end = lines_of_section(source, "## Build it")
    section = [block for block in blocks(source / "README.md") if begin < block.line < end]
    typed = "".join(block.text for block in section if block.language == "sh")
    [expected] = [block.text for block in section if block.info == "output"]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name) / "pirsim"
        clone(folder, pirsim, source)
        script(pathlib.Path(name) / "bin/cmake", DOES_NOTHING)
        path = f"{name}/bin:/usr/local/bin:/usr/bin:/bin"
        assert shutil.which("pirsim", path=path) is None, "pirsim is installed here: that would hide a missing path"
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", typed], cwd=folder, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=600, env={**os.environ, "PATH": path})
        assert done.returncode == 0, done.stdout
        check_output(expected, done.stdout, "README.md")
        told = re.findall(r"^  (out/\S+)", done.stdout, re.M)
        assert len(told) >= 5, done.stdout
        for file in told:
            assert (folder / file).stat().st_size > 0, f"tools/demo names {file}, which isn't there"
        assert f'export PATH="{folder}/build/dev:$PATH"' in done.stdout, "the demo tells another path than the README"
    print(f"the README's first commands: {len(told)} files of tools/demo, and the rows")


def lines_of_section(source, heading):
    lines = (source / "README.md").read_text(encoding="utf-8").splitlines()
    begin = lines.index(heading)
    return begin + 1, begin + 1 + next(i for i, line in enumerate(lines[begin + 1:], start=1) if line.startswith("## "))


if __name__ == "__main__":
    main()
