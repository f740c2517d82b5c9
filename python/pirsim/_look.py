"""Looking at a study: pictures, pages that play a run, what sensors can see, which places for sensors are better."""

from __future__ import annotations

import html
import warnings
from dataclasses import dataclass, field
from typing import Any, Iterable, Literal, NamedTuple, Sequence, Union

from . import _core
from ._files import write
from ._study import (Overrides, PathOr, Progress, _handle_of, Model, as_count, as_file, as_input, as_overrides, as_path, as_scene,
                     as_threads, folders)
from .errors import Error, InputWarning
from .specs import Diagnostic, Point3, Scene, Script, Sensor

Beams = Union[str, Sequence[str]]
"""Names of sensors whose beams are drawn, "all" or "none"."""
Mark = Literal["seats", "doors", "sensors", "people", "scale", "key", "all", "none"]


def _texts(value: str | Iterable[str] | None) -> list[str]:
    return [] if value is None else [value] if isinstance(value, str) else list(value)


def _run_number(model: Model, run: int) -> int:
    number = as_count(run, "run", -2**63, 2**63 - 1)
    if not 0 <= number < model.n_runs:
        raise IndexError(f"run {number}: the study has runs 0 to {model.n_runs - 1}")
    return number


@dataclass(frozen=True)
class Picture:
    """A picture of a moment. A notebook shows it; `save()` writes it."""

    png: bytes = field(repr=False)
    """As a file has them."""
    width: int
    height: int
    trial: str
    run: int
    time_s: float
    """Of the run."""

    def _repr_png_(self) -> bytes:
        return self.png

    def save(self, file: PathOr) -> None:
        """Writes a PNG file."""
        write(file, self.png)


def preview(model: Model, run: int = 0, *, time_s: float | None = None, beams: Beams | None = None,
            marks: Mark | Sequence[Mark] = "all", camera: Point3 | None = None, look_at: Point3 | None = None,
            field_of_view_deg: float = 45.0, width: int = 1280, height: int = 720) -> Picture:
    """Renders room, people and beams at a moment of a run, as `pirsim preview` does.

    run: its number (`model.runs_of("S8")[0]` is the first of a trial). time_s: of the run, None: 10 s into desk work.
    beams: None: the first sensor's. marks: what is marked and named. camera, look_at: world metres, None: from above
    and beside, the whole floor in view. field_of_view_deg: vertical, 1 to 170. width, height: pixels, up to 7680 x 4320.

    Raises UsageError for names and numbers that aren't accepted and a moment that never comes, IndexError for a run that
    isn't there, InfeasibleError for one that can't go on.
    """
    number = _run_number(model, run)
    png, moment_s = _core.picture(_handle_of(model), number, time_s, _texts(beams), _texts(marks), camera, look_at,
                                  field_of_view_deg, as_count(width, "width", 16, 7680),
                                  as_count(height, "height", 16, 4320))
    return Picture(png, width, height, model.trials[number % len(model.trials)], number, moment_s)


@dataclass(frozen=True)
class Page:
    """A page that plays a run in 3D, with its rows as a time line. A notebook shows it; `save()` writes it."""

    html: str = field(repr=False)
    """One file, that works without a network."""
    about: str
    from_s: float
    to_s: float
    run_s: float
    """Length of the whole run, of which the page shows from_s to to_s."""

    def _repr_html_(self) -> str:
        return (f'<iframe srcdoc="{html.escape(self.html)}" width="100%" height="700" style="border:0" '
                f'sandbox="allow-scripts"></iframe>')

    def save(self, file: PathOr) -> None:
        """Writes an HTML file."""
        write(file, self.html)


def view(model: Model, run: int = 0, *, from_s: float | None = None, to_s: float | None = None,
         keys_per_s: float = 10.0, coverage: PathOr | None = None) -> Page:
    """Makes a page that plays a run, as `pirsim view` does.

    run: as in preview(). from_s, to_s: of the run; without them all of it, or of a run over 1200 s those 1200 s with
    most motion. keys_per_s: pictures a second, 0.1 to 100. coverage: a coverage study's YAML file, whose map is laid
    on the floor. Raises as preview() does.
    """
    parts: dict[str, Any] = _core.page(_handle_of(model), _run_number(model, run), from_s, to_s, keys_per_s,
                                       "" if coverage is None else as_file(coverage, "studies"))
    return Page(**parts)


def export(model: Model, file: PathOr, run: int = 0, *, beams: Beams = "all", keys_per_s: float = 10.0) -> float:
    """Writes a run as an animated glTF, as `pirsim export` does, and returns its length in seconds.

    file: .glb, or .gltf with its buffer in it. run, beams: as in preview(). keys_per_s: 0.001 to 10000. Raises as
    preview() does, and FileError.
    """
    return _core.export_run(_handle_of(model), as_path(file), _run_number(model, run), _texts(beams), keys_per_s)


class SensorSight(NamedTuple):
    """What a sensor sees of somebody who stands or sits still."""

    sensor: str
    rays: int
    rays_cut: int
    """Rays that end at the room before their rated range."""
    longest_m: float
    places: int
    """Places of the floor where it sees a standing person."""
    seats: tuple[str, ...]
    """Where it sees a sitter."""
    deaf: tuple[str, ...]
    """Where it sees somebody at work and never reports motion."""


@dataclass(frozen=True, repr=False)
class Findings:
    """What check() found. True if a study can run; `print()` tells all."""

    errors: list[Diagnostic]
    warnings: list[Diagnostic]
    sensors: list[SensorSight] = field(default_factory=list)
    places: int = 0
    """Places of the floor on which somebody was stood."""
    places_seen_by_any: int = 0
    text: str = ""
    """The report of `pirsim check`."""

    def __bool__(self) -> bool:
        return not self.errors

    def __str__(self) -> str:
        return "\n".join([str(found) for found in self.errors] + [self.text.rstrip()] * bool(self.text) +
                         [str(found) for found in self.warnings])

    __repr__ = __str__


def check(scene: PathOr | Scene, script: PathOr | Script, *, set: Overrides | None = None,
          sensors: PathOr | Iterable[PathOr] | None = None, marks: PathOr | None = None) -> Findings:
    """Validates a scene and a script without running them and tells what each sensor can see, as `pirsim check` does.

    Arguments as of compile(). What is wrong is in the Findings; only an argument of a wrong type raises.
    """
    try:
        core = _core.compile(as_scene(scene, marks), as_input(script, Script, set), as_overrides(set), *folders(sensors))
    except Error as error:
        return Findings(error.diagnostics, [])
    parts: dict[str, Any] = _core.check(core)
    return Findings([], core.warnings + parts["warnings"], [SensorSight(*sight) for sight in parts["sensors"]],
                    parts["places"], parts["places_seen_by_any"], parts["text"])


class PlacementLight(NamedTuple):
    """What becomes of light that a set of sensors switches, of all areas together."""

    occupied_h: float
    false_offs: int
    """How often it went off while somebody was there."""
    dark_h: float
    """While somebody was there."""
    lit_empty_h: float
    """While nobody was there."""


class PlacementScore(NamedTuple):
    """How one set of sensors does."""

    set: str
    sensors: list[Sensor]
    seen_area_m2: float
    """By at least one sensor."""
    blind_fraction: float
    overlap: float
    """Share of the seen area that two sensors or more see."""
    blind_seats: tuple[str, ...]
    noticed_seats: tuple[str, ...]
    """Where somebody at work is noticed by a sensor."""
    deaf_seats: tuple[str, ...]
    """Where sensors see somebody at work, and none ever reports motion."""
    unseen_seats: tuple[str, ...]
    surely_seats: tuple[str, ...]
    """Of `noticed_seats`: where a sensor reports motion in ten seconds or more."""
    light: PlacementLight | None
    """If the study has `light`."""


@dataclass(frozen=True, repr=False)
class Placements:
    """Sets of sensors, ranked. `print()` tells all."""

    ranked: list[PlacementScore]
    """Best first, by what the study ranks by; with a search, its even and its best places are among them."""
    evaluations: int
    """Sets that the search tried; 0: there was none."""
    text: str
    """The report of `pirsim placements`."""

    def __str__(self) -> str:
        return self.text.rstrip()

    __repr__ = __str__


def placements(scene: PathOr | Scene, script: PathOr, *, set: Overrides | None = None,
               sensors: PathOr | Iterable[PathOr] | None = None, threads: int = 0,
               progress: Progress | None = None) -> Placements:
    """Ranks sets of sensors by what they see, and looks for a better one if the study asks for that.

    Arguments as of coverage(); script: a placement study's YAML file. progress is told in sets that the search tried.
    """
    parts: dict[str, Any] = _core.placements(as_input(scene, Scene), as_input(script, str), as_overrides(set),
                                             *folders(sensors), as_threads(threads), progress)
    for diagnostic in parts.pop("warnings"):
        warnings.warn(str(diagnostic), InputWarning, stacklevel=2)
    parts["ranked"] = [PlacementScore(*score, None if light is None else PlacementLight(*light))
                       for *score, light in parts["ranked"]]
    return Placements(**parts)
