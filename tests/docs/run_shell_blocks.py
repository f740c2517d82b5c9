#!/usr/bin/env python3
"""Runs what the pages tell readers to type. Each page has a scratch folder of its own, with `data` in it and pirsim on
the path; its marked blocks are worked off in order:

  ```yaml file=study.yaml    is written to that file
  ```sh run                  runs, and must succeed
  ```sh run makes=a.md       the same; it must make the file of that name that lies beside the page
  ```text output             each line must be in what the last `run` printed, in this order
  ```sh tested by FILE       that test does what the block says
  ```sh not run: REASON      can't be tried here

A shell block without a word on how it is tested is a fault.

room.gltf and study.yaml of docs/howto/my_room.md are there from the beginning: readers of other pages have theirs.

Usage: run_shell_blocks.py PIRSIM SOURCE_DIRECTORY [PAGE...]
"""
import os
import pathlib
import subprocess
import sys
import tempfile

from pages import blocks, pages


def check_output(expected, printed, place):
    lines = iter(printed.splitlines())
    for line in expected.splitlines():
        assert line in lines, f"{place}: not printed in this order: {line}\n--- printed\n{printed}"


def write_file(block, folder):
    file = folder / block.info.removeprefix("file=")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(block.text, encoding="utf-8")


def check_made(names, page, folder, here):
    for name in names:
        assert (folder / name).read_bytes() == (page.parent / name).read_bytes(), f"{here}: {name} is another by now"


def run_page(page, place, folder, environment, source):
    """How many blocks were run."""
    ran, printed = 0, ""
    for block in blocks(page):
        here = f"{place}:{block.line}"
        if block.info.startswith("file="):
            write_file(block, folder)
        elif block.info.split(" makes=")[0] == "run":
            result = subprocess.run(["bash", "-euo", "pipefail", "-c", block.text], cwd=folder, env=environment,
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
            printed = result.stdout
            assert result.returncode == 0, f"{here}: exit code {result.returncode}\n{printed}"
            check_made(filter(None, block.info.partition(" makes=")[2].split(",")), page, folder, here)
            ran += 1
        elif block.info == "output":
            assert ran, f"{here}: nothing was run before"
            check_output(block.text, printed, here)
        elif block.info.startswith("tested by "):
            assert (source / block.info.removeprefix("tested by ")).is_file(), f"{here}: no such test"
        else:
            assert block.language == "sh" or not block.info, f"{here}: not known: {block.info}"
            assert block.language != "sh" or block.info.startswith("not run: "), f"{here}: how is this tested?"
    return ran


def main():
    pirsim, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    chosen = [pathlib.Path(page).resolve() for page in sys.argv[3:]] or pages(source)
    ran = 0
    for page in chosen:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name) / "work"
            folder.mkdir()
            (folder / "data").symlink_to(source / "data")
            for block in blocks(source / "docs/howto/my_room.md"):
                if block.info.startswith("file="):
                    write_file(block, folder)
            (pathlib.Path(name) / "bin").mkdir()
            (pathlib.Path(name) / "bin/pirsim").symlink_to(pirsim)
            environment = {**os.environ, "PATH": f"{name}/bin:{os.environ['PATH']}",
                           "PIRSIM_DATA_DIR": str(source / "data")}
            ran += run_page(page, page.relative_to(source), folder, environment, source)
    print(f"{ran} blocks of {len(chosen)} pages ran")
    assert ran >= len(sys.argv[3:]) and ran > 0


if __name__ == "__main__":
    main()
