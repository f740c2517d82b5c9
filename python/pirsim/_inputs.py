"""What is handed over: arguments, names of files, scenes and scripts; and files that are written."""

from __future__ import annotations

import contextlib
import json
import operator
import os
import pathlib
import warnings
from typing import Any, Callable, Iterable, Literal, Mapping, NamedTuple, Sequence, Union

import numpy as np

from . import _core
from .errors import ErrorCode, FileError, InputWarning, UsageError
from .specs import Diagnostic, Frame, Point3, Scene, Script, SensorModel

PathOr = Union[str, "os.PathLike[str]"]
Progress = Callable[[int, int], Any]
"""Called about ten times a second with what is done and what there is to do."""
Overrides = Union[Mapping[str, Any], Sequence[str]]
"""{"people.0.stature_m": 1.7}, or as on the command line ["people.0.stature_m=1.7"]."""

data_directory: str = os.path.join(os.path.dirname(__file__), "data")
"""Rooms, studies, recipes and sensors that come with pirsim, as data/ in its source. Where a function takes a file, the
name of a shipped one will do: "meeting_room.gltf"."""


# -- arguments -------------------------------------------------------------------------------------------------------

def as_path(path: PathOr) -> str:
    """A file's name as the module takes it. Raises ValueError for a NUL, at which the system would cut it off."""
    name = os.fspath(path)
    if not isinstance(name, str):
        raise TypeError(f"expected the name of a file as a text, got {type(name).__name__}")
    if "\0" in name:
        raise ValueError(f"{name!r} can't be the name of a file: it has a NUL character")
    return name


def as_file(path: PathOr, kind: str) -> str:
    """A file's name, or where there is no such file that of the shipped one, of this kind ("rooms"). Raises
    FileError, with the nearest name."""
    return _core.find_file(as_path(path), kind, [data_directory])


def as_threads(threads: int) -> int:
    """No more of them than cores will begin, whatever the number."""
    return as_count(threads, "threads", 0, 2**32 - 1)


def as_whole(value: Any, name: str) -> int:
    """A whole number of any type. Raises TypeError, with the argument's name."""
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: expected a whole number, got a {type(value).__name__}") from None


def as_count(value: int, name: str, least: int, most: int) -> int:
    """The same from `least` to `most`. Raises TypeError and ValueError."""
    number = as_whole(value, name)
    if not least <= number <= most:
        raise ValueError(f"{name}: expected a whole number from {least} up to {most}, got {number}")
    return number


def as_number(value: float, name: str, least: float) -> float:
    """A number from `least` up. Raises ValueError."""
    number = float(value)
    if not least <= number < float("inf"):
        raise ValueError(f"{name}: expected a number from {least:g} up, got {value}")
    return number


def as_seed(seed: int) -> int:
    return as_count(seed, "seed", 0, 2**63 - 1)


def as_overrides(set: Overrides | None) -> list[str]:
    if set is None:
        return []
    if isinstance(set, str):
        raise TypeError("set: expected a dict, as {'people.0.stature_m': 1.7}, or a list of texts")
    if isinstance(set, Mapping):
        return [f"{key}={json.dumps(value, default=_plain, ensure_ascii=False)}" for key, value in set.items()]
    return list(set)


def _plain(value: Any) -> Any:
    """Of numpy's numbers and arrays, for JSON."""
    if isinstance(value, (np.generic, np.ndarray)):
        return value.tolist()
    raise TypeError(f"set: {value!r} can't be written as YAML")


def as_input(value: Any, kind: type, set: Overrides | None = None) -> Any:
    """A file's name as a text, which may be a shipped one's, or the object itself. kind: Scene, Script, or str for the
    file of a survey."""
    if kind is not str and isinstance(value, kind):
        if set:
            raise TypeError(f"set changes files; change the pirsim.{kind.__name__} itself")
        return value
    if not isinstance(value, (str, os.PathLike)):
        raise TypeError(f"expected the name of a file or a pirsim.{kind.__name__}, got a {type(value).__name__}")
    return as_file(value, "rooms" if kind is Scene else "studies")


def as_scene(scene: Any, marks: PathOr | None) -> Any:
    """A file's name, one with that of its marks, or the Scene itself."""
    if marks is None:
        return as_input(scene, Scene)
    if isinstance(scene, Scene):
        raise TypeError("marks: a pirsim.Scene has its own; read_scene(file, marks=...) adds those of a file")
    return as_input(scene, Scene), as_path(marks)


def folders(sensors: PathOr | Iterable[PathOr] | None) -> _core.Folders:
    """Where sensor models are looked for: there, and last in the shipped data."""
    if isinstance(sensors, (str, os.PathLike)):
        sensors = [sensors]
    return _core.Folders([as_path(folder) for folder in sensors or ()], [data_directory])


def warn_of(remarks: Iterable[Any]) -> None:
    """An InputWarning each, told where the function was called that calls this one."""
    for remark in remarks:
        warnings.warn(str(remark), InputWarning, stacklevel=3)


# -- files that are written ------------------------------------------------------------------------------------------

def write(file: PathOr, content: str | bytes) -> None:
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


Named = Iterable["tuple[str, PathOr]"]
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


def require_place(file: PathOr) -> None:
    """Raises FileError for a file that is a folder, or whose folder isn't there."""
    folder = os.path.dirname(file) or "."
    why = "it is a folder" if os.path.isdir(file) else f"there is no folder '{folder}'"
    if os.path.isdir(file) or not os.path.isdir(folder):
        raise FileError(ErrorCode.IO, [Diagnostic("error", os.fspath(file), 0, 0, f"can't write: {why}")])


def _is_one_file(one: PathOr, other: PathOr) -> bool:
    is_there = os.path.exists(one)
    if is_there != os.path.exists(other):
        return False
    return os.path.samefile(one, other) if is_there else os.path.realpath(one) == os.path.realpath(other)


# -- scenes, scripts, sensors and effects ----------------------------------------------------------------------------

class EffectParameter(NamedTuple):
    """A parameter of an effect. least, most: what is accepted; off: with all at it nothing happens."""

    name: str
    unit: str
    off: float
    typical: float
    least: float
    most: float
    source: str


class EffectInfo(NamedTuple):
    """An entry of the catalogue of effects."""

    name: str
    family: str
    summary: str
    reach: Literal["geometry", "triggers", "rows"]
    """Those that reach the geometry need a model of their own; the others can be emitted from a trace."""
    parameters: tuple[EffectParameter, ...]
    choices: tuple[str, ...]

    def __repr__(self) -> str:
        settings = ", ".join([parameter.name for parameter in self.parameters] + list(self.choices))
        return f"<pirsim.EffectInfo {self.name!r} ({self.family}, reaches {self.reach}): {settings}>"


def read_scene(file: PathOr, *, sensors: PathOr | Iterable[PathOr] | None = None,
               marks: PathOr | None = None) -> Scene:
    """Reads a glTF file. Raises FileError and InputError. sensors, marks: as in compile()."""
    return _core.read_scene(as_scene(as_path(file), marks), folders(sensors))


def read_script(file: PathOr, *, set: Overrides | None = None) -> Script:
    """Reads a script's YAML file, with trials and people written out. Raises FileError and InputError."""
    return _core.read_script(as_file(file, "studies"), as_overrides(set), folders(None))


def write_scene(scene: Scene, file: PathOr) -> None:
    """Writes a scene as glTF (.glb, or .gltf with its buffer in it); positions in single precision."""
    _core.write_scene(scene, as_path(file))


def write_script(script: Script, file: PathOr) -> None:
    """Writes a script as YAML for the command line."""
    write(file, _core.to_yaml(script))


def sensor_model(name: PathOr, *, sensors: PathOr | Iterable[PathOr] | None = None) -> SensorModel:
    """A sensor model by its name ("EKMC1604111"), or from a file (.yaml)."""
    if (text := as_path(name)).endswith(".yaml"):
        return _core.read_sensor_model(as_file(text, "sensors"))
    return _core.find_sensor_model(text, folders(sensors))


def facing(position: Point3, heading_deg: float = 0.0, tilt_deg: float = 0.0) -> Frame:
    """The frame of something at a place (metres) that faces a heading: 0 along -Z, positive turning left (seen from
    above). tilt_deg: downwards, as of a sensor on a wall."""
    return _core.mounted(position, heading_deg, tilt_deg)


def effects() -> list[EffectInfo]:
    """What a script's effects can be, in the order in which they act."""
    return [EffectInfo(name, family, summary, reach, tuple(EffectParameter(*p) for p in parameters), tuple(choices))
            for name, family, summary, reach, parameters, choices in _core.catalogue()]
