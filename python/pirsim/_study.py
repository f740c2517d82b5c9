"""Models, runs and recordings, and datasets of many rooms and days."""

from __future__ import annotations

import warnings
from typing import Any, Iterable, Mapping, NamedTuple, NoReturn, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._inputs import (Overrides, PathOr, Progress, as_count, as_file, as_input, as_overrides, as_path, as_scene,
                      as_seed, as_threads, as_whole, folders, warn_of)
from ._result import Result, make_result
from ._spec_parts import counted
from .errors import IncompleteWarning
from .specs import Effect, Scene, Script

EffectLike = Union[Effect, str, Mapping[str, Mapping[str, Any]]]


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

    scene: a glTF file, or a Scene. marks: a YAML file with marks for a scene's file that is left as it is. script: a
    YAML file, or a Script. set: values to replace in the script's file before it is read, by their place in it:
    {"people.0.stature_m": 1.7, "sensing.response": "analog"}. sensors: folders in which sensor models of a scene's file
    are looked for first; the shipped ones are always found.

    Raises InputError, with every fault and its place; InfeasibleError for a seat or point that can't be reached;
    FileError. What was repaired or ignored is an InputWarning.
    """
    core = _core.compile(as_scene(scene, marks), as_input(script, Script, set), as_overrides(set), folders(sensors))
    warn_of(core.warnings)
    return Model._of(core)


def handle_of(model: Model) -> _core.Model:
    if not isinstance(model, Model):
        raise TypeError(f"expected a pirsim.Model, which pirsim.compile(scene, script) makes, not a "
                        f"{type(model).__name__}")
    return model._handle


def run_number(model: Model, given: Any, name: str = "run") -> int:
    """Raises TypeError, and IndexError for a run that the study hasn't."""
    number = as_whole(given, name)
    if not 0 <= number < model.n_runs:
        raise IndexError(f"run {number}: the study has runs 0 to {model.n_runs - 1}")
    return number


def _run_numbers(model: Model, runs: int | Iterable[int] | None) -> list[int] | None:
    """None: all. The first number that isn't one is refused before the next one is looked at, and no more are taken
    than there are runs: a long or endless `runs` takes no memory."""
    if runs is None:
        return None
    if isinstance(runs, (str, bytes)):
        raise TypeError(f"runs: expected a number, a range or a list, got {runs!r}")
    numbers: list[int] = []
    for given in runs if isinstance(runs, Iterable) else [runs]:
        number = run_number(model, given, "runs")
        if len(numbers) == model.n_runs:
            raise ValueError(f"runs: more than the {model.n_runs} that the study has")
        numbers.append(number)
    return numbers


def run(model: Model, runs: int | Iterable[int] | None = None, *, threads: int = 0, zones: bool = False,
        signals: bool = False, occupants: bool = False, frames: bool = False,
        progress: Progress | None = None) -> Result:
    """Simulates runs of a study, all of them unless `runs` says which (a number, a range or a list).

    threads: 0 for all cores; never changes a byte of the result. zones, signals, occupants, frames: also what zones
    see, what analog sensors receive, who is where and what thermal arrays read (see Result); these take memory and time. progress: called with the number
    of runs done and of all runs, about ten times a second.

    Other Python threads run meanwhile; Ctrl-C ends it after the runs that have begun. A run that can't go on has no
    rows; `Result.faults` says why, and an IncompleteWarning that there are some.
    """
    arrays = _core.run(handle_of(model), _run_numbers(model, runs), as_threads(threads), zones, signals, occupants,
                       frames, progress)
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
        return make_result(_core.emit(handle_of(model), self._handle, listed, own, progress),
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
    core = _core.record(handle_of(model), _run_numbers(model, runs), as_threads(threads), progress)
    return Trace._of(core, model)


def dataset(recipe: PathOr, folder: PathOr, *, set: Overrides | None = None, resume: bool = False,
            sensors: PathOr | Iterable[PathOr] | None = None, threads: int = 0,
            progress: Progress | None = None) -> None:
    """Makes a dataset of many rooms and days from a recipe's YAML file (docs/formats/dataset.md).

    folder: gets a file of rows for each room and day, tables, datapackage.json and a README. set: values to replace in
    the recipe, {"sensing.response": "zones"}. resume: keeps the days that are there already, as after Ctrl-C. progress is
    told in days of rooms.
    """
    warn_of(_core.dataset(as_file(recipe, "recipes"), as_path(folder), as_overrides(set), folders(sensors), resume,
                          as_threads(threads), progress))


def room(recipe: PathOr, number: int, *, sensors: PathOr | Iterable[PathOr] | None = None) -> Scene:
    """Room `number` (from 1) of a dataset's recipe: always the same for the same recipe."""
    return _core.room(as_file(recipe, "recipes"), as_count(number, "number", -2**31, 2**31 - 1), folders(sensors))
