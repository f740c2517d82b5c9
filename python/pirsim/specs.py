"""Scenes and scripts as plain objects: read from files, changed, or made from nothing.

Each class is one of the library's specs, with the same fields, units and defaults; a field's name ends in its unit.
Points are (x, y, z) in metres in glTF's frame (right-handed, +Y up, floor in XZ), floor points are (x, z). Lists and
dicts are ordinary ones. Nothing is checked before `pirsim.compile()`, which then names what it refuses.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Sequence, Union

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ._core import MeshSolid

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
class Where:
    """A place in a file, for messages; line and column count from 1."""

    file: str = ""
    line: int = 0
    column: int = 0


@dataclass(slots=True)
class InputFile:
    """A file that was read, and the SHA-256 of the bytes that it had then."""

    path: str = ""
    sha256: str = ""


def _where() -> Any:
    return field(default_factory=Where, repr=False, compare=False, kw_only=True)


# ------------------------------------------------------------------------------------------------------------ scenes
@dataclass(slots=True)
class Frame:
    """Where something is and how it is turned: it faces its local -Z, with +Y up. `pirsim.facing()` makes one."""

    origin: Point3 = (0.0, 0.0, 0.0)
    rotation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    """Unit quaternion (w, x, y, z)."""


def _listed(names: Sequence[str], one: str, many: str, most: int = 5) -> str:
    """For reprs: "12 seats (S1, S2, S3, S4, S5, ...)"."""
    text = f"{len(names)} {one if len(names) == 1 else many}"
    return f"{text} ({', '.join(names[:most])}{', ...' if len(names) > most else ''})" if names else text


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


@dataclass(slots=True)
class Sensor:
    """A sensor looks along its frame's -Z."""

    id: str = ""
    model: str = ""
    """Key into `Scene.sensor_models`."""
    world_from_sensor: Frame = field(default_factory=Frame)


@dataclass(slots=True)
class Seat:
    """The sitter's pelvis rests at the origin and faces -Z."""

    id: str = ""
    world_from_seat: Frame = field(default_factory=Frame)


@dataclass(slots=True)
class Entrance:
    """A doorway: the origin is the middle of the threshold, -Z points into the room."""

    id: str = ""
    world_from_entrance: Frame = field(default_factory=Frame)
    width_m: float = 0.9
    outside_m: float = 1.5
    """How far behind it people wait."""


@dataclass(slots=True)
class Optics:
    """What the physical response needs of a lens beyond its zones."""

    blur_deg: float = 0.5
    aperture_mm2: float = 20.0


@dataclass(slots=True)
class Element:
    """The pyroelectric element's time constants."""

    thermal_s: float = 0.15
    electrical_s: float = 1.0


@dataclass(slots=True)
class Amplifier:
    """A band-pass with noise. volts_per_watt None: calibrated on the rated distance."""

    low_hz: float = 0.3
    high_hz: float = 6.5
    order: int = 2
    volts_per_watt: float | None = None
    noise_v_pp: float = 0.080
    offset_v: float = 1.1
    lowest_v: float = 0.2
    highest_v: float = 1.9


@dataclass(slots=True)
class Comparator:
    """When the amplified signal switches the output on and off."""

    positive_v: float = 0.45
    negative_v: float = 0.45
    pulse_count: int = 1
    pulse_window_s: float = 0.0
    pulse_signs: Literal["any", "alternating"] = "any"
    hold_s: float = 0.0
    blind_s: float = 0.0


@dataclass(slots=True)
class Detector:
    """A sensor's electronics, for the physical response."""

    element: Element = field(default_factory=Element)
    amplifier: Amplifier = field(default_factory=Amplifier)
    comparator: Comparator = field(default_factory=Comparator)


@dataclass(slots=True)
class Zone:
    """A detection zone, drawn on the plane `plane_m` ahead of the sensor: four corners (x right, y up), metres."""

    corners: Sequence[Point2] = ((0.0, 0.0),) * 4
    """In order round the zone, convex."""
    polarity: int = 1


@dataclass(slots=True)
class Cluster:
    """The zones of one facet of the lens."""

    centre: Point2 = (0.0, 0.0)
    range_m: float = 0.0
    lens_step: int = 1
    zones: list[Zone] = field(default_factory=list, repr=False)


@dataclass(slots=True)
class SensorModel:
    """A sensor's lens and electronics. `pirsim.sensor_model()` has the shipped ones."""

    id: str = ""
    description: str = ""
    plane_m: float = 1.0
    clusters: list[Cluster] = field(default_factory=list)
    response: Literal["zones", "analog"] = "zones"
    optics: Optics = field(default_factory=Optics)
    detector: Detector = field(default_factory=Detector)

    def __repr__(self) -> str:
        zones = sum(len(cluster.zones) for cluster in self.clusters)
        reach = max((cluster.range_m for cluster in self.clusters), default=0.0)
        return (f"<pirsim.SensorModel {self.id!r}: {zones} zones in {len(self.clusters)} clusters, up to {reach:g} m, "
                f"response {self.response}>")


@dataclass(slots=True)
class Scene:
    """A room: what hides, where the sensors hang, where people sit, enter and walk."""

    name: str = ""
    meshes: list[Mesh] = field(default_factory=list)
    sensors: list[Sensor] = field(default_factory=list)
    """In the order of the arrays."""
    seats: list[Seat] = field(default_factory=list)
    entrances: list[Entrance] = field(default_factory=list)
    floor: Floor = field(default_factory=Floor)
    sensor_models: dict[str, SensorModel] = field(default_factory=dict)
    """Every model that a sensor names."""
    files: list[InputFile] = field(default_factory=list)
    """All that was read."""
    warnings: list[Diagnostic] = field(default_factory=list)

    def __repr__(self) -> str:
        parts = [_listed([sensor.id for sensor in self.sensors], "sensor", "sensors"),
                 _listed([seat.id for seat in self.seats], "seat", "seats"),
                 _listed([entrance.id for entrance in self.entrances], "entrance", "entrances"),
                 _listed([mesh.name for mesh in self.meshes], "mesh", "meshes"),
                 _listed(list(self.sensor_models), "sensor model", "sensor models")]
        return f"<pirsim.Scene {self.name!r}\n  " + "\n  ".join(parts) + f"\n  {self.floor!r}>"


# ----------------------------------------------------------------------------------------------------------- scripts
Activity = Literal["typing", "reading", "meeting", "phone", "whiteboard"]
"""What people of natural style are busy with: typing and reading at `Work` only, whiteboard at `Wait` only; a `Walk`
knows phone."""


@dataclass(slots=True, kw_only=True)
class _Action:
    at_s: float | None = None
    """Starts then: interrupts what goes on, or waits if that is already done."""
    phase: str = ""
    """Label of rows while this action runs; empty: what the body is doing."""
    where: Where = field(default_factory=Where, repr=False, compare=False)


@dataclass(slots=True)
class Wait(_Action):
    """Goes on standing or sitting."""

    duration_s: float = 0.0
    activity: Activity | None = None
    """Of natural style, as in other actions."""


@dataclass(slots=True)
class Appear(_Action):
    """Stands on the floor from now on, without having entered. heading_deg: 0 facing -Z, positive turning left."""

    point: Point2 = (0.0, 0.0)
    heading_deg: float = 0.0


@dataclass(slots=True)
class Enter(_Action):
    """Appears outside the entrance and walks in."""

    entrance: str = ""


@dataclass(slots=True)
class Walk(_Action):
    """Walks to each of the floor points in turn."""

    points: list[Point2] = field(default_factory=list)
    activity: Activity | None = None


@dataclass(slots=True)
class Sit(_Action):
    """Walks to the seat, turns and sits down; waits for it for a while if somebody else has it."""

    seat: str = ""
    wait_s: float = 120.0
    if_taken: Literal["next_action", "other_seat"] = "next_action"


@dataclass(slots=True)
class Work(_Action):
    """Desk work while seated: both forearms slide on the table, the spine changes its tilt."""

    duration_s: float = 180.0
    arm_amplitude_m: float = 0.1
    arm_period_s: float = 3.0
    tilt_choices_deg: list[float] = field(default_factory=lambda: [-15.0, 0.0, 15.0])
    tilt_every_s: float = 30.0
    activity: Activity | None = None
    """Of natural style, which has no use for the swing and the tilts; None: typing."""


@dataclass(slots=True)
class Rise(_Action):
    """Rises from the seat and stays standing behind it."""


@dataclass(slots=True)
class Leave(_Action):
    """Walks out through the entrance and disappears."""

    entrance: str = ""


@dataclass(slots=True)
class Turn(_Action):
    """Stands on the spot and turns. heading_deg: 0 facing -Z, positive turning left."""

    heading_deg: float = 0.0


Action = Union[Wait, Appear, Enter, Walk, Sit, Work, Rise, Leave, Turn]


@dataclass(slots=True)
class SeatScatter:
    """How far from the seat's place people sit down, drawn once a run and person."""

    position_sd_m: float = 0.0
    heading_sd_deg: float = 0.0


@dataclass(slots=True)
class Warmth:
    """How warm a person's surface is, for the physical response."""

    skin_c: float = 33.5
    clothing_clo: float = 1.0
    bare: list[str] = field(default_factory=lambda: ["head", "left_forearm", "right_forearm"])
    parts_c: dict[str, float] = field(default_factory=dict)


@dataclass(slots=True)
class Person:
    """A person and what they do, one action after the other."""

    id: str = ""
    actions: list[Action] = field(default_factory=list)
    stature_m: float = 1.86
    mass_kg: float = 80.0
    walking_speed_m_s: float = 1.0
    seat_scatter: SeatScatter = field(default_factory=SeatScatter)
    style: Literal["choreographed", "natural"] = "choreographed"
    warmth: Warmth = field(default_factory=Warmth)
    body_mesh_file: str = ""
    """glTF, relative to `Script.directory`; its meshes are read by `read_script()`."""
    body_meshes: dict[str, MeshSolid] = field(default_factory=dict, repr=False)

    def __repr__(self) -> str:
        doing = ", ".join(type(action).__name__ for action in self.actions[:8])
        more = ", ..." if len(self.actions) > 8 else ""
        return f"<pirsim.Person {self.id!r}: {self.stature_m:g} m, {self.style}, {len(self.actions)} actions: {doing}{more}>"


@dataclass(slots=True)
class Clock:
    """A time of day: normal, cut at three standard deviations."""

    mean_h: float = 0.0
    sd_min: float = 30.0


@dataclass(slots=True)
class Staff:
    """People of one role; seats: their own desks, none: the scene's free ones in order."""

    role: Literal["staff", "manager", "administrator"] = "staff"
    count: int = 1
    seats: list[str] = field(default_factory=list)
    where: Where = _where()


@dataclass(slots=True)
class HeldMeeting:
    """A meeting whose time is known."""

    at_h: float = 10.0
    duration_min: float = 60.0
    people: int = 4
    where: Where = _where()


@dataclass(slots=True)
class Meetings:
    """Meetings that are held in the room."""

    fewest_a_day: int = 2
    most_a_day: int = 6
    fewest_people: int = 2
    most_people: int | None = None
    """None: 8, or as many as there are seats."""
    durations_min: list[float] = field(default_factory=lambda: [30.0, 60.0, 90.0, 120.0])
    probabilities: list[float] = field(default_factory=lambda: [0.13, 0.70, 0.12, 0.05])
    from_h: float = 9.0
    to_h: float = 18.0
    lateness_min: float = 2.0
    held: list[HeldMeeting] = field(default_factory=list)
    """These, every working day, instead of drawn ones."""
    seats: list[str] = field(default_factory=list)
    """None given: those that are nobody's own desk."""
    where: Where = _where()


@dataclass(slots=True)
class Profile:
    """Presence as a Markov chain that follows a profile. presence: share present in each of 24 hours."""

    presence: list[float] = field(default_factory=list)
    mobility: float = 0.5
    step_min: float = 15.0


@dataclass(slots=True)
class Schedule:
    """Adds people whose actions are drawn anew for every run; replicates are days that follow each other."""

    first_day: str = "2026-03-02"
    from_h: float = 0.0
    to_h: float = 24.0
    staff: list[Staff] = field(default_factory=list)
    meetings: Meetings | None = None
    profile: Profile | None = None
    arrival: Clock = field(default_factory=lambda: Clock(8.5, 30.0))
    departure: Clock = field(default_factory=lambda: Clock(17.5, 30.0))
    lunch: Clock = field(default_factory=lambda: Clock(12.0, 30.0))
    lunch_min: float = 60.0
    lunch_sd_min: float = 15.0
    cleaning_h: float | None = None
    entrances: list[str] = field(default_factory=list)
    style: Literal["choreographed", "natural"] = "natural"
    where: Where = _where()


@dataclass(slots=True)
class Trial:
    """One choreography; a study runs every trial once per replicate."""

    id: str = ""
    people: list[Person] = field(default_factory=list)
    duration_s: float | None = None
    """Of a run; None: until everybody has carried out all actions."""
    schedule: Schedule | None = None

    def __repr__(self) -> str:
        who = _listed([person.id for person in self.people], "person", "people")
        if self.schedule is not None:
            who += " and a schedule"
        lasts = "" if self.duration_s is None else f", {self.duration_s:g} s"
        return f"<pirsim.Trial {self.id!r}: {who}{lasts}>"


@dataclass(slots=True)
class Sensing:
    """How sensors are read. A row covers `ticks_per_window` ticks."""

    tick_rate_hz: int = 50
    ticks_per_window: int = 50
    rays_per_zone: Literal[1, 5, 9, 16] = 5
    change_per: Literal["cluster", "beam"] = "cluster"
    reader: Literal["in_step", "free_running"] = "in_step"
    response: Literal["zones", "analog"] | None = None
    """Of all sensors; None: each its own."""
    ambient_c: float = 20.0
    analog_rays_per_zone: int = 34


@dataclass(slots=True)
class Summary:
    """Which rows the command line's --summary adds up, and what they are compared with."""

    phases: list[str] = field(default_factory=list)
    reference_file: str = ""


@dataclass(slots=True)
class Effect:
    """Something that the plain model leaves out; `pirsim.effects()` lists all. What isn't given is the typical value."""

    name: str = ""
    parameters: dict[str, float] = field(default_factory=dict)
    """By name with unit: {"sigma_deg": 1.0}."""
    choices: dict[str, str] = field(default_factory=dict)
    """{"sensor": "PIR3"}."""
    where: Where = _where()


@dataclass(slots=True)
class Script:
    """A study: people and their actions, the trials, how sensors are read."""

    name: str = ""
    trials: list[Trial] = field(default_factory=list)
    seed: int = 1
    replicates: int = 1
    sensing: Sensing = field(default_factory=Sensing)
    effects: list[Effect] = field(default_factory=list)
    summary: Summary = field(default_factory=Summary)
    begin: str = ""
    """Local date and time at which every run begins, "2026-03-02T07:00"; empty: no clock, or the schedule's."""
    directory: str = ""
    """Of the script file, for relative references."""
    files: list[InputFile] = field(default_factory=list)
    warnings: list[Diagnostic] = field(default_factory=list)

    def __repr__(self) -> str:
        effects = ", ".join(effect.name for effect in self.effects) or "none"
        return (f"<pirsim.Script {self.name!r}: seed {self.seed}, {self.replicates} replicates of "
                f"{_listed([trial.id for trial in self.trials], 'trial', 'trials')}\n  effects: {effects}\n  {self.sensing!r}>")
