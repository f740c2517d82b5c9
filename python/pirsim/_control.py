"""Light that sensors switch, and what each delay costs."""

from __future__ import annotations

import csv
import io
import json
import os
import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Mapping

import numpy as np
import numpy.typing as npt

from . import _core
from ._result import Result
from .errors import InputWarning

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True, eq=False)
class LightCosts:
    """What lights cost at every delay, and when they are lit. All arrays are read-only."""

    lights: tuple[str, ...]
    columns: dict[str, npt.NDArray[Any]]
    """[light and delay] `light`, `delay_min`, `false_offs_an_hour`, `dark_share`, `lit_h` and so on, as `pirsim control -o`
    writes them; NaN where nothing is known."""
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


def control(result: Result, rule: str | os.PathLike[str] | Mapping[str, Any] | None = None) -> LightCosts:
    """Switches light by what sensors reported, and says what each delay costs.

    rule: a file, or the same keys as a dict: `{"lights": [{"area": "office", "delay_min": 5}]}`
    (docs/formats/control.md). None: one light, by any sensor. A run is a day.

    Raises InputError for a rule that isn't one or doesn't fit the rows, and FileError. What the rows lack for it is an
    InputWarning.
    """
    if rule is None or isinstance(rule, Mapping):
        keys: dict[str, Any] = {"pirsim_control": 1, "lights": [{}], **(rule or {})}
        file, text = "", json.dumps(keys)
    else:
        file, text = os.fspath(rule), ""
    run, second = np.nonzero(result.valid)
    window_s = float(result.time[0]) if len(result.time) else 1.0
    clock = [] if result.clock is None else np.datetime_as_string(result.clock[run, second], unit="s").tolist()
    table, lights, rows, remarks = _core.control_light(
        file=file,
        text=text,
        sensors=list(result.sensors),
        areas=list(result.areas),
        doors=list(result.doors),
        window_s=window_s,
        run=run.astype(np.int32),
        time_s=np.ascontiguousarray(result.time[second], dtype=np.float64),
        clock=clock,
        people=result.people[run, second].astype(np.int32),
        people_of_areas=np.ascontiguousarray(result.people_of_areas[run, second], dtype=np.int32),
        door_open=np.ascontiguousarray(result.door_open[run, second], dtype=np.uint8),
        bits=np.ascontiguousarray(result.bits[run, second], dtype=np.uint8))
    for remark in remarks:
        warnings.warn(remark, InputWarning, stacklevel=2)
    lit = np.zeros((*result.valid.shape, len(lights)), dtype=np.uint8)
    lit[run, second] = rows
    lit.flags.writeable = False
    lines = list(csv.DictReader(io.StringIO(table)))
    columns: dict[str, npt.NDArray[Any]] = {}
    for column in lines[0]:
        values = [line[column] for line in lines]
        columns[column] = np.array(values if column == "light" else [float(value or "nan") for value in values])
        columns[column].flags.writeable = False
    return LightCosts(tuple(lights), columns, lit)
