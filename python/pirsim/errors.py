"""Exceptions: one class for each way in which a call can fail, all with what was found and where."""

from __future__ import annotations

import enum

from .specs import Diagnostic

__all__ = [
    "Error", "ErrorCode", "FileError", "IncompleteWarning", "InfeasibleError", "InputError", "InputWarning",
    "InternalError", "UsageError",
]


class ErrorCode(enum.IntEnum):
    """What went wrong, as the exit code that the command line returns for it."""

    USAGE = 2
    INPUT = 3
    IO = 4
    INFEASIBLE = 5
    INCOMPLETE = 6
    INTERNAL = 70
    STOPPED = 75


class Error(Exception):
    """Whatever pirsim refuses to do. `str()` of it is all diagnostics, one a line."""

    code: ErrorCode
    """As the command line's exit code."""
    diagnostics: list[Diagnostic]
    """Every fault that was found, with file, line and column where they are known."""

    def __init__(self, code: ErrorCode, diagnostics: list[Diagnostic]) -> None:
        super().__init__(code, diagnostics)
        self.code = code
        self.diagnostics = diagnostics

    def __str__(self) -> str:
        return "\n".join(str(diagnostic) for diagnostic in self.diagnostics)


class UsageError(Error, ValueError):
    """An argument is wrong."""


class InputError(Error, ValueError):
    """A file was read, or a scene or script was given, and its content is refused."""


class FileError(Error):
    """A file can't be read or written."""


class InfeasibleError(Error):
    """The inputs are valid, but what they ask for can't be done: a seat that can't be reached."""


class InternalError(Error):
    """A fault of pirsim itself."""


class InputWarning(UserWarning):
    """What reading a file noticed and repaired or ignored, or an effect that changes nothing here."""


class IncompleteWarning(UserWarning):
    """Some runs could not go on: they have no rows, and `Result.faults` says why."""


_CLASSES: dict[ErrorCode, type[Error]] = {
    ErrorCode.USAGE: UsageError,
    ErrorCode.INPUT: InputError,
    ErrorCode.IO: FileError,
    ErrorCode.INFEASIBLE: InfeasibleError,
    ErrorCode.INTERNAL: InternalError,
}


def _exception(code: int, diagnostics: list[Diagnostic]) -> Error:
    """What the module raises."""
    known = ErrorCode(code)
    return _CLASSES.get(known, Error)(known, diagnostics)
