"""What runs give, as arrays."""

from __future__ import annotations

import difflib
import warnings
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Iterable, NamedTuple, Sequence

import numpy as np
import numpy.typing as npt

from ._spec_parts import counted

if TYPE_CHECKING:
    import pandas
    import polars
    import xarray


class Fault(NamedTuple):
    """Why a run could not go on; it has no rows."""

    run: int
    time_s: float
    text: str


class Incident(NamedTuple):
    """Something between people, or a person and a seat, that ended no run: `passed_through`, `seat_changed`,
    `seat_missed` or `waited_outside`."""

    run: int
    kind: str
    time_s: float
    person: str
    place_m: tuple[float, float]
    """(x, z) on the floor."""


@dataclass(frozen=True, eq=False)
class Result:
    """The rows of some runs. All arrays are read-only. Each owns its memory, which the library filled without a copy
    being made: it outlives the model and the other arrays.

    Runs differ in length. Arrays over seconds (windows, 1 s each unless the script says otherwise) are as long as the
    longest run and hold zeros behind the end of a shorter one, where `valid` is False.
    """

    sensors: tuple[str, ...]
    """Names, in the order of the last axis of `bits`."""
    bits: npt.NDArray[np.uint8]
    """[run, second, sensor] 1 where the sensor saw motion in that second."""
    people: npt.NDArray[np.uint16]
    """[run, second] people in the room at the end of that second."""
    areas: tuple[str, ...]
    """Ids of the scene's areas, then `elsewhere` if some of the floor is in none; empty without areas."""
    people_of_areas: npt.NDArray[np.uint16]
    """[run, second, area] how many of `people` are in each of `areas`; they sum to `people`."""
    doors: tuple[str, ...]
    """Ids of the scene's doors."""
    door_open: npt.NDArray[np.uint8]
    """[run, second, door] 1 while the door isn't shut, at the end of that second."""
    valid: npt.NDArray[np.bool_]
    """[run, second] False behind the end of a run."""
    time: npt.NDArray[np.float64]
    """[second] its end, in seconds since the run began."""
    phase_code: npt.NDArray[np.uint16]
    """[run, second] index into `phases`: what the script's first person does."""
    phases: tuple[str, ...]
    """Names of phases; the first is empty and stands behind the end of a run."""
    run: npt.NDArray[np.uint32]
    """[run] its number in the study, from 0."""
    replicate: npt.NDArray[np.int32]
    """[run] from 1."""
    trial: npt.NDArray[np.str_]
    """[run] as the script names it."""
    seed: int
    """Of the study, or of what `Trace.emit()` drew."""
    clock: npt.NDArray[np.datetime64] | None = None
    """[run, second] local wall-clock time at its end, NaT behind the end of a run; None without a clock (`Script.begin`,
    or a schedule)."""
    zones: list[npt.NDArray[np.uint8]] = field(default_factory=list, repr=False)
    """A [tick, zone] array for each run, 1 where the zone sees somebody; empty ones unless `run(zones=True)`."""
    occupants: dict[str, npt.NDArray[Any]] = field(default_factory=dict, repr=False)
    """Columns of who is where, one entry a second and person who is there: run, time_s, person, activity, seat, x_m,
    z_m, inside, and with areas area; empty ones unless `run(occupants=True)`."""
    signals: dict[str, npt.NDArray[Any]] = field(default_factory=dict, repr=False)
    """Columns of what analog sensors received, one entry a tick and sensor: run, tick, sensor (index), power_w,
    signal_v, output, and the zone (index), person, part and share_v of the largest share; empty ones unless
    `run(signals=True)`."""
    frames: dict[str, npt.NDArray[np.float32]] = field(default_factory=dict, repr=False)
    """Of each thermal array by its id [run, frame, y, x] degrees Celsius, from the upper left as it looks; NaN of a dead
    pixel, and behind the end of a run. Empty unless `run(frames=True)`."""
    frame_time: dict[str, npt.NDArray[np.float64]] = field(default_factory=dict, repr=False)
    """Of each array [frame] when it is read, in seconds since the run began."""
    faults: list[Fault] = field(default_factory=list)
    """Runs that could not go on; they are in the arrays, without a valid second."""
    incidents: list[Incident] = field(default_factory=list, repr=False)

    def __repr__(self) -> str:
        trials = list(dict.fromkeys(self.trial.tolist()))
        runs, seconds, _ = self.bits.shape
        known = max(1, int(self.valid.sum()))
        shares = ", ".join(f"{name} {100 * share:.1f} %" for name, share in
                           zip(self.sensors[:8], self.bits.sum(axis=(0, 1)) / known))
        more = ", ..." if len(self.sensors) > 8 else ""
        extra = [f"zones of {sum(len(ticks) > 0 for ticks in self.zones)} runs"] if any(map(len, self.zones)) else []
        for name, table in (("occupants", self.occupants), ("signals", self.signals)):
            rows = len(table.get("run", ()))
            extra += [f"{name}: {rows} rows"] if rows else []
        extra += [f"frames of {name} {list(stack.shape)}" for name, stack in self.frames.items()]
        lines = [f"<pirsim.Result: {runs} runs of {counted(trials, 'trial', 'trials')}, up to {seconds} rows each, "
                 f"seed {self.seed}",
                 f"  bits {list(self.bits.shape)}, seconds with motion: {shares}{more}",
                 f"  people 0 to {int(self.people.max(initial=0))}; phases: {', '.join(filter(None, self.phases))}",
                 f"  {len(self.faults)} faults, {len(self.incidents)} incidents"]
        return "\n".join(lines + [f"  {text}" for text in extra]) + ">"

    def people_in(self, area: str) -> npt.NDArray[np.uint16]:
        """[run, second] people in the area of this id, or `elsewhere`. Raises KeyError for one that `areas` lacks."""
        if area not in self.areas:
            raise KeyError(f"no area {area!r} ({_hint(area, self.areas)})")
        return self.people_of_areas[:, :, self.areas.index(area)]

    @cached_property
    def phase(self) -> npt.NDArray[np.str_]:
        """[run, second] name of the phase; empty behind the end of a run."""
        names = np.array(self.phases)[self.phase_code]
        names.flags.writeable = False
        return names

    def motion_windows(self, phases: Iterable[str] | None = None) -> npt.NDArray[np.int64]:
        """[run, sensor] seconds with motion, of all phases or of these."""
        if phases is None:
            return self.bits.sum(axis=1, dtype=np.int64)
        phases = list(phases)
        for phase in phases:
            if phase in self.phases:
                continue
            warnings.warn(f"no row of these runs has a phase {phase!r}, so it counts as 0 "
                          f"({_hint(phase, self.phases)})", stacklevel=2)
        wanted = np.isin(np.array(self.phases), phases)[self.phase_code]
        return (self.bits * wanted[:, :, np.newaxis]).sum(axis=1, dtype=np.int64)

    def _columns(self) -> dict[str, npt.NDArray[Any]]:
        """As the command line's CSV has them, but for trial and phase, which are the indices of run and phase."""
        run, second = np.nonzero(self.valid)
        columns: dict[str, npt.NDArray[Any]] = {
            "replicate": self.replicate[run], "trial": run, "time_s": self.time[second]}
        if self.clock is not None:
            columns["time"] = self.clock[run, second]
        columns["phase"] = self.phase_code[run, second]
        columns["people"] = self.people[run, second]
        for area, name in enumerate(self.areas):
            columns["people_" + name] = self.people_of_areas[run, second, area]
        for door, name in enumerate(self.doors):
            columns["door_" + name] = self.door_open[run, second, door]
        for sensor, name in enumerate(self.sensors):
            columns[name] = self.bits[run, second, sensor]
        return columns

    def to_pandas(self) -> pandas.DataFrame:
        """A row a second, with the columns of the command line's CSV; trial and phase are categories."""
        import pandas as pd

        columns: dict[str, Any] = self._columns()
        trials, codes = np.unique(self.trial, return_inverse=True)
        columns["trial"] = pd.Categorical.from_codes(codes[columns["trial"]], trials.tolist())
        columns["phase"] = pd.Categorical.from_codes(columns["phase"], list(self.phases))
        return pd.DataFrame(columns)

    def to_polars(self) -> polars.DataFrame:
        """A row a second, with the columns of the command line's CSV."""
        import polars as pl

        columns: dict[str, Any] = self._columns()
        columns["trial"] = pl.Series(self.trial.tolist()).gather(columns["trial"])
        columns["phase"] = pl.Series(list(self.phases)).gather(columns["phase"])
        if "time" in columns:
            columns["time"] = columns["time"].astype("datetime64[ms]")  # polars has no whole seconds
        return pl.DataFrame(columns)

    def to_xarray(self) -> xarray.Dataset:
        """bits (run, time, sensor), people, valid and phase (run, time), with trial and replicate of each run; with areas
        people_of_areas (run, time, area), with doors door_open (run, time, door)."""
        import xarray as xr

        rows = ("run", "time")
        data = {"bits": (("run", "time", "sensor"), self.bits), "people": (rows, self.people),
                "valid": (rows, self.valid), "phase": (rows, self.phase)}
        if self.clock is not None:
            data["clock"] = (rows, self.clock.astype("datetime64[ns]"))
        names: dict[str, Any] = {}
        if self.areas:
            data["people_of_areas"] = (("run", "time", "area"), self.people_of_areas)
            names["area"] = list(self.areas)
        if self.doors:
            data["door_open"] = (("run", "time", "door"), self.door_open)
            names["door"] = list(self.doors)
        return xr.Dataset(data, coords=names | {
            "run": self.run, "time": ("time", self.time, {"units": "s"}), "sensor": list(self.sensors),
            "trial": ("run", self.trial), "replicate": ("run", self.replicate)})


def _hint(name: str, known: Sequence[str]) -> str:
    near = difflib.get_close_matches(name, known, n=1)
    return f"did you mean {near[0]!r}?" if near else f"there are {', '.join(filter(None, known)) or 'none'}"


def make_result(arrays: dict[str, Any], sensors: tuple[str, ...], areas: tuple[str, ...],
                doors: tuple[str, ...], seed: int) -> Result:
    """Of what the module gives."""
    texts = arrays.pop("texts")
    occupants, signals = arrays["occupants"], arrays["signals"]
    for table, columns in ((occupants, [name for name in occupants if occupants[name].dtype == np.uint16]),
                           (signals, ("person", "part"))):
        for column in columns:
            table[column] = np.array(texts)[table[column]]
    occupants["inside"] = occupants.pop("where") == "inside"
    occupants["inside"].flags.writeable = False
    arrays["faults"] = [Fault(*fault) for fault in arrays["faults"]]
    arrays["incidents"] = [Incident(*incident) for incident in arrays["incidents"]]
    arrays["trial"] = np.array(arrays["trial"], dtype=np.str_)
    arrays["trial"].flags.writeable = False
    if "clock" in arrays:
        arrays["clock"] = arrays["clock"].view("datetime64[s]")
    return Result(sensors=sensors, areas=areas, doors=doors, seed=seed, **arrays)
