"""Model against measurement."""

from __future__ import annotations

import csv
import io
import os
from dataclasses import dataclass, field
from typing import Any, Iterable, NamedTuple

from . import _core
from ._inputs import (Overrides, PathOr, Progress, as_count, as_input, as_overrides, as_path, as_seed, as_threads,
                      folders, keep_inputs, warn_of)
from ._result import Result
from .specs import Effect, Scene, Script


class FittedEffect(NamedTuple):
    """An effect that the measurement shows, with its strength."""

    effect: Effect
    """As a script takes it."""
    intervals: dict[str, tuple[float, float]]
    """Of its parameters, 90 %."""


class Candidate(NamedTuple):
    """What became of one effect of the catalogue."""

    effect: str
    probability: float
    p: float
    kept: bool
    reason: str


class Cell(NamedTuple):
    """Seconds with motion a run of one trial and sensor."""

    trial: str
    sensor: str
    measured_s: float
    expected_s: float
    low_s: float
    """95 % of the simulated datasets lie between low_s and high_s."""
    high_s: float
    adjusted_p: float


@dataclass(frozen=True)
class Reconciliation:
    """Where model and measurement differ, and what makes the difference."""

    verdict: str
    """no-disagreement, named, one-of, several, nearest, none-in-catalogue or faulty-data."""
    sentence: str
    """The verdict for a reader."""
    details: list[str]
    """What else a reader must know of it."""
    data_findings: list[str]
    """What is wrong or odd with the measured rows themselves."""
    p: float
    """Of the model as it is: that it makes such data."""
    named: list[str]
    """Effects that were applied, or those that can't be told apart."""
    fits: list[FittedEffect]
    candidates: list[Candidate] = field(repr=False)
    """Most probable first."""
    cells: list[Cell] = field(repr=False)
    patched: Script = field(repr=False)
    """The script with the named effects added."""


_REPORT = "where.csv", "candidates.csv", "script_patched.yaml", "report.html", "report.json", "trail.log"
"""What reconcile() writes into its folder."""


def _rows_of(result: Result) -> str:
    """As the command line writes them."""
    columns: dict[str, Any] = result._columns()
    columns["trial"] = result.trial[columns["trial"]]
    columns["phase"] = [result.phases[code] for code in columns["phase"]]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*columns.values()))
    return text.getvalue()


def reconcile(scene: PathOr | Scene, script: PathOr | Script, measured: PathOr | Result, *,
              folder: PathOr | None = None, table: PathOr | None = None, set: Overrides | None = None,
              sensors: PathOr | Iterable[PathOr] | None = None, alpha: float = 0.05,
              effects: Iterable[str] | None = None, max_effects: int = 3, nuisance: PathOr | None = None,
              budget: float = 1.0, seed: int = 1, threads: int = 0,
              progress: Progress | None = None) -> Reconciliation:
    """Says whether model and measurement agree, where they don't, and which effect is missing; takes minutes.

    measured: rows in pirsim's own format or sums, as CSV, or a Result. folder: gets the report as a page and tables.
    table: keeps the simulated datasets, so that the next analysis of the study is quick. alpha: level of the tests.
    effects: names that are looked for, None: the whole catalogue. nuisance: a file that says what is uncertain about
    the room, "none", or None for the usual. budget: times the usual number of simulated datasets. scene, script, set
    and sensors as in compile(); progress is told in simulated datasets of each stage.
    """
    question = _core.Question()
    question.alpha, question.budget = alpha, budget
    question.max_effects = as_count(max_effects, "max_effects", 1, 5)
    question.effects = list(effects or [])
    question.nuisance = as_path(nuisance or "")
    question.folder, question.table = as_path(folder or ""), as_path(table or "")
    given = [("scene", scene), ("script", script), ("measured", measured), ("nuisance", nuisance)]
    keep_inputs([("folder", os.path.join(folder, name)) for name in _REPORT] if folder else [],
                [(name, file) for name, file in given if isinstance(file, (str, os.PathLike))])
    name, text = ("result", _rows_of(measured)) if isinstance(measured, Result) else (as_path(measured), "")
    parts = _core.reconcile(as_input(scene, Scene), as_input(script, Script, set), name, text, as_overrides(set),
                            folders(sensors), question, as_seed(seed), as_threads(threads), progress)
    warn_of(parts.pop("warnings"))
    parts["fits"] = [FittedEffect(*fit) for fit in parts["fits"]]
    parts["candidates"] = [Candidate(*candidate) for candidate in parts["candidates"]]
    parts["cells"] = [Cell(*cell) for cell in parts["cells"]]
    return Reconciliation(**parts)
