"""Files that are written: whole or not at all, and none in the place of one that was read."""

from __future__ import annotations

import contextlib
import os
import pathlib
from typing import Iterable, Union

from .errors import ErrorCode, FileError, UsageError
from .specs import Diagnostic

Path = Union[str, "os.PathLike[str]"]


def write(file: Path, content: str | bytes) -> None:
    """Puts a file in its place, or leaves the one that is there; text is UTF-8. A link is followed; what isn't a file,
    as /dev/stdout, is written to. Raises OSError."""
    data = content.encode() if isinstance(content, str) else content
    path = pathlib.Path(os.path.realpath(file))
    if path.exists() and not path.is_file():
        with open(file, "wb") as out:
            out.write(data)
        return
    partial = path.with_name(f"{path.name}.writing-{os.getpid()}-{os.urandom(4).hex()}")
    try:
        with open(partial, "xb") as out:
            out.write(data)
        os.replace(partial, path)
    except BaseException:
        with contextlib.suppress(OSError):
            partial.unlink()
        raise


Named = Iterable["tuple[str, Path]"]
"""Arguments or options, each with its file."""


def keep_inputs(outputs: Named, inputs: Named) -> None:
    """Before any work: raises UsageError for an output that is an input or another output, by whatever names."""
    taken = [(name, file) for name, file in inputs if os.path.isfile(file)]  # nothing else is written over
    for name, file in outputs:
        for other, there in taken:
            if _is_one_file(file, there):
                raise UsageError(ErrorCode.USAGE,
                                 [Diagnostic("error", "", 0, 0, f"{other} and {name} are one file: '{file}'")])
        if os.fspath(file) != os.devnull:
            taken.append((name, file))


def require_place(file: Path) -> None:
    """Raises FileError for a file that is a folder, or whose folder isn't there."""
    folder = os.path.dirname(file) or "."
    why = "it is a folder" if os.path.isdir(file) else f"there is no folder '{folder}'"
    if os.path.isdir(file) or not os.path.isdir(folder):
        raise FileError(ErrorCode.IO, [Diagnostic("error", os.fspath(file), 0, 0, f"can't write: {why}")])


def _is_one_file(one: Path, other: Path) -> bool:
    is_there = os.path.exists(one)
    if is_there != os.path.exists(other):
        return False
    return os.path.samefile(one, other) if is_there else os.path.realpath(one) == os.path.realpath(other)
