"""Coverage studies and walk tests."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any, Iterable

import numpy as np
import numpy.typing as npt

from . import _core
from ._study import Overrides, PathOr, Progress, as_input, as_overrides, folders
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

    @property
    def share(self) -> npt.NDArray[np.float64]:
        """[row, column, sensor] share of seconds with motion, 0 to 1; NaN off the floor."""
        return np.where(self.on_floor[:, :, np.newaxis], self.counts / self.n_windows, np.nan)


@dataclass(frozen=True, eq=False)
class WalkTest(Grid):
    """How often a walker (major) and a sitter's arms (minor) were noticed in time; [row, column] each."""

    major_made: npt.NDArray[np.int32]
    """Tries that were possible there."""
    major_noticed: npt.NDArray[np.int32]
    minor_made: npt.NDArray[np.int32]
    minor_noticed: npt.NDArray[np.int32]
    seats: dict[str, bool]
    """Is somebody noticed who sits there and moves their arms?"""


def coverage(scene: PathOr | Scene, script: PathOr, *, set: Overrides | None = None,
             sensors: PathOr | Iterable[PathOr] | None = None, threads: int = 0,
             progress: Progress | None = None) -> CoverageMap:
    """Maps where each sensor sees a moving target.

    scene: a glTF file, or a Scene. script: a coverage study's YAML file. The other arguments are those of compile()
    and run(); progress is told in rows of squares.
    """
    arrays: dict[str, Any] = _core.coverage(as_input(scene, Scene), as_input(script, str), as_overrides(set),
                                            *folders(sensors), threads, progress)
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
                                             *folders(sensors), threads, progress)
    for diagnostic in arrays.pop("warnings"):
        warnings.warn(str(diagnostic), InputWarning, stacklevel=2)
    return WalkTest(**arrays)
