"""Looking at a study: pictures, pages that play a run, what sensors see; coverage, walk tests, places for sensors."""

from __future__ import annotations

import html
from dataclasses import dataclass, field
from typing import Any, Iterable, Literal, NamedTuple, Sequence, Union

import numpy as np
import numpy.typing as npt

from . import _core
from ._inputs import (Overrides, PathOr, Progress, as_count, as_file, as_input, as_overrides, as_path, as_scene,
                      as_threads, folders, warn_of, write)
from ._study import Model, handle_of, run_number
from .errors import Error
from .specs import Diagnostic, Point3, Scene, Script, Sensor

Beams = Union[str, Sequence[str]]
"""Names of sensors whose beams are drawn, "all" or "none"."""
Mark = Literal["seats", "doors", "sensors", "people", "scale", "key", "all", "none"]


def _texts(value: str | Iterable[str] | None) -> list[str]:
    return [] if value is None else [value] if isinstance(value, str) else list(value)


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
    number = run_number(model, run)
    png, moment_s = _core.picture(handle_of(model), number, time_s, _texts(beams), _texts(marks), camera, look_at,
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
    parts: dict[str, Any] = _core.page(handle_of(model), run_number(model, run), from_s, to_s, keys_per_s,
                                       "" if coverage is None else as_file(coverage, "studies"))
    return Page(**parts)


def export(model: Model, file: PathOr, run: int = 0, *, beams: Beams = "all", keys_per_s: float = 10.0) -> float:
    """Writes a run as an animated glTF, as `pirsim export` does, and returns its length in seconds.

    file: .glb, or .gltf with its buffer in it. run, beams: as in preview(). keys_per_s: 0.001 to 10000. Raises as
    preview() does, and FileError.
    """
    return _core.export_run(handle_of(model), as_path(file), run_number(model, run), _texts(beams), keys_per_s)


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
        core = _core.compile(as_scene(scene, marks), as_input(script, Script, set), as_overrides(set), folders(sensors))
    except Error as error:
        return Findings(error.diagnostics, [])
    parts: dict[str, Any] = _core.check(core)
    return Findings([], core.warnings + parts["warnings"], [SensorSight(*sight) for sight in parts["sensors"]],
                    parts["places"], parts["places_seen_by_any"], parts["text"])


# -- surveys of a room -----------------------------------------------------------------------------------------------

@dataclass(frozen=True, eq=False)
class Grid:
    """Squares of the floor: rows along z, columns along x. All arrays are read-only."""

    spacing_m: float
    x: npt.NDArray[np.float64]
    """[column] centres, metres."""
    z: npt.NDArray[np.float64]
    """[row] centres, metres."""
    on_floor: npt.NDArray[np.bool_]
    """[row, column] False where there is no floor."""

    def _about(self) -> str:
        return (f"{len(self.z)} rows x {len(self.x)} columns of {self.spacing_m:g} m, "
                f"{int(self.on_floor.sum())} squares on the floor")

    def __repr__(self) -> str:
        return f"<pirsim.Grid: {self._about()}>"

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom, top in metres, as matplotlib's imshow() wants it."""
        half = self.spacing_m / 2
        return (self.x[0] - half, self.x[-1] + half, self.z[-1] + half, self.z[0] - half)


@dataclass(frozen=True, eq=False)
class CoverageMap(Grid):
    """Where each sensor sees a moving target."""

    sensors: tuple[str, ...]
    n_windows: int
    """Seconds that the target moves in each square."""
    counts: npt.NDArray[np.uint16]
    """[row, column, sensor] seconds with motion; 0 off the floor."""

    def __repr__(self) -> str:
        squares = max(1, int(self.on_floor.sum()))
        seen = ", ".join(f"{name} {100 * share:.0f} %" for name, share in
                         zip(self.sensors[:8], (self.counts > 0).sum(axis=(0, 1)) / squares))
        more = ", ..." if len(self.sensors) > 8 else ""
        return (f"<pirsim.CoverageMap: {self._about()}, {self.n_windows} seconds each\n"
                f"  floor where a sensor sees the target: {seen}{more}>")

    @property
    def share(self) -> npt.NDArray[np.float64]:
        """[row, column, sensor] share of seconds with motion, 0 to 1; NaN off the floor."""
        return np.where(self.on_floor[:, :, np.newaxis], self.counts / self.n_windows, np.nan)


@dataclass(frozen=True, eq=False)
class WalkTest(Grid):
    """How often a walker (major) and a sitter's arms, or a swinging arm, (minor) were noticed in time; [row, column] each."""

    major_made: npt.NDArray[np.int32]
    """Tries that were possible there."""
    major_noticed: npt.NDArray[np.int32]
    minor_made: npt.NDArray[np.int32]
    minor_noticed: npt.NDArray[np.int32]
    minor_deaf: npt.NDArray[np.int32]
    """Tries that weren't noticed, though a sensor saw the sitter, or the arm."""
    seats: dict[str, bool]
    """Is somebody noticed who sits there and moves their arms? None of a swinging arm's test."""

    def __repr__(self) -> str:
        missed = [seat for seat, noticed in self.seats.items() if not noticed]
        tries = [f"{what} {int(noticed.sum())} of {int(made.sum())}" for what, noticed, made in
                 (("walker", self.major_noticed, self.major_made), ("arms", self.minor_noticed, self.minor_made))]
        return (f"<pirsim.WalkTest: {self._about()}\n  tries that were noticed in time: {', '.join(tries)}\n"
                f"  {len(self.seats)} seats, not noticed: {', '.join(missed) or 'none'}>")


def coverage(scene: PathOr | Scene, script: PathOr, *, set: Overrides | None = None,
             sensors: PathOr | Iterable[PathOr] | None = None, threads: int = 0,
             progress: Progress | None = None) -> CoverageMap:
    """Maps where each sensor sees a moving target.

    scene: a glTF file, or a Scene. script: a coverage study's YAML file. The other arguments are those of compile()
    and run(); progress is told in rows of squares.
    """
    arrays: dict[str, Any] = _core.coverage(as_input(scene, Scene), as_input(script, str), as_overrides(set),
                                            folders(sensors), as_threads(threads), progress)
    warn_of(arrays.pop("warnings"))
    return CoverageMap(**arrays)


def walk_test(scene: PathOr | Scene, script: PathOr, *, set: Overrides | None = None,
              sensors: PathOr | Iterable[PathOr] | None = None, threads: int = 0,
              progress: Progress | None = None) -> WalkTest:
    """Tries at every point of the floor how surely walkers and sitters are noticed in time.

    Arguments as of coverage(); script: a walk test's YAML file.
    """
    arrays: dict[str, Any] = _core.walk_test(as_input(scene, Scene), as_input(script, str), as_overrides(set),
                                             folders(sensors), as_threads(threads), progress)
    warn_of(arrays.pop("warnings"))
    return WalkTest(**arrays)


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
                                             folders(sensors), as_threads(threads), progress)
    warn_of(parts.pop("warnings"))
    parts["ranked"] = [PlacementScore(*score, None if light is None else PlacementLight(*light))
                       for *score, light in parts["ranked"]]
    return Placements(**parts)
