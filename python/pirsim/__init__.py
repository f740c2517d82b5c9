"""pirsim: simulated passive-infrared motion sensors, with the true number of people beside every bit.

    import pirsim
    model = pirsim.compile("room.gltf", "study.yaml")
    result = pirsim.run(model)
    result.bits      # uint8 [run, second, sensor]
    result.people    # uint16 [run, second]

Scenes and scripts are files, or objects of `pirsim.specs`.
"""

from . import counting, errors, specs
from ._core import __version__, git_revision
from ._inputs import (EffectInfo, EffectParameter, data_directory, effects, facing, read_scene, read_script,
                      sensor_model, write_scene, write_script)
from ._logs import LightCosts, Log, LogLengths, LogPair, LogSensor, control, read_log
from ._reconcile import Candidate, Cell, FittedEffect, Reconciliation, reconcile
from ._result import Fault, Incident, Result
from ._study import Model, Poses, Rays, Trace, compile, dataset, room, run, trace
from ._surveys import (CoverageMap, Findings, Grid, Page, Picture, PlacementLight, Placements, PlacementScore,
                       SensorSight, WalkTest, check, coverage, export, placements, preview, view, walk_test)
from .errors import (Error, ErrorCode, FileError, IncompleteWarning, InfeasibleError, InputError, InputWarning,
                     InternalError, UsageError)
from .specs import (Action, Amplifier, Appear, Area, AreaCounts, Clock, Cluster, Comparator, Counts, Detector,
                    Diagnostic, Door, Effect, Element, Enter, Entrance, Floor, Follow, Frame, HeldMeeting, Household,
                    InputFile, Leave, Lie, Meetings, Mesh, Occupancy, Optics, Person, Place, Places, Positions,
                    Resident, Rise, Scene, Schedule, Script, Seat, SeatScatter, Sensing, Sensor, SensorModel, Sit,
                    Staff, Stand, Stay, Summary, Track, Trial, Turn, Wait, Walk, Warmth, Where, Work, Zone)

__all__ = [
    "Action", "Amplifier", "Appear", "Area", "AreaCounts", "Candidate", "Cell", "Clock", "Cluster",
    "Comparator", "Counts", "CoverageMap", "Detector", "Diagnostic", "Door", "Effect", "EffectInfo",
    "EffectParameter", "Element", "Enter", "Entrance", "Error", "ErrorCode", "Fault", "FileError", "Findings",
    "FittedEffect", "Floor", "Follow", "Frame", "Grid", "HeldMeeting", "Household", "Incident",
    "IncompleteWarning", "InfeasibleError", "InputError", "InputFile", "InputWarning", "InternalError", "Leave",
    "Lie", "LightCosts", "Log", "LogLengths", "LogPair", "LogSensor", "Meetings", "Mesh", "Model", "Occupancy",
    "Optics", "Page", "Person", "Picture", "Place", "PlacementLight", "PlacementScore", "Placements", "Places", "Poses",
    "Positions", "Rays", "Reconciliation", "Resident", "Result", "Rise", "Scene", "Schedule",
    "Script", "Seat", "SeatScatter", "Sensing", "Sensor", "SensorModel", "SensorSight", "Sit", "Staff", "Stand",
    "Stay", "Summary", "Trace", "Track", "Trial", "Turn", "UsageError", "Wait", "Walk", "WalkTest", "Warmth",
    "Where", "Work", "Zone", "__version__", "check", "compile", "control", "counting", "coverage",
    "data_directory", "dataset", "effects", "errors", "export", "facing", "git_revision", "placements",
    "preview", "read_log", "read_scene", "read_script", "reconcile", "room", "run", "sensor_model", "specs",
    "trace", "view", "walk_test", "write_scene", "write_script",
]
