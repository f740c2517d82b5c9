"""The parts of specs that have a form of their own, and how larger ones print."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, Sequence

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from . import specs

Point2 = tuple[float, float]
"""(x, z) on the floor, or (x, y) on a sensor's plane; metres."""
Point3 = tuple[float, float, float]
"""(x, y, z), metres."""


@dataclass(slots=True)
class Diagnostic:
    """One fault or remark. line and column count from 1; 0: unknown."""

    severity: Literal["warning", "error"]
    file: str
    line: int
    column: int
    text: str

    def __str__(self) -> str:
        place = self.file
        if self.line:
            place += f":{self.line}"
            if self.column:
                place += f":{self.column}"
        return f"{place}: {self.severity}: {self.text}" if place else f"{self.severity}: {self.text}"


@dataclass(slots=True)
class Frame:
    """Where something is and how it is turned: it faces its local -Z, with +Y up. `pirsim.facing()` makes one."""

    origin: Point3 = (0.0, 0.0, 0.0)
    rotation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    """Unit quaternion (w, x, y, z)."""


@dataclass(slots=True)
class Floor:
    """The floor on which people walk and are counted: polygons, inside by the even-odd rule."""

    loops: list[list[Point2]] = field(default_factory=list)
    height_m: float = 0.0

    def __repr__(self) -> str:
        corners = sum(len(loop) for loop in self.loops)
        return f"<pirsim.Floor: {corners} corners in {len(self.loops)} outlines, at {self.height_m:g} m>"

    @staticmethod
    def rectangle(x0: float, z0: float, x1: float, z1: float, height_m: float = 0.0) -> Floor:
        """From corner (x0, z0) to corner (x1, z1), metres."""
        return Floor([[(x0, z0), (x1, z0), (x1, z1), (x0, z1)]], height_m)


@dataclass(slots=True, eq=False)
class Mesh:
    """Triangles that hide what is behind them. positions: float64 (n, 3), metres; triangles: uint32 (m, 3) indices."""

    name: str
    positions: npt.ArrayLike
    triangles: npt.ArrayLike
    solidity: Literal["solid", "screen"] = "solid"
    """A screen hides, but nobody walks round it: what people move with them, a chair's back."""
    temperature_c: float | None = None
    """Of its surface, where it differs from the room's."""

    @staticmethod
    def box(name: str, lower: Point3, upper: Point3) -> Mesh:
        """A closed box between two corners, metres."""
        ends = np.array([lower, upper], dtype=np.float64)
        corners = np.array([[ends[i, 0], ends[j, 1], ends[k, 2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
        quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
        return Mesh(name, corners, np.array(triangles, dtype=np.uint32))

    def __repr__(self) -> str:
        sizes = len(np.asarray(self.positions)), len(np.asarray(self.triangles))
        warm = "" if self.temperature_c is None else f", {self.temperature_c:g} degrees Celsius"
        return f"<pirsim.Mesh {self.name!r}: {sizes[0]} vertices, {sizes[1]} triangles, {self.solidity}{warm}>"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Mesh):
            return NotImplemented
        return ((self.name, self.solidity, self.temperature_c) == (other.name, other.solidity, other.temperature_c)
                and np.array_equal(np.asarray(self.positions), np.asarray(other.positions))
                and np.array_equal(np.asarray(self.triangles), np.asarray(other.triangles)))


def counted(names: Sequence[str], one: str, many: str, most: int = 5) -> str:
    """For reprs: "12 seats (S1, S2, S3, S4, S5, ...)"."""
    text = f"{len(names)} {one if len(names) == 1 else many}"
    return f"{text} ({', '.join(names[:most])}{', ...' if len(names) > most else ''})" if names else text


def sensor_model_text(model: specs.SensorModel) -> str:
    if model.array:
        return f"<pirsim.SensorModel {model.id!r}: {model.array.columns} x {model.array.rows} pixels>"
    zones = sum(len(cluster.zones) for cluster in model.clusters)
    reach = max((cluster.range_m for cluster in model.clusters), default=0.0)
    return (f"<pirsim.SensorModel {model.id!r}: {zones} zones in {len(model.clusters)} clusters, up to {reach:g} m, "
            f"response {model.response}>")


def scene_text(scene: specs.Scene) -> str:
    parts = [counted([sensor.id for sensor in scene.sensors], "sensor", "sensors"),
             counted([seat.id for seat in scene.seats], "seat", "seats"),
             counted([entrance.id for entrance in scene.entrances], "entrance", "entrances"),
             *([counted([door.id for door in scene.doors], "door", "doors")] if scene.doors else []),
             *([counted([area.id for area in scene.areas], "area", "areas")] if scene.areas else []),
             counted([mesh.name for mesh in scene.meshes], "mesh", "meshes"),
             counted(list(scene.sensor_models), "sensor model", "sensor models")]
    return f"<pirsim.Scene {scene.name!r}\n  " + "\n  ".join(parts) + f"\n  {scene.floor!r}>"


def person_text(person: specs.Person) -> str:
    doing = ", ".join(type(action).__name__ for action in person.actions[:8])
    more = ", ..." if len(person.actions) > 8 else ""
    return f"<pirsim.Person {person.id!r}: {person.stature_m:g} m, {person.style}, {len(person.actions)} actions: {doing}{more}>"


def trial_text(trial: specs.Trial) -> str:
    who = counted([person.id for person in trial.people], "person", "people")
    if trial.schedule is not None:
        who += " and a schedule"
    if trial.occupancy is not None:
        who += " and an occupancy"
    lasts = "" if trial.duration_s is None else f", {trial.duration_s:g} s"
    return f"<pirsim.Trial {trial.id!r}: {who}{lasts}>"


def script_text(script: specs.Script) -> str:
    effects = ", ".join(effect.name for effect in script.effects) or "none"
    return (f"<pirsim.Script {script.name!r}: seed {script.seed}, {script.replicates} replicates of "
            f"{counted([trial.id for trial in script.trials], 'trial', 'trials')}\n  effects: {effects}\n  {script.sensing!r}>")

