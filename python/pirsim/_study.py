"""Models, runs and recordings."""

from __future__ import annotations

import json
import operator
import os
import warnings
from typing import Any, Callable, Iterable, Mapping, NamedTuple, NoReturn, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._result import Result, make_result
from .errors import IncompleteWarning, InputWarning
from ._spec_parts import counted
from .specs import Effect, Scene, Script

PathOr = Union[str, "os.PathLike[str]"]
Progress = Callable[[int, int], Any]
"""Called about ten times a second with what is done and what there is to do."""
Overrides = Union[Mapping[str, Any], Sequence[str]]
"""{"people.0.stature_m": 1.7}, or as on the command line ["people.0.stature_m=1.7"]."""
EffectLike = Union[Effect, str, Mapping[str, Mapping[str, Any]]]

data_directory: str = os.path.join(os.path.dirname(__file__), "data")
"""Rooms, studies, recipes and sensors that come with pirsim, as data/ in its source. Where a function takes a file, the
name of a shipped one will do: "meeting_room.gltf"."""


class Poses(NamedTuple):
    """Names, places and directions of view of sensors or seats."""

    names: tuple[str, ...]
    position_m: npt.NDArray[np.float64]
    """[item, 3] (x, y, z), metres."""
    forward: npt.NDArray[np.float64]
    """[item, 3] unit vectors."""

    def __repr__(self) -> str:
        return f"<pirsim.Poses of {counted(self.names, 'thing', 'things')}>"


class Rays(NamedTuple):
    """All rays of all sensors, world frame, cut at the room."""

    origin: npt.NDArray[np.float32]
    """[ray, 3] metres."""
    direction: npt.NDArray[np.float32]
    """[ray, 3] unit vectors."""
    range_m: npt.NDArray[np.float32]
    """[ray] how far it sees."""
    zone: npt.NDArray[np.uint32]
    """[ray] as in `Result.zones`."""
    sensor: npt.NDArray[np.uint32]
    """[ray] index into the sensors."""

    def __repr__(self) -> str:
        return (f"<pirsim.Rays: {len(self.range_m)} rays of {len(np.unique(self.zone))} zones and "
                f"{len(np.unique(self.sensor))} sensors, up to {self.range_m.max(initial=0.0):.1f} m>")


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


def as_count(value: int, name: str, least: int, most: int) -> int:
    """A whole number of any type. Raises TypeError and ValueError, with the argument's name."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name}: expected a whole number, got a {type(value).__name__}") from None
    if not least <= number <= most:
        raise ValueError(f"{name}: expected a whole number from {least} up to {most}, got {number}")
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


def folders(sensors: PathOr | Iterable[PathOr] | None) -> tuple[list[str], list[str]]:
    """Where sensor models are looked for first, and last."""
    if sensors is None:
        return [], [data_directory]
    if isinstance(sensors, (str, os.PathLike)):
        sensors = [sensors]
    return [as_path(folder) for folder in sensors], [data_directory]


def as_effect(effect: EffectLike) -> Effect:
    if isinstance(effect, Effect):
        return effect
    if isinstance(effect, str):
        return Effect(effect)
    if not isinstance(effect, Mapping) or len(effect) != 1:
        raise TypeError("effects: expected pirsim.Effect, a name, or a dict like {'dead_time': {'dead_s': 2}}")
    (name, settings), = effect.items()
    settings = settings or {}
    return Effect(name, {key: value for key, value in settings.items() if not isinstance(value, str)},
                  {key: value for key, value in settings.items() if isinstance(value, str)})


def _refuse_pickling(self: Any) -> NoReturn:
    raise TypeError(f"a pirsim.{type(self).__name__} can't be pickled: pickle its scene and script (or their file "
                    "names) and compile them where they are needed; threads can share it as it is")


class Model:
    """A study compiled for running. Immutable: threads can share it. `pirsim.compile()` makes one."""

    __slots__ = ("_handle", "__weakref__")
    _handle: _core.Model

    def __init__(self) -> None:
        raise TypeError("pirsim.compile() makes a Model")

    @classmethod
    def _of(cls, core: _core.Model) -> Model:
        model = object.__new__(cls)
        model._handle = core
        return model

    @property
    def n_runs(self) -> int:
        """Runs are numbered from 0, replicate by replicate, trials in order within each."""
        return self._handle.n_runs

    @property
    def seed(self) -> int:
        """From which all random numbers come."""
        return self._handle.seed

    @property
    def tick_s(self) -> float:
        """Length of a simulation step, seconds."""
        return self._handle.tick_s

    @property
    def trials(self) -> tuple[str, ...]:
        """Names, in order."""
        return self._handle.trials

    @property
    def areas(self) -> tuple[str, ...]:
        """Ids of the scene's areas, then `elsewhere` if some of the floor is in none."""
        return self._handle.areas

    @property
    def doors(self) -> tuple[str, ...]:
        """Ids of the scene's doors."""
        return self._handle.doors

    @property
    def sensors(self) -> Poses:
        """Of the scene as given, in the order of the last axis of `Result.bits`."""
        return Poses(*self._handle.sensors)

    @property
    def seats(self) -> Poses:
        """Of the scene as given: where the sitter's pelvis rests and where it faces."""
        return Poses(*self._handle.seats)

    @property
    def rays(self) -> Rays:
        """Of all sensors, with every effect applied."""
        return Rays(*self._handle.rays)

    @property
    def scene(self) -> Scene:
        """A copy of the scene as it was given."""
        return self._handle.scene()

    @property
    def script(self) -> Script:
        """A copy of the script as it was given."""
        return self._handle.script()

    def runs_of(self, trial: str) -> range:
        """Numbers of all runs of a trial, replicate by replicate."""
        if trial not in self.trials:
            raise KeyError(f"there is no trial {trial!r}; there are {', '.join(self.trials[:20])}")
        return range(self.trials.index(trial), self.n_runs, len(self.trials))

    def __repr__(self) -> str:
        return (f"<pirsim.Model: {self.n_runs} runs of {counted(self.trials, 'trial', 'trials')}, "
                f"{counted(self.sensors.names, 'sensor', 'sensors')}, {self.tick_s:g} s a tick, seed {self.seed}>")

    __reduce__ = _refuse_pickling


def compile(scene: PathOr | Scene, script: PathOr | Script, *, set: Overrides | None = None,
            sensors: PathOr | Iterable[PathOr] | None = None, marks: PathOr | None = None) -> Model:
    """Validates a scene and a script and makes a Model of them.

    scene: a glTF file, or a Scene. marks: a YAML file with marks for a scene's file that is left as it is. script: a YAML file, or a Script. set: values to replace in the script's file
    before it is read, by their place in it: {"people.0.stature_m": 1.7, "sensing.response": "analog"}. sensors:
    folders in which sensor models of a scene's file are looked for first; the shipped ones are always found.

    Raises InputError, with every fault and its place; InfeasibleError for a seat or point that can't be reached;
    FileError. What was repaired or ignored is an InputWarning.
    """
    core = _core.compile(as_scene(scene, marks), as_input(script, Script, set), as_overrides(set), *folders(sensors))
    for diagnostic in core.warnings:
        warnings.warn(str(diagnostic), InputWarning, stacklevel=2)
    return Model._of(core)


def _handle_of(model: Model) -> _core.Model:
    if not isinstance(model, Model):
        raise TypeError(f"expected a pirsim.Model, which pirsim.compile(scene, script) makes, not a "
                        f"{type(model).__name__}")
    return model._handle


def _run_numbers(model: Model, runs: int | Iterable[int] | None) -> list[int] | None:
    """None: all. The first number that isn't one is refused before the next one is looked at, and no more are taken
    than there are runs: a long or endless `runs` takes no memory."""
    if runs is None:
        return None
    if isinstance(runs, (str, bytes)):
        raise TypeError(f"runs: expected a number, a range or a list, got {runs!r}")
    numbers: list[int] = []
    n_runs = model.n_runs
    for given in runs if isinstance(runs, Iterable) else [runs]:
        try:
            number = operator.index(given)
        except TypeError:
            raise TypeError(f"runs: expected whole numbers, got {given!r}") from None
        if not 0 <= number < n_runs:
            raise IndexError(f"run {number}: the study has runs 0 to {n_runs - 1}")
        if len(numbers) == n_runs:
            raise ValueError(f"runs: more than the {n_runs} that the study has")
        numbers.append(number)
    return numbers


def run(model: Model, runs: int | Iterable[int] | None = None, *, threads: int = 0, zones: bool = False,
        signals: bool = False, occupants: bool = False, progress: Progress | None = None) -> Result:
    """Simulates runs of a study, all of them unless `runs` says which (a number, a range or a list).

    threads: 0 for all cores; never changes a byte of the result. zones, signals, occupants: also what zones see, what
    analog sensors receive and who is where (see Result); these take memory and time. progress: called with the number
    of runs done and of all runs, about ten times a second.

    Other Python threads run meanwhile; Ctrl-C ends it after the runs that have begun. A run that can't go on has no
    rows; `Result.faults` says why, and an IncompleteWarning that there are some.
    """
    arrays = _core.run(_handle_of(model), _run_numbers(model, runs), as_threads(threads), zones, signals, occupants,
                       progress)
    result = make_result(arrays, model.sensors.names, model.areas, model.doors, model.seed)
    if result.faults:
        first = result.faults[0]
        warnings.warn(f"{len(result.faults)} runs could not go on and have no rows; run {first.run} at second "
                      f"{first.time_s:g}: {first.text}", IncompleteWarning, stacklevel=2)
    return result


class Trace:
    """What the optics showed in some runs, from which rows are made with other electronics and seeds: see trace()."""

    __slots__ = ("_handle", "_model")
    _handle: _core.Recording
    _model: Model

    def __init__(self) -> None:
        raise TypeError("pirsim.trace() makes a Trace")

    @classmethod
    def _of(cls, core: _core.Recording, model: Model) -> Trace:
        trace = object.__new__(cls)
        trace._handle = core
        trace._model = model
        return trace

    @property
    def n_runs(self) -> int:
        """Of the runs that were followed."""
        return self._handle.n_runs

    def emit(self, *, model: Model | None = None, effects: Iterable[EffectLike] | None = None,
             seed: int | None = None, progress: Progress | None = None) -> Result:
        """The rows of all followed runs. Without arguments they are the study's, bit for bit.

        model: compiled with other electronics in its sensors (threshold, band, noise, pulses, hold, blind time) or
        another script's effects; without it the one that was followed. Its people aren't asked: they did what was
        followed. Raises UsageError if its room, seats, sensors' places, lenses or responses, or its
        ticks are others.
        effects: on triggers and rows, instead of those of the model's script: `Effect`s, names, or dicts as in a
        script's file, {"dead_time": {"dead_s": 2}}; effects that change what the optics show are refused, they need a
        trace of their own. seed: instead of the model's, of the analog sensors' noise and of what effects draw.
        """
        if model is None:
            model = self._model
        listed = None if effects is None else [as_effect(effect) for effect in effects]
        own = None if seed is None else as_seed(seed)
        return make_result(_core.emit(_handle_of(model), self._handle, listed, own, progress),
                           model.sensors.names, model.areas, model.doors,
                           model.seed if own is None else own)

    def __repr__(self) -> str:
        return f"<pirsim.Trace of {self.n_runs} runs>"

    __reduce__ = _refuse_pickling


def trace(model: Model, runs: int | Iterable[int] | None = None, *, threads: int = 0,
          progress: Progress | None = None) -> Trace:
    """Follows people and rays once, so that `emit()` gives rows with other effects and seeds without doing so again.

    It holds what each sensor's response needs, zones or the power that arrives, each different moment once. Arguments
    as of run().
    """
    core = _core.record(_handle_of(model), _run_numbers(model, runs), as_threads(threads), progress)
    return Trace._of(core, model)
