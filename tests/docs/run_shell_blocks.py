#!/usr/bin/env python3
"""Runs what the pages tell readers to type. Each page has a scratch folder of its own, with `data` in it and pirsim on
the path; its marked blocks are worked off in order:

  ```yaml file=study.yaml    is written to that file
  ```sh run                  runs, and must succeed
  ```sh run makes=a.md       the same; it must make the file of that name that lies beside the page
  ```sh run with A=B C=D     the same, with each A in it replaced by B: a smaller input, say
  ```text output             each line must be in what the last `run` printed, in this order
  ```sh tested by FILE       that test does what the block says, and names its programs and commands
  ```sh not run: REASON      can't be tried here
  ```yaml part of script     see read_examples.py

A shell block without a word on how it is tested is a fault, and so is a command in any other block.

room.gltf and study.yaml of docs/howto/my_room.md are there from the beginning: readers of other pages have theirs.

Usage: run_shell_blocks.py PIRSIM SOURCE_DIRECTORY [PAGE...]
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from pages import blocks, indented_lines, pages

COMMAND = re.compile(r"\s*((?:pirsim|cmake|pip|sbatch|python3?)(?= )|(?:tools|tests|examples)/[\w./]+)(?: (\w+)\b)?")

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


def commands(text):
    """Program and first word of each line that calls one: ("pirsim", "coverage"), ("pirsim", "")."""
    return [(match[1], match[2] or "") for match in map(COMMAND.match, text.splitlines()) if match]


def check_tested(block, source, here):
    test = source / block.info.removeprefix("tested by ")
    assert test.is_file(), f"{here}: no such test"
    text = test.read_text(encoding="utf-8")
    for program, word in commands(block.text):
        for part in [*program.split("/"), word]:
            assert part in text, f"{here}: {test.name} has no {part}"


def smaller(text, exchanges, here):
    """The block with each A=B exchanged."""
    for pair in exchanges.split():
        shown, tried = pair.split("=", 1)
        assert shown in text, f"{here}: there is no {shown} in the block"
        text = text.replace(shown, tried)
    return text


def run_page(page, place, folder, environment, source):
    """How many blocks were run."""
    ran, printed = 0, ""
    for number, text in indented_lines(page):
        assert not commands(text), f"{place}:{number}: a command that isn't in a block ```sh"
    for block in blocks(page):
        here = f"{place}:{block.line}"
        if block.info.startswith("file="):
            write_file(block, folder)
        elif re.fullmatch("run( makes=.*| with .*)?", block.info):
            text = smaller(block.text, block.info.partition(" with ")[2], here)
            result = subprocess.run(["bash", "-euo", "pipefail", "-c", text], cwd=folder, env=environment,
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=300)
            printed = result.stdout
            assert result.returncode == 0, f"{here}: exit code {result.returncode}\n{printed}"
            check_made(filter(None, block.info.partition(" makes=")[2].split(",")), page, folder, here)
            ran += 1
        elif block.info == "output":
            assert ran, f"{here}: nothing was run before"
            check_output(block.text, printed, here)
        elif block.info.startswith("tested by "):
            check_tested(block, source, here)
        elif not re.match("part of |not read: ", block.info):
            assert block.language == "sh" or not block.info, f"{here}: not known: {block.info}"
            assert block.language != "sh" or block.info.startswith("not run: "), f"{here}: how is this tested?"
            assert block.language in ("sh", "cpp") or not commands(block.text), f"{here}: a command, but no block ```sh"
    return ran


def main():
    pirsim, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    chosen = [pathlib.Path(page).resolve() for page in sys.argv[3:]] or pages(source)
    ran, faults = 0, []
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
            try:
                ran += run_page(page, page.relative_to(source), folder, environment, source)
            except AssertionError as fault:
                faults.append(str(fault))
    assert not faults, "\n\n".join(faults)
    print(f"{ran} blocks of {len(chosen)} pages ran")
    assert ran >= len(sys.argv[3:]) and ran > 0


if __name__ == "__main__":
    main()
