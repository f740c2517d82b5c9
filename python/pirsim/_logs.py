"""Logs of real sensors, as arrays, and what lights cost that sensors switch."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Iterable, Literal, Mapping, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core
from ._inputs import PathOr, as_path, warn_of
from ._result import Result
from ._study import Model, handle_of

if TYPE_CHECKING:
    import pandas


class LogLengths(NamedTuple):
    """How long motion, or pauses between motion, last; seconds."""

    n: int
    floor: float
    """One in a hundred doesn't reach it. Of pauses a sensor's dead time, if `floor_share` is large."""
    floor_share: float
    """Of all, from there to a tenth longer."""
    shortest: float
    q05: float
    q25: float
    median: float
    q75: float
    q95: float
    longest: float


class LogSensor(NamedTuple):
    """What a log tells of one sensor."""

    name: str
    motion_share: float | None
    """Of the known time."""
    known_s: float
    unknown_s: float
    pulses: LogLengths
    pauses: LogLengths
    motion_by_hour: tuple[float | None, ...]
    """[hour] share of the known time, by local hour of the day."""
    false_triggers: int | None
    """Motion that begins where there should be none (docs/formats/log.md); None if the log doesn't tell."""
    false_trigger_hours: float
    hold_s: float | None
    """How long it holds motion, if events tell it; docs/formats/log.md."""


class LogPair(NamedTuple):
    """How much alike two sensors are."""

    a: str
    b: str
    phi: float | None
    b_after_a_s: float | None
    n_together: int
    has_leader: bool


@dataclass(frozen=True, eq=False)
class Log:
    """Windows of a log of real sensors, one after the other, also those in which nothing is known. All arrays are
    read-only."""

    sensors: tuple[str, ...]
    """Names, in the order of the last axis of `motion`."""
    motion: npt.NDArray[np.uint8]
    """[window, sensor] 1 if any motion is in the window, 0 if it is known throughout and none is, 2 if unknown."""
    people: npt.NDArray[np.int32] | None
    """[window] at the window's end, -1 if unknown; None if the log has no count."""
    time: npt.NDArray[np.datetime64]
    """[window] local wall-clock time at its end; of a log of elapsed seconds since 1970."""
    utc: npt.NDArray[np.datetime64] | None
    """[window] the same in UTC; None if the log tells no time zone."""
    time_s: npt.NDArray[np.float64]
    """[window] its end, seconds since the first window began; of a log of elapsed seconds its own."""
    window_s: float
    interval_s: float
    """Between readings; 0 if the log has events."""
    map: str
    """YAML: the map by which it was read, with what was found."""
    facts: tuple[LogSensor, ...] = field(repr=False)
    """[sensor] what the log tells of it."""
    pairs: tuple[LogPair, ...] = field(repr=False)
    """The most alike first."""
    _files: tuple[PathOr, ...] = field(default=(), repr=False)
    """That it was read from."""

    def __repr__(self) -> str:
        shares = ", ".join(f"{one.name} {100 * (one.motion_share or 0):.1f} %" for one in self.facts[:8])
        more = ", ..." if len(self.facts) > 8 else ""
        unknown = 100 * float((self.motion == 2).mean()) if self.motion.size else 0.0
        return (f"<pirsim.Log: {len(self.motion)} windows of {self.window_s:g} s, {self.time[0]} to {self.time[-1]}\n"
                f"  motion {list(self.motion.shape)}: {shares}{more}; {unknown:.1f} % unknown"
                + ("" if self.people is None else f"\n  people 0 to {int(self.people.max(initial=0))}") + ">")

    @cached_property
    def masked(self) -> np.ma.MaskedArray[Any, Any]:
        """[window, sensor] `motion` with what is unknown masked: `log.masked.mean(axis=0)` is the share of motion."""
        return np.ma.masked_equal(self.motion, 2)

    def to_pandas(self) -> pandas.DataFrame:
        """A row a window, with the columns of the command line's CSV; what is unknown is missing (pandas.NA)."""
        import pandas as pd

        columns: dict[str, Any] = {"time_s": self.time_s}
        if not self.is_elapsed:
            columns["time"] = self.time
        if self.people is not None:
            columns["people"] = pd.arrays.IntegerArray(self.people.copy(), self.people < 0)
        for i, name in enumerate(self.sensors):
            columns[name] = pd.arrays.IntegerArray(self.motion[:, i].copy(), self.motion[:, i] == 2)
        return pd.DataFrame(columns)

    people_means: Literal["count", "presence"] = field(default="count", repr=False)
    """What `people` tells: how many are there, or 1 if anybody is."""
    is_elapsed: bool = field(default=False, repr=False)
    """The log tells seconds since something began, and no clock."""


def read_log(file: PathOr | Iterable[PathOr], map: PathOr | Mapping[str, Any] | None = None, *,
             window_s: float = 30.0) -> Log:
    """Reads a log of real motion sensors, as `pirsim log`: docs/formats/log.md.

    file: one, or several that are parts of one log. map: what its columns mean, a YAML file or a dict with the same keys,
    {"time_zone": "Europe/Berlin", "sensors": {"PIR1": "binary_sensor.hall_motion"}}; without one what is found is taken.
    window_s: length of the windows. Raises FileError and InputError; what is odd is an InputWarning.
    """
    files = [file] if isinstance(file, (str, bytes)) or hasattr(file, "__fspath__") else list(file)
    keys = json.dumps({"pirsim_log": 1, **map}) if isinstance(map, Mapping) else ""
    map_files = [] if map is None or isinstance(map, Mapping) else [map]
    found = _core.read_log([as_path(one) for one in files], as_path(map_files[0]) if map_files else "", keys,
                           float(window_s))
    warn_of(found["remarks"])
    utc_us, is_elapsed = found["utc_us"], found["clock"] == "elapsed"
    zero_us = 0 if is_elapsed or not len(utc_us) else int(utc_us[0]) - round(1e6 * found["window_s"])
    arrays = {"time": found["local_us"].view("datetime64[us]"), "time_s": (utc_us - zero_us) / 1e6}
    if found["clock"] == "zoned":
        arrays["utc"] = utc_us.view("datetime64[us]")
    for array in arrays.values():
        array.flags.writeable = False
    facts = tuple(LogSensor(name, share, known, unknown, LogLengths(*pulses), LogLengths(*pauses), *rest)
                  for name, share, known, unknown, pulses, pauses, *rest in found["facts"])
    return Log(sensors=found["sensors"], motion=found["motion"], people=found["people"], time=arrays["time"],
               utc=arrays.get("utc"), time_s=arrays["time_s"], window_s=found["window_s"], interval_s=found["interval_s"],
               map=found["map"], facts=facts, pairs=tuple(LogPair(*pair) for pair in found["pairs"]),
               people_means=found["people_means"], is_elapsed=is_elapsed,
               _files=tuple(os.path.abspath(one) for one in [*files, *map_files]))


# -- light -----------------------------------------------------------------------------------------------------------

@dataclass(frozen=True, eq=False)
class LightCosts:
    """What lights cost at every delay, and when they are lit. All arrays are read-only."""

    lights: tuple[str, ...]
    columns: dict[str, npt.NDArray[Any]]
    """[light and delay] `light`, `delay_min`, `false_offs_an_hour`, `dark_share`, `lit_h` and so on, those of `pirsim
    control -o`, unrounded; NaN where nothing is known."""
    lit: npt.NDArray[np.uint8]
    """[run, second, light] 1 where it is lit, by the light's first delay; 0 behind the end of a run."""

    def __repr__(self) -> str:
        lines = [f"<pirsim.LightCosts: {', '.join(self.lights)}"]
        for light in self.lights:
            for delay in (1, 5, 10, 20):
                at = self.at(delay, light)
                lines.append(f"  {light}, {delay} min: off on somebody {at['false_offs_an_hour']:.2f} times an occupied "
                             f"hour, dark {100 * at['dark_share']:.1f} % of it, lit and empty {at['lit_empty_h']:.1f} h")
        return "\n".join(lines) + ">"

    def at(self, delay_min: float, light: str | None = None) -> dict[str, Any]:
        """The figures of one delay; of the only light, or of this one. Raises KeyError for what isn't there."""
        wanted = light if light is not None else self.lights[0]
        found = np.nonzero((self.columns["light"] == wanted) & (self.columns["delay_min"] == delay_min))[0]
        if len(found) == 0:
            raise KeyError(f"no light {wanted!r} with a delay of {delay_min:g} min")
        return {name: values[found[0]].item() for name, values in self.columns.items()}

    def to_pandas(self) -> pandas.DataFrame:
        """A row a light and delay."""
        import pandas as pd

        return pd.DataFrame(self.columns)


def control(result: Result, rule: PathOr | Mapping[str, Any] | None = None, *,
            model: Model | None = None) -> LightCosts:
    """Switches light by what sensors reported, and says what each delay costs, as `pirsim control` does.

    rule: a file, or the same keys as a dict: `{"lights": [{"area": "office", "delay_min": 5}]}`
    (docs/formats/control.md). None: one light, by any sensor. model: what made the result, as --scene and --script tell
    the command: a light of an area that names no sensors is switched by those that watch it, and without a rule each
    area has a light. A run is a day.

    Raises InputError for a rule that isn't one or doesn't fit the rows, and FileError. What the rows lack for it, and
    seats where nobody at work is noticed, are an InputWarning.
    """
    if rule is None or isinstance(rule, Mapping):
        file, text = "", "" if rule is None else json.dumps({"pirsim_control": 1, "lights": [{}], **rule})
    else:
        file, text = as_path(rule), ""
    run, second = np.nonzero(result.valid)
    rows: dict[str, Any] = {
        "sensors": list(result.sensors), "areas": list(result.areas), "doors": list(result.doors),
        "window_s": float(result.time[0]) if len(result.time) else 1.0,
        "clock": [] if result.clock is None else np.datetime_as_string(result.clock[run, second], unit="s").tolist(),
        "run": run.astype(np.int32), "phases": list(result.phases),
        "phase_code": result.phase_code[run, second].astype(np.int32),
        "time_s": np.ascontiguousarray(result.time[second], dtype=np.float64)}
    rows.update((name, np.ascontiguousarray(getattr(result, name)[run, second], dtype=of)) for name, of in (
        ("people", np.int32), ("people_of_areas", np.int32), ("door_open", np.uint8), ("bits", np.uint8)))
    found = _core.control_light(file, text, None if model is None else handle_of(model), rows)
    warn_of(found["remarks"])
    columns = {name: np.array(cells) for name, cells in found["columns"].items()}
    lit = np.zeros((*result.valid.shape, len(found["lights"])), dtype=np.uint8)
    lit[run, second] = found["lit"]
    for array in (lit, *columns.values()):
        array.flags.writeable = False
    return LightCosts(found["lights"], columns, lit)
