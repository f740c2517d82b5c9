"""Reading scenes, scripts and sensors, writing scripts, and the catalogue of effects."""

from __future__ import annotations

from typing import Iterable, Literal, NamedTuple

from . import _core
from ._files import write
from ._study import Overrides, PathOr, as_file, as_overrides, as_path, as_scene, data_directory, folders
from .specs import Frame, Point3, Scene, Script, SensorModel


class EffectParameter(NamedTuple):
    """A parameter of an effect. least, most: what is accepted; off: with all at it nothing happens."""

    name: str
    unit: str
    off: float
    typical: float
    least: float
    most: float
    source: str


class EffectInfo(NamedTuple):
    """An entry of the catalogue of effects."""

    name: str
    family: str
    summary: str
    reach: Literal["geometry", "triggers", "rows"]
    """Those that reach the geometry need a model of their own; the others can be emitted from a trace."""
    parameters: tuple[EffectParameter, ...]
    choices: tuple[str, ...]

    def __repr__(self) -> str:
        settings = ", ".join([parameter.name for parameter in self.parameters] + list(self.choices))
        return f"<pirsim.EffectInfo {self.name!r} ({self.family}, reaches {self.reach}): {settings}>"


def read_scene(file: PathOr, *, sensors: PathOr | Iterable[PathOr] | None = None,
               marks: PathOr | None = None) -> Scene:
    """Reads a glTF file. Raises FileError and InputError. sensors, marks: as in compile()."""
    return _core.read_scene(as_scene(as_path(file), marks), *folders(sensors))


def read_script(file: PathOr, *, set: Overrides | None = None) -> Script:
    """Reads a script's YAML file, with trials and people written out. Raises FileError and InputError."""
    return _core.read_script(as_file(file, "studies"), as_overrides(set), [data_directory])


def write_scene(scene: Scene, file: PathOr) -> None:
    """Writes a scene as glTF (.glb, or .gltf with its buffer in it); positions in single precision."""
    _core.write_scene(scene, as_path(file))


def write_script(script: Script, file: PathOr) -> None:
    """Writes a script as YAML for the command line."""
    write(file, _core.to_yaml(script))


def sensor_model(name: PathOr, *, sensors: PathOr | Iterable[PathOr] | None = None) -> SensorModel:
    """A sensor model by its name ("EKMC1604111"), or from a file (.yaml)."""
    if (text := as_path(name)).endswith(".yaml"):
        return _core.read_sensor_model(as_file(text, "sensors"))
    return _core.find_sensor_model(text, *folders(sensors))


def facing(position: Point3, heading_deg: float = 0.0, tilt_deg: float = 0.0) -> Frame:
    """The frame of something at a place (metres) that faces a heading: 0 along -Z, positive turning left (seen from
    above). tilt_deg: downwards, as of a sensor on a wall."""
    return _core.mounted(position, heading_deg, tilt_deg)


def effects() -> list[EffectInfo]:
    """What a script's effects can be, in the order in which they act."""
    return [EffectInfo(name, family, summary, reach, tuple(EffectParameter(*p) for p in parameters), tuple(choices))
            for name, family, summary, reach, parameters, choices in _core.catalogue()]
