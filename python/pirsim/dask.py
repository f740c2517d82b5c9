"""Shards of a study or a dataset on a dask.distributed cluster: `pip install pirsim[dask]`.

    from distributed import Client
    import pirsim.dask

    with Client("tcp://scheduler:8786") as client:
        pirsim.dask.run_study(client, "room.gltf", "study.yaml", "rows.csv", shards=200)

What is written has the bytes that one process writes. Work is handed out by shard. A task carries the names of its files
and their SHA-256, not their contents: every worker needs them at the same paths, as on a shared folder, and refuses a
file that differs. It needs the same build of pirsim too. What it made comes back as bytes, so that workers share no
folder that they write to. The scheduler gives the shard of a worker that is lost to another one.
"""

from __future__ import annotations

import functools
import hashlib
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import warnings
from dataclasses import dataclass
from typing import Any, Iterable

from . import __version__, git_revision, read_scene, read_script
from ._inputs import PathOr, Progress, as_file, keep_inputs, require_place, write
from .errors import Error, ErrorCode, IncompleteWarning, _exception
from .specs import Diagnostic, InputFile

__all__ = ["run_dataset", "run_study"]

_DIAGNOSTIC = re.compile(r"^(?:(?P<file>.+?)(?::(?P<line>\d+):(?P<column>\d+))?: )?"
                         r"(?P<severity>error|warning): (?P<text>.*)$", re.MULTILINE)


_MORE_THAN_ROOM_DAYS = 10**9
_MADE_FROM = ("version", "git_revision", "compiler", "embree", "seed", "study_runs", "inputs", "responses",
              "resolved_script")
"""Of a shard's manifest: docs/formats/rows.md."""


@dataclass(frozen=True)
class _Work:
    """What a worker needs to know of all shards."""

    arguments: tuple[str, ...]
    files: tuple[InputFile, ...]
    shards: int
    command: tuple[str, ...]  # or none: the command of the worker's own package
    build: str


def run_study(client: Any, scene: PathOr, script: PathOr, output: PathOr, *, shards: int,
              marks: PathOr | None = None, sensors: Iterable[PathOr] = (), arguments: Iterable[str] = (),
              command: Iterable[str] = (), progress: Progress | None = None) -> None:
    """Simulates a study on the workers of `client` and writes its rows.

    output: as `pirsim -o`; beside it a folder `<output>.shards` keeps the shards, and a call with shards in it simulates
    those that are missing alone. Shards of another study, seed, build or number of shards are refused, as `--resume`
    does. marks, sensors: as in `pirsim.compile`. arguments: further ones of the command,
    ["--set", "seed=2"]. command: how workers and
    this machine call pirsim, instead of the package's own. progress: called with the number of shards that are there,
    and of all. Throws what `pirsim.run` throws.
    """
    scene, script = as_file(scene, "rooms"), as_file(script, "studies")
    folders = [str(folder) for folder in sensors]
    files = [*read_script(script).files, *read_scene(scene, marks=marks, sensors=folders).files]
    given = [*_named("--marks", [str(marks)] if marks else []), *_named("--sensors", folders)]
    arguments = ["--scene", scene, "--script", script, *given, *arguments]
    work = _work(arguments, files, shards, command)
    keep_inputs([("output", output), ("the manifest of output", f"{output}.json")],
                [("the study", file.path) for file in files])
    require_place(output)
    folder = pathlib.Path(f"{output}.shards")
    there = _shards_there(work, folder)
    _make(client, work, [index for index in range(1, shards + 1) if index not in there], folder, progress)
    _call(work, ["merge", str(folder), "-o", str(output)])


def run_dataset(client: Any, recipe: PathOr, folder: PathOr, *, shards: int, sensors: Iterable[PathOr] = (),
                arguments: Iterable[str] = (), command: Iterable[str] = (), progress: Progress | None = None) -> None:
    """Makes a dataset on the workers of `client`; arguments as those of `run_study`. A folder of another dataset, or
    that has such files already, is refused as by `pirsim dataset`."""
    recipe = as_file(recipe, "recipes")
    arguments = ["dataset", recipe, *_named("--sensors", map(str, sensors)), *arguments]
    digest = hashlib.sha256(pathlib.Path(recipe).read_bytes()).hexdigest()
    work = _work(arguments, [InputFile(recipe, digest)], shards, command)
    # A shard to which no room-day falls: the command looks whether the folder is this dataset's, and claims it.
    _call(work, [*arguments, "-o", str(folder), "--shard", f"1/{_MORE_THAN_ROOM_DAYS}", "--quiet"])
    _make(client, work, range(1, shards + 1), pathlib.Path(folder), progress)
    _call(work, [*arguments, "-o", str(folder), "--finish", "--quiet"])


def _named(option: str, values: Iterable[str]) -> list[str]:
    return [word for value in values for word in (option, value)]


def _work(arguments: Iterable[str], files: Iterable[InputFile], shards: int, command: Iterable[str]) -> _Work:
    if shards < 1:
        raise _error(ErrorCode.USAGE, f"shards: expected 1 or more, got {shards}")
    return _Work(tuple(arguments), tuple(files), shards, tuple(command), f"{__version__} ({git_revision})")


def _shards_there(work: _Work, folder: pathlib.Path) -> set[int]:
    """Those that are whole. The command itself says whether the first of them is this study's (else InputError, or
    UsageError for another number of shards); the others must be made from what that one is."""
    there: dict[int, Any] = {}
    for manifest in sorted(folder.glob("shard-*.json")):
        try:
            tree = json.loads(manifest.read_text(encoding="utf-8"))
            index, made = int(tree["shard"]["index"]), {key: tree.get(key) for key in _MADE_FROM}
        except (KeyError, TypeError, ValueError):
            continue  # it is damaged, and made anew
        if not manifest.with_suffix("").exists():
            continue
        if not there:
            _call(work, [*work.arguments, "--shard", f"{min(index, work.shards)}/{work.shards}", "-o", str(folder),
                         "--resume", "--threads", "1", "--quiet"])
        elif made != next(iter(there.values())):
            raise _error(ErrorCode.INPUT, "isn't made from what the shards before it are: remove it", str(manifest))
        there[index] = made
    return set(there)


def _make(client: Any, work: _Work, missing: Iterable[int], folder: pathlib.Path, progress: Progress | None) -> None:
    """Has the missing shards simulated and puts what they made into the folder, file by file, manifests last."""
    from distributed import as_completed

    futures = client.map(functools.partial(_shard, work), list(missing), pure=False)
    there = work.shards - len(futures)
    try:
        for future in as_completed(futures):  # type: ignore[no-untyped-call,unused-ignore]
            for name, content in future.result().items():
                _put(folder / name, content)
            future.release()
            there += 1
            if progress:
                progress(there, work.shards)
    finally:
        client.cancel(futures)


def _put(file: pathlib.Path, content: bytes) -> None:
    if file.name == "provenance.txt" and file.read_bytes() != content:
        raise _error(ErrorCode.INPUT, "a worker made its part from other inputs", str(file))
    file.parent.mkdir(parents=True, exist_ok=True)
    write(file, content)


def _shard(work: _Work, index: int) -> dict[str, bytes]:
    """On a worker: simulates one shard. The files that it makes, by name; those that tell that others are whole last."""
    if work.build != f"{__version__} ({git_revision})":
        raise _error(ErrorCode.USAGE, f"this worker has pirsim {__version__} ({git_revision}), the client {work.build}")
    for file in work.files:
        path = pathlib.Path(file.path)
        if not path.is_file():
            raise _error(ErrorCode.IO, "this worker has no such file", file.path)
        if hashlib.sha256(path.read_bytes()).hexdigest() != file.sha256:
            raise _error(ErrorCode.INPUT, "this worker's file isn't the client's", file.path)
    with tempfile.TemporaryDirectory(prefix="pirsim_shard_") as made:
        _call(work, [*work.arguments, "--shard", f"{index}/{work.shards}", "-o", made, "--threads", "1", "--quiet"])
        files = sorted(path for path in pathlib.Path(made).rglob("*") if path.is_file())
        files.sort(key=lambda path: path.suffix == ".json")
        return {str(path.relative_to(made)): path.read_bytes() for path in files}


def _call(work: _Work, arguments: list[str]) -> None:
    done = subprocess.run([*(work.command or (sys.executable, "-m", "pirsim")), *arguments], capture_output=True,
                          text=True)
    if done.returncode == ErrorCode.INCOMPLETE:
        warnings.warn(done.stderr.strip(), IncompleteWarning, stacklevel=4)
    elif done.returncode != 0:
        raise _error(done.returncode, done.stderr.strip())


def _error(code: int, message: str, file: str = "") -> Error:
    diagnostics = [Diagnostic("warning" if found["severity"] == "warning" else "error", found["file"] or "",
                              int(found["line"] or 0), int(found["column"] or 0), found["text"])
                   for found in _DIAGNOSTIC.finditer(message)]
    known = code if code in list(ErrorCode) else ErrorCode.INTERNAL
    return _exception(known, diagnostics or [Diagnostic("error", file, 0, 0, message)])
