"""Scenes and scripts as plain objects: read from files, changed, or made from nothing.

Each class is one of the library's specs, with the same fields, units and defaults; a field's name ends in its unit.
Points are (x, y, z) in metres in glTF's frame (right-handed, +Y up, floor in XZ), floor points are (x, z). Lists and
dicts are ordinary ones. Nothing is checked before `pirsim.compile()`, which then names what it refuses.

Written by tools/specs/write.py from src/model/schema/fields.hpp; what has a form of its own is in _spec_parts.py.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Sequence, Union

from . import _spec_parts
from ._spec_parts import Diagnostic, Floor, Frame, Mesh, Point2, Point3

if TYPE_CHECKING:
    from ._core import MeshSolid

__all__ = [
    "Action", "Activity", "Amplifier", "Appear", "Area", "AreaCounts", "Array", "Clock", "Cluster", "Comparator",
    "Counts", "Detector", "Diagnostic", "Door", "Effect", "Element", "Enter", "Entrance", "Floor", "Follow", "Frame",
    "HeldMeeting", "Household", "InputFile", "Leave", "Lie", "Meetings", "Mesh", "Occupancy", "Optics", "Person", "Pet",
    "Place", "Places", "Point2", "Point3", "Positions", "RatedTarget", "Report", "Resident", "Rise", "Scene",
    "Schedule", "Script", "Seat", "SeatScatter", "Sensing", "Sensitivity", "Sensor", "SensorModel", "Sit", "Staff",
    "Stand", "Stay", "Summary", "Track", "Trial", "Turn", "Wait", "Walk", "Warmth", "Where", "Work", "Zone",
]


def _where() -> Any:
    return field(default_factory=Where, repr=False, compare=False, kw_only=True)


Activity = Literal["typing", "reading", "meeting", "phone", "whiteboard", "sleeping", "watching_tv", "cooking", "washing", "eating"]
"""What people of natural style are busy with; each action knows some of them."""


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


@dataclass(slots=True)
class Sensor:
    """A sensor looks along its frame's -Z."""

    id: str = ""
    model: str = ""
    """Key into `Scene.sensor_models`."""
    world_from_sensor: Frame = field(default_factory=Frame)
    gain: float = 1.0
    """Of its signal, relative to what its make's rated distances say; for the analog response."""
    area: str | None = None
    """Id of the area that it watches; none: the one below it."""


@dataclass(slots=True)
class Seat:
    """The sitter's pelvis rests at the origin and faces -Z."""

    id: str = ""
    world_from_seat: Frame = field(default_factory=Frame)
    uses: list[str] = field(default_factory=list)
    """`for` of a mark; none: for anything."""


@dataclass(slots=True)
class Place:
    """A place to lie (the pelvis on the origin, the head towards +Z) or to stand (facing -Z). One to sit is a
    `Seat`."""

    id: str = ""
    posture: Literal["lie", "stand"] = "lie"
    world_from_place: Frame = field(default_factory=Frame)
    uses: list[str] = field(default_factory=list)
    """`for` of a mark; none: for anything."""


@dataclass(slots=True)
class Entrance:
    """A doorway: the origin is the middle of the threshold, -Z points into the room."""

    id: str = ""
    world_from_entrance: Frame = field(default_factory=Frame)
    width_m: float = 0.9
    """Of the opening."""
    outside_m: float = 1.5
    """How far behind it people wait."""


@dataclass(slots=True)
class Door:
    """A door with a leaf: the origin is the middle of the threshold, -Z leads through the opening."""

    id: str = ""
    world_from_door: Frame = field(default_factory=Frame)
    width_m: float = 0.8
    """Of the leaf."""
    height_m: float = 2.0
    """Of the leaf."""
    thickness_m: float = 0.04
    """Of the leaf."""
    hinge: Literal["left", "right"] = "left"
    """At which side whoever goes through along -Z sees it: `left` or `right`."""
    opens: Literal["inward", "outward"] = "inward"
    """To which side: `inward`, where -Z points, or `outward`."""
    open_deg: float = 90.0
    """How far the leaf turns."""
    turn_s: float = 1.0
    """How long that takes."""
    state: Literal["open", "shut", "habit"] = "habit"
    """As people leave it: `open`, `shut`, or by `habit`."""
    shut_share: float = 0.8
    """By habit: share of passes after which it is shut at once."""
    stands_open_s: float = 300.0
    """By habit: how long it stands open after the others."""


@dataclass(slots=True)
class Optics:
    """What the physical response needs of a lens beyond its zones."""

    blur_deg: float = 0.5
    """Standard deviation of the Gaussian that softens a zone's edges."""
    aperture_mm2: float = 20.0
    """Area of a facet of the first lens step."""


@dataclass(slots=True)
class Element:
    """The pyroelectric element's time constants."""

    thermal_s: float = 0.15
    """Thermal time constant."""
    electrical_s: float = 1.0
    """Electrical time constant."""


@dataclass(slots=True)
class Amplifier:
    """A band-pass with noise."""

    low_hz: float = 0.3
    """Lower corner frequency (-3 dB)."""
    high_hz: float = 6.5
    """Upper corner frequency (-3 dB)."""
    order: int = 2
    """One-pole sections per edge, 1 to 3."""
    volts_per_watt: float | None = None
    """Total gain from the power on the element to the output; by default calibrated on the rated distance of the first
    lens step."""
    noise_v_pp: float = 0.08
    """Noise at the output, peak to peak (6.6 standard deviations); 0: none."""
    offset_v: float = 1.1
    """Output at rest."""
    lowest_v: float = 0.2
    """Where the output saturates at its lower end."""
    highest_v: float = 1.9
    """Where the output saturates at its upper end."""


@dataclass(slots=True)
class Comparator:
    """When the amplified signal switches the output on and off."""

    positive_v: float = 0.45
    """Threshold above the offset."""
    negative_v: float = 0.45
    """Threshold below the offset, as a positive number."""
    pulse_count: int = 1
    """Number of pulses that switches the output on, 1 to 8."""
    pulse_window_s: float = 0.0
    """Time within which the pulses must begin; required for more than one pulse."""
    pulse_signs: Literal["any", "alternating"] = "any"
    """`alternating`: a pulse counts only on the opposite side to the last."""


@dataclass(slots=True)
class Report:
    """When a device says that there is motion, and for how long."""

    hold_s: float = 0.0
    """How long it goes on after the last motion that counts."""
    again_s: float = 0.0
    """How long after motion that counted other motion doesn't; 0: the hold re-triggers."""
    blind_s: float = 0.0
    """How long motion is ignored after it has ended."""


@dataclass(slots=True)
class Detector:
    """A sensor's electronics, for the physical response."""

    element: Element = field(default_factory=Element)
    amplifier: Amplifier = field(default_factory=Amplifier)
    comparator: Comparator = field(default_factory=Comparator)
    report: Report = field(default_factory=Report)


@dataclass(slots=True)
class Zone:
    """A detection zone, drawn on the plane `plane_m` ahead of the sensor: four corners (x right, y up), metres."""

    corners: Sequence[Point2] = ((0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.0))
    """In order round the zone, convex."""
    polarity: int = 1
    """+1 or -1, the sign of the element."""


@dataclass(slots=True)
class Cluster:
    """The zones of one facet of the lens."""

    centre: Point2 = (0.0, 0.0)
    """On the plane."""
    range_m: float = 0.0
    """Rated detection distance."""
    lens_step: int = 1
    """Row of the lens: 1 reaches farthest."""
    zones: list[Zone] = field(default_factory=list, repr=False)


@dataclass(slots=True)
class RatedTarget:
    """The plate that facets of one lens step just detect at their rated distance."""

    lens_step: int = 1
    """Of which facets."""
    width_m: float = 0.25
    """Of the plate."""
    height_m: float = 0.7
    """Of the plate."""
    speed_m_s: float = 1.0
    """Sideways."""
    contrast_k: float = 4.0
    """By how much it is warmer than what is behind it."""
    zones: int = 2
    """That it crosses."""


@dataclass(slots=True)
class Sensitivity:
    """How sensitive sensors of this make are where they hang, relative to what the rated distances tell; log-normal."""

    median: float = 1.0
    """Over rooms and units."""
    installation_sd: float = 0.0
    """Standard deviation of the logarithm over rooms."""
    sd: float = 0.0
    """Of the logarithm over the units of a room."""


@dataclass(slots=True)
class Array:
    """A thermopile array: what each pixel sees, as a temperature."""

    rows: int = 8
    """Of pixels."""
    columns: int = 8
    """Of pixels."""
    wide_deg: float = 60.0
    """Field of view from the left edge to the right."""
    tall_deg: float = 60.0
    """From the upper edge to the lower."""
    pixel_deg: float | None = None
    """Full width at half of a pixel's Gaussian response; by default as far as from pixel to pixel."""
    rate_hz: float = 1.0
    """Frames a second; with two sub-pages, sub-pages."""
    sub_pages: int = 1
    """2: each frame renews every other pixel, as the squares of a chess board."""
    netd_k: float = 0.0
    """Noise of one pixel at 1 frame/s, rms; it grows as the root of the rate."""
    centre_noise: float = 1.0
    """Times that, in the middle."""
    corner_noise: float = 1.0
    """Times that, in a corner."""
    common_k: float = 0.0
    """Noise at 1 frame/s, rms, that all pixels of one frame have in common."""
    offset_k: float = 0.0
    """Rms over units of what all pixels are off."""
    column_k: float = 0.0
    """Rms of what the pixels of one column are always off."""
    fixed_k: float = 0.0
    """Rms of what one pixel is always off."""
    dead_pixels: int = 0
    """Of a unit; they read nothing."""
    step_k: float = 0.0
    """Readings are multiples of it; 0: any number."""
    from_um: float = 5.0
    """Shortest wavelength that the window lets through."""
    to_um: float = 14.0
    """Longest one."""
    rays_per_pixel: int = 24
    """All pixels share the rays of the whole field."""


@dataclass(slots=True)
class SensorModel:
    """A sensor's lens and electronics. `pirsim.sensor_model()` has the shipped ones."""

    id: str = ""
    """As scenes name it."""
    description: str = ""
    """Free text."""
    names: list[str] = field(default_factory=list)
    """Of products that carry it."""
    plane_m: float = 1.0
    """Distance of the plane on which the zones are drawn."""
    clusters: list[Cluster] = field(default_factory=list)
    targets: list[RatedTarget] = field(default_factory=list)
    """Of lens steps whose rated target isn't the usual one."""
    sensitivity: Sensitivity = field(default_factory=Sensitivity)
    """Of sensors where they hang, relative to what is rated."""
    response: Literal["zones", "analog", "beam"] = "analog"
    """`zones`: a change of activity is motion; `analog`: the physical response; `beam`: a light barrier."""
    optics: Optics = field(default_factory=Optics)
    """For the physical response."""
    detector: Detector = field(default_factory=Detector)
    """Electronics, for the physical response."""
    idle_share: float = 1.0
    """Of a beam: what is nearer than this share of the distance to the room breaks it."""
    array: Array | None = None
    """It is a thermopile array, which `Scene.arrays` name."""

    def __repr__(self) -> str:
        return _spec_parts.sensor_model_text(self)


@dataclass(slots=True)
class Area:
    """A named part of the floor: people are counted in each."""

    id: str = ""
    outline: Floor = field(default_factory=Floor)


@dataclass(slots=True)
class Scene:
    """A room: what hides, where the sensors hang, where people sit, enter and walk."""

    name: str = ""
    meshes: list[Mesh] = field(default_factory=list)
    sensors: list[Sensor] = field(default_factory=list)
    """In the order of the output's columns."""
    seats: list[Seat] = field(default_factory=list)
    places: list[Place] = field(default_factory=list)
    """To lie and to stand."""
    entrances: list[Entrance] = field(default_factory=list)
    doors: list[Door] = field(default_factory=list)
    floor: Floor = field(default_factory=Floor)
    areas: list[Area] = field(default_factory=list)
    """Apart from each other, in the order of the output's columns."""
    sensor_models: dict[str, SensorModel] = field(default_factory=dict)
    """Every model that a sensor names."""
    arrays: list[Sensor] = field(default_factory=list)
    """Sensors that give frames instead of a column."""
    files: list[InputFile] = field(default_factory=list)
    """All that was read."""
    warnings: list[Diagnostic] = field(default_factory=list)

    def __repr__(self) -> str:
        return _spec_parts.scene_text(self)


@dataclass(slots=True, kw_only=True)
class _Action:
    """An action and when it begins."""

    at_s: float | None = None
    """Starts then: interrupts what goes on, or waits if that is already done."""
    phase: str = ""
    """Label of rows while this action runs; empty: what the body is doing."""
    where: Where = _where()


@dataclass(slots=True)
class Wait(_Action):
    """Goes on standing, sitting or lying."""

    duration_s: float = 0.0
    activity: Activity | None = None
    """One of meeting, phone, whiteboard, reading, sleeping, watching_tv, cooking, washing, eating; of natural style."""


@dataclass(slots=True)
class Appear(_Action):
    """Is there from now on, without having entered: stands at the point, or is at the place as its posture says."""

    point: Point2 = (0.0, 0.0)
    heading_deg: float = 0.0
    """0 facing -Z, positive turning left."""
    place: str = ""
    """Or seat, instead of a point."""
    posture: Literal["back", "left_side", "right_side", "half_lying"] = "back"
    """At a place to lie."""


@dataclass(slots=True)
class Enter(_Action):
    """Appears outside the entrance and walks in."""

    entrance: str = ""


@dataclass(slots=True)
class Walk(_Action):
    """Walks to each of the floor points in turn."""

    points: list[Point2] = field(default_factory=list)
    activity: Activity | None = None
    """One of phone; of natural style."""


@dataclass(slots=True)
class Sit(_Action):
    """Walks to the seat, turns and sits down; waits for it for a while if somebody else has it."""

    seat: str = ""
    wait_s: float = 120.0
    """For a taken seat; no longer if all others have carried out their scripts."""
    if_taken: Literal["next_action", "other_seat"] = "next_action"
    """What somebody does whose seat stays taken."""


@dataclass(slots=True)
class Work(_Action):
    """Desk work while seated: both forearms slide on the table, the spine changes its tilt."""

    duration_s: float = 180.0
    arm_amplitude_m: float = 0.1
    arm_period_s: float = 3.0
    tilt_choices_deg: list[float] = field(default_factory=lambda: [-15.0, 0.0, 15.0])
    """Positive forward."""
    tilt_every_s: float = 30.0
    activity: Activity | None = None
    """One of typing, reading, meeting, phone; of natural style, which has no use for the swing and the tilts; none:
    typing."""


@dataclass(slots=True)
class Rise(_Action):
    """Rises from where one sits or lies, and stays standing beside it."""


@dataclass(slots=True)
class Leave(_Action):
    """Walks out through the entrance and disappears."""

    entrance: str = ""


@dataclass(slots=True)
class Turn(_Action):
    """Stands on the spot and turns."""

    heading_deg: float = 0.0
    """0 facing -Z, positive turning left."""


@dataclass(slots=True)
class Follow(_Action):
    """Is at these points at these times, and straight between them: appears at the first, vanishes after the last."""

    times_s: list[float] = field(default_factory=list)
    """Of the run, ascending."""
    points: list[Point2] = field(default_factory=list)
    headings_deg: list[float] = field(default_factory=list)
    """At each of them, or none: facing where they go."""


@dataclass(slots=True)
class Lie(_Action):
    """Walks to a place to lie, sits down on its edge and swings the legs in."""

    place: str = ""
    posture: Literal["back", "left_side", "right_side", "half_lying"] = "back"
    wait_s: float = 120.0
    """For a taken place."""


@dataclass(slots=True)
class Stand(_Action):
    """Walks to a place to stand at, and faces as it does."""

    place: str = ""
    wait_s: float = 120.0
    """For a taken place."""


Action = Union[Wait, Appear, Enter, Walk, Sit, Work, Rise, Leave, Turn, Follow, Lie, Stand]


@dataclass(slots=True)
class SeatScatter:
    """How far from the seat's place people sit down, drawn once a run and person."""

    position_sd_m: float = 0.0
    """Of each horizontal coordinate."""
    heading_sd_deg: float = 0.0


@dataclass(slots=True)
class Warmth:
    """How warm a person's surface is, for the physical response."""

    skin_c: float | None = None
    """None: as the air's temperature has it."""
    skin_above_k: float = 0.0
    """By how much it is then warmer than others'."""
    clothing_clo: float = 0.61
    """Insulation of the whole outfit."""
    bare: list[str] = field(default_factory=lambda: ["head"])
    """Parts that show skin; hands always do."""
    hair_share: float = 0.5
    """Of a bare head's surface that hair covers."""
    parts_c: dict[str, float] = field(default_factory=dict)
    """Surface temperatures that are known, by part."""


@dataclass(slots=True)
class Person:
    """A person and what they do, one action after the other."""

    id: str = ""
    actions: list[Action] = field(default_factory=list)
    stature_m: float = 1.86
    """Lengths of the body follow from it."""
    mass_kg: float = 80.0
    walking_speed_m_s: float = 1.0
    seat_scatter: SeatScatter = field(default_factory=SeatScatter)
    style: Literal["choreographed", "natural"] = "choreographed"
    warmth: Warmth = field(default_factory=Warmth)
    body_mesh_file: str = ""
    """glTF, relative to `Script.directory`; its meshes are read by `read_script()`."""
    body_meshes: dict[str, MeshSolid] = field(default_factory=dict, repr=False)

    def __repr__(self) -> str:
        return _spec_parts.person_text(self)


@dataclass(slots=True)
class Clock:
    """A time of day: normal, cut at three standard deviations."""

    mean_h: float = 0.0
    sd_min: float = 30.0


@dataclass(slots=True)
class Staff:
    """People of one role."""

    role: Literal["staff", "manager", "administrator"] = "staff"
    count: int = 1
    seats: list[str] = field(default_factory=list)
    """Their own desks; none: the scene's seats that nobody has, in order."""
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
    """Meetings that are held in a room."""

    attendees: Literal["guests", "staff"] = "guests"
    """Who sits in them: people who come for them, or the staff."""
    area: str = ""
    """Where the room is one of several."""
    fewest_a_day: int = 2
    most_a_day: int = 6
    fewest_people: int = 2
    most_people: int | None = None
    """None: 8, or as many as there are seats."""
    durations_min: list[float] = field(default_factory=lambda: [30.0, 60.0, 90.0, 120.0])
    probabilities: list[float] = field(default_factory=lambda: [0.13, 0.7, 0.12, 0.05])
    """Of each duration."""
    from_h: float = 9.0
    """When the first may begin."""
    to_h: float = 18.0
    """When the last has ended."""
    lateness_min: float = 2.0
    """Mean of how much later than its beginning people come."""
    held: list[HeldMeeting] = field(default_factory=list)
    """These, every working day, instead of drawn ones."""
    seats: list[str] = field(default_factory=list)
    """None: those of the area that are nobody's own desk."""
    where: Where = _where()


@dataclass(slots=True)
class Resident:
    """Somebody who lives in a home."""

    id: str = ""
    """As `--occupants` names them."""
    occupation: Literal["works", "at_home", "works_at_home"] = "at_home"
    age_years: float = 45.0
    """How often they get up at night goes by it."""
    bed: str = ""
    """A place to lie; empty: one of the scene's for sleep that nobody has, in order."""
    where: Where = _where()


@dataclass(slots=True)
class Household:
    """Who lives in a home; their days go from 04:00 to 04:00."""

    residents: list[Resident] = field(default_factory=list)
    """One to five."""
    visits_a_week: float = 1.0
    """Evenings on which somebody comes."""
    wakes: Clock = field(default_factory=lambda: Clock(mean_h=7.0))
    """On working days."""
    wakes_on_free_days: Clock = field(default_factory=lambda: Clock(mean_h=8.5, sd_min=45.0))
    goes_to_bed: Clock = field(default_factory=lambda: Clock(mean_h=23.0))
    leaves: Clock = field(default_factory=lambda: Clock(mean_h=8.25, sd_min=20.0))
    """Who works, on working days; who works at home begins then."""
    comes_home: Clock = field(default_factory=lambda: Clock(mean_h=17.25, sd_min=40.0))
    lunch: Clock = field(default_factory=lambda: Clock(mean_h=13.0, sd_min=20.0))
    dinner: Clock = field(default_factory=lambda: Clock(mean_h=19.5))


@dataclass(slots=True)
class Schedule:
    """Adds people whose actions are drawn anew for every run; replicates are days that follow each other."""

    first_day: str = "2026-03-02"
    """ISO 8601."""
    from_h: float = 0.0
    """The part of the day that a run simulates begins."""
    to_h: float = 24.0
    """And ends; with a household 28, four o'clock of the next day."""
    staff: list[Staff] = field(default_factory=list)
    meetings: list[Meetings] = field(default_factory=list)
    """Of each room in which some are held."""
    household: Household | None = None
    """Instead of staff, meetings and cleaning."""
    arrival: Clock = field(default_factory=lambda: Clock(mean_h=8.5))
    departure: Clock = field(default_factory=lambda: Clock(mean_h=17.5))
    lunch: Clock = field(default_factory=lambda: Clock(mean_h=12.0))
    lunch_min: float = 60.0
    """Mean of its length."""
    lunch_sd_min: float = 15.0
    cleaning_h: float | None = None
    """Somebody cleans then, on working days."""
    entrances: list[str] = field(default_factory=list)
    """That people use, each their own; none: all of the scene."""
    style: Literal["choreographed", "natural"] = "natural"
    where: Where = _where()


@dataclass(slots=True)
class AreaCounts:
    """How many people were in one area, at the moments of `Counts.times_s`."""

    area: str = ""
    """Its id."""
    people: list[int] = field(default_factory=list)
    """At each moment."""
    column: str = ""
    """Of `Counts.file`."""


@dataclass(slots=True)
class Counts:
    """How many people were there, at moments."""

    times_s: list[float] = field(default_factory=list)
    """Ascending."""
    people: list[int] = field(default_factory=list)
    """At each of them, in all."""
    areas: list[AreaCounts] = field(default_factory=list)
    """Counted by themselves; the rest of the people are elsewhere."""
    begin: str = ""
    """Local date and time of `times_s` 0; empty: they are seconds of the run."""
    file: str = ""
    """CSV, or empty; relative to `Script.directory`; `read_script()` reads it."""
    time: str = ""
    """Its column of times; empty: found by its usual names."""
    column: str = ""
    """Its column of people; empty: found by its usual names."""
    most: Where = field(default_factory=Where)


@dataclass(slots=True)
class Stay:
    """Somebody at one place for a while."""

    person: str = ""
    seat: str = ""
    """Or empty: on foot."""
    from_s: float = 0.0
    to_s: float = 0.0
    points: list[Point2] = field(default_factory=list)
    """Where they were at `from_s` and at `to_s`, if that is known."""
    then: Literal["goes_on", "leaves"] = "goes_on"
    """To the person's next stay, or outside until that begins."""
    where: Where = _where()


@dataclass(slots=True)
class Places:
    """Who took which seat, and when."""

    stays: list[Stay] = field(default_factory=list)
    """Of each person in order of time."""
    begin: str = ""
    """Local date and time of second 0; empty: seconds of the run."""
    file: str = ""
    """CSV, or empty; relative to `Script.directory`."""


@dataclass(slots=True)
class Track:
    """Where one person was, from moment to moment."""

    person: str = ""
    times_s: list[float] = field(default_factory=list)
    """Ascending."""
    points: list[Point2] = field(default_factory=list)
    """At each of them."""
    headings_deg: list[float] = field(default_factory=list)
    """At each of them; empty: facing where they go."""
    where: Where = _where()


@dataclass(slots=True)
class Positions:
    """Tracked people, who go where they went."""

    tracks: list[Track] = field(default_factory=list)
    begin: str = ""
    """Local date and time of second 0; empty: seconds of the run."""
    file: str = ""
    """CSV, or empty; relative to `Script.directory`."""


@dataclass(slots=True)
class Occupancy:
    """Adds people who are there as data say: one of `counts`, `places` and `positions`."""

    counts: Counts | None = None
    """Who comes, when within an interval, and where they sit is drawn anew for every run."""
    places: Places | None = None
    positions: Positions | None = None
    from_h: float | None = None
    """With either, replicates are the days of the data, each from here."""
    to_h: float | None = None
    """To there."""
    changes_within_s: float | None = None
    """Of counts: a change happened at most so long before its reading; none: since the reading before."""
    persons: int | None = None
    """Of counts: how many different ones come; none: as many as are ever there."""
    seats: list[str] = field(default_factory=list)
    """Of counts: that may be taken; none: all of the scene."""
    entrances: list[str] = field(default_factory=list)
    """That people use; none: all of the scene."""
    style: Literal["choreographed", "natural"] = "natural"
    where: Where = _where()


@dataclass(slots=True)
class Pet:
    """An animal that moves by itself; nobody counts it."""

    id: str = ""
    """Default: its kind."""
    kind: Literal["cat", "dog"] = "cat"
    height_m: float | None = None
    """Of the back, standing; none: as the kind usually is."""
    length_m: float | None = None
    """Nose to rump; the same."""
    mass_kg: float | None = None
    """The same."""
    where: Where = _where()


@dataclass(slots=True)
class Trial:
    """One choreography; a study runs every trial once per replicate."""

    id: str = ""
    """As the output names it."""
    people: list[Person] = field(default_factory=list)
    """The first one's actions name the rows' phase."""
    duration_s: float | None = None
    """Of a run; none: until everybody has carried out all actions."""
    schedule: Schedule | None = None
    occupancy: Occupancy | None = None
    pets: list[Pet] = field(default_factory=list)
    """Move by themselves."""

    def __repr__(self) -> str:
        return _spec_parts.trial_text(self)


@dataclass(slots=True)
class Sensing:
    """How sensors are read."""

    tick_rate_hz: int = 50
    ticks_per_window: int = 50
    """A row and its bits cover this many ticks."""
    rays_per_zone: Literal[1, 5, 9, 16] = 5
    change_per: Literal["cluster", "beam"] = "cluster"
    """Whose change of activity is motion."""
    reader: Literal["in_step", "free_running"] = "in_step"
    """When in a window each sensor is asked."""
    response: Literal["zones", "analog", "beam"] | None = None
    """One of zones, analog; of all sensors but beams; none: each its own."""
    units: Literal["typical", "low", "guaranteed", "drawn"] = "typical"
    """How sensitive analog sensors are: `typical` of their make, `low`, which nine in ten exceed, as rated
    (`guaranteed`), or `drawn`."""
    ambient_c: float = 23.0
    """Of surfaces and of the air, where the scene says nothing else."""
    analog_rays_per_zone: int = 34
    """In the physical response."""
    frame_rate_hz: float | None = None
    """Of all arrays; none: each its own."""


@dataclass(slots=True)
class Summary:
    """Which rows the command line's --summary adds up, and what they are compared with."""

    phases: list[str] = field(default_factory=list)
    """Rows in these phases count."""
    reference_file: str = ""
    """CSV with measured sums, or empty; beside the script, or a shipped one."""
    where: Where = _where()


@dataclass(slots=True)
class Effect:
    """Something that the plain model leaves out; `pirsim.effects()` lists all. What isn't given is the typical
    value."""

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
    """All that was read."""
    warnings: list[Diagnostic] = field(default_factory=list)

    def __repr__(self) -> str:
        return _spec_parts.script_text(self)
