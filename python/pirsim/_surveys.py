"""Coverage studies and walk tests."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any, Iterable

import numpy as np
import numpy.typing as npt

from . import _core
from ._study import Overrides, PathOr, Progress, as_input, as_overrides, as_threads, folders
from .errors import InputWarning
from .specs import Scene


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
                                            *folders(sensors), as_threads(threads), progress)
    for diagnostic in arrays.pop("warnings"):
        warnings.warn(str(diagnostic), InputWarning, stacklevel=2)
    return CoverageMap(**arrays)


def walk_test(scene: PathOr | Scene, script: PathOr, *, set: Overrides | None = None,
              sensors: PathOr | Iterable[PathOr] | None = None, threads: int = 0,
              progress: Progress | None = None) -> WalkTest:
    """Tries at every point of the floor how surely walkers and sitters are noticed in time.

    Arguments as of coverage(); script: a walk test's YAML file.
    """
    arrays: dict[str, Any] = _core.walk_test(as_input(scene, Scene), as_input(script, str), as_overrides(set),
                                             *folders(sensors), as_threads(threads), progress)
    for diagnostic in arrays.pop("warnings"):
        warnings.warn(str(diagnostic), InputWarning, stacklevel=2)
    return WalkTest(**arrays)
