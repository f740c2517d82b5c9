#!/usr/bin/python3
"""Whole days of rooms as the logs that people have, measured by the second simulator's sensors.

    own_rooms.py PIRSIM RECIPE -o DIR [--rooms N] [--days D] [--seed N] [--plain]

Rooms, people and their motion are pirsim's: `pirsim dataset` draws them from the recipe, without its effects, and
`pirsim export` tells where everybody is at each tick. What sensors make of this is the second simulator's, and each room
has faults of its own (AsWired). Every room gets the log of its first day without a count, its days with counts, and what
was drawn; README.md has the layout. A room that is there already is left as it is.
"""
import argparse
import csv
import dataclasses
import datetime
import gzip
import json
import pathlib
import sys
import tempfile
import zoneinfo

import numpy as np

import faults
import second_simulator as second
from long_runs import covered_in_blocks

SENSOR_FILES = pathlib.Path(__file__).parents[2] / "data/sensors"
RATE_HZ, READING_S, PART_S = 10, 30, 3600
ZONE = "Europe/Berlin"  # of the rooms' clocks; assumed
SETTINGS = (f"sensing.tick_rate_hz={RATE_HZ}", "sensing.response=zones", "sensing.change_per=cluster", "effects=[]",
            "exports=[]", "occupants=false", "rows=.csv.gz")


# ------------------------------------------------------------------------------------------------------------- sensors
@dataclasses.dataclass
class AsWired:
    """What is wrong with one room's sensors. All ranges are assumed: wider than those of the recipes, because whoever
    writes a recipe doesn't know what these sensors do."""

    range_scale: float = 1.0
    heard: float = 1.0  # chance that the comparator notices one changed cluster at one tick
    blind_s: float = 0.0  # after a trigger
    hold_s: float = 0.0  # of the output, after the last trigger
    false_per_s: tuple = ()  # of each sensor
    yaw_deg: tuple = ()  # off the scene's
    tilt_deg: tuple = ()

    @staticmethod
    def plain(n_sensors):
        return AsWired(false_per_s=(0.0,) * n_sensors, yaw_deg=(0.0,) * n_sensors, tilt_deg=(0.0,) * n_sensors)

    @staticmethod
    def drawn(draw, n_sensors):
        each = lambda low, high: tuple(draw.uniform(low, high, n_sensors).tolist())
        some = lambda chance, low, high: float(draw.uniform(low, high) * (draw.random() < chance))
        return AsWired(
            range_scale=draw.uniform(0.75, 1.4),
            heard=draw.uniform(0.15, 1),
            blind_s=some(0.5, 0.5, 5),
            hold_s=30 * draw.uniform(0, 1) ** 2,  # a third of the rooms below 3.3 s, a third above 13 s
            false_per_s=tuple(some(0.5, 0, 1 / 600) for _ in range(n_sensors)),
            yaw_deg=each(-4, 4),
            tilt_deg=each(-3, 3))

    def fault(self):
        def electronics(triggers, rate_hz, random):
            triggers = faults.noisy(np.array(self.false_per_s))(triggers, rate_hz, random)
            triggers = faults.blind_after(self.blind_s)(triggers, rate_hz, random)
            return faults.held_on(self.hold_s)(triggers, rate_hz, random)

        return faults.Fault(
            "a room's own sensors", range_scale=self.range_scale, detect=faults.heard(self.heard), electronics=electronics,
            mount=lambda number, world: faults.hung(world, self.yaw_deg[number], self.tilt_deg[number]))


class Day:
    """A day of pirsim's dataset: its rows, and what the second simulator's sensors say at each tick."""

    def __init__(self, pirsim, dataset, room, number):
        self.pirsim, self.number = pirsim, number
        self.study = second.study_of(dataset / f"rooms/{room}.gltf", dataset / f"scripts/{room}/day_{number:02}.yaml", [])
        with gzip.open(dataset / f"rows/{room}/day_{number:02}.csv.gz", "rt") as file:
            self.rows = list(csv.DictReader(file))
        first = self.rows[0]
        self.window_s = float(first["time_s"])
        self.begin = datetime.datetime.fromisoformat(first["time"]) - datetime.timedelta(seconds=self.window_s)

    def shares(self, rays):
        """(ticks, clusters) As `covered_shares`, an hour at a time."""
        parts = []
        with tempfile.TemporaryDirectory() as folder:
            film = pathlib.Path(folder) / "day.glb"
            second.run_pirsim(self.pirsim, self.study, "export", "-q", "--replicate", self.number, "--keys-per-s", RATE_HZ,
                              "--beams", "none", "--large", "-o", film)
            exported = second.Gltf(film)
            n_ticks = round(len(self.rows) * self.window_s * RATE_HZ)
            for tick in range(0, n_ticks, PART_S * RATE_HZ):
                ticks = slice(tick, min(tick + PART_S * RATE_HZ, n_ticks) + 1)  # the last one is the next part's first
                part = second.covered_shares(rays, second.Motion(exported, ticks), covered_in_blocks)
                parts.append(part if tick == 0 else part[1:])
        return np.concatenate(parts)

    def outputs(self, rays, fault, random):
        """(ticks, sensors) From tick 1 on."""
        return fault.electronics(fault.detect(rays, self.shares(rays), RATE_HZ, random), RATE_HZ, random)

    def readings(self, column):
        """(readings) Of pirsim's rows: their last value in each reading; of a sensor: any."""
        per = round(READING_S / self.window_s)
        values = np.array([int(row[column]) for row in self.rows])
        values = values[: len(values) // per * per].reshape(-1, per)
        return values[:, -1] if column == "people" else values.any(1)

    def when(self, tick):
        return self.begin + datetime.timedelta(seconds=float(tick) / RATE_HZ)


class Room:
    def __init__(self, pirsim, dataset, name, wired_by):
        """wired_by: a number of sensors to AsWired."""
        scene = second.Gltf(dataset / f"rooms/{name}.gltf")
        self.wired = wired_by(len(second.sorted_sensors(scene)))
        self.fault = self.wired.fault()
        self.rays = second.Rays(scene, SENSOR_FILES, self.fault.mount, self.fault.range_scale)
        n_days = len(list((dataset / f"scripts/{name}").glob("day_*.yaml")))
        self.days = [Day(pirsim, dataset, name, number) for number in range(1, n_days + 1)]


# ---------------------------------------------------------------------------------------------------------------- logs
def changes(outputs):
    """(tick, sensor, on) in the order of time; everything is off before tick 1."""
    before = np.vstack([np.zeros((1, outputs.shape[1]), bool), outputs[:-1]])
    ticks, sensors = np.nonzero(outputs != before)
    return [(tick + 1, sensor, outputs[tick, sensor]) for tick, sensor in zip(ticks, sensors)]


def home_assistant(day, outputs, sensors):
    """Its history as downloaded: entity after entity, each with its state at the beginning, in UTC."""
    lines = ["entity_id,state,last_changed"]
    events = [(0, number, False) for number in range(len(sensors))] + changes(outputs)
    for number, sensor in enumerate(sensors):
        for tick, _, on in (event for event in events if event[1] == number):
            utc = day.when(tick).replace(tzinfo=zoneinfo.ZoneInfo(ZONE)).astimezone(datetime.timezone.utc)
            stamp = utc.replace(tzinfo=None).isoformat(timespec="milliseconds")
            lines.append(f"binary_sensor.{sensor.lower()}_motion,{'on' if on else 'off'},{stamp}Z")
    return lines


def casas(day, outputs, sensors):
    """A line a change, in local time; each sensor says OFF when it is switched on."""
    events = [(0, number, False) for number in range(len(sensors))] + changes(outputs)
    return [f"{day.when(tick).isoformat(' ', timespec='microseconds')} {sensors[sensor]} {'ON' if on else 'OFF'}"
            for tick, sensor, on in events]


def wide(day, outputs, sensors, people=None):
    """As UCI 864: a reading every 30 s."""
    columns = [f"{sensor}_PIR" for sensor in sensors] + ([] if people is None else ["Room_Occupancy_Count"])
    lines = [",".join(["Date", "Time", *columns])]
    for i, bits in enumerate(second.windows_of(outputs, READING_S * RATE_HZ).astype(int)):
        stamp = day.when((i + 1) * READING_S * RATE_HZ).strftime("%Y/%m/%d,%H:%M:%S")
        lines.append(",".join([stamp, *map(str, bits), *([] if people is None else [str(people[i])])]))
    return lines


FORMS = (home_assistant, casas, wide)


# ------------------------------------------------------------------------------------------------------------- program
def by_people(motion, people):
    """Share of the readings with any motion, by the number of people."""
    any_motion = motion.any(1)
    return {int(n): round(float(any_motion[people == n].mean()), 2) for n in np.unique(people)}


def write_room(folder, number, room, random):
    form = FORMS[number % len(FORMS)]
    (folder / "days").mkdir(parents=True, exist_ok=True)
    said = {"log": form.__name__, "time_zone": ZONE, "sensors": room.rays.sensors, **dataclasses.asdict(room.wired),
            "motion_by_people": [], "pirsims_plain_zones": []}
    write = lambda path, lines: path.write_text("\n".join(lines) + "\n")
    for day in room.days:
        outputs, people = day.outputs(room.rays, room.fault, random), day.readings("people")
        if day.number == 1:
            write(folder / "log.csv", form(day, outputs, room.rays.sensors))
        write(folder / f"days/day_{day.number:02}.csv", wide(day, outputs, room.rays.sensors, people))
        plain = np.column_stack([day.readings(sensor) for sensor in room.rays.sensors])
        said["motion_by_people"].append(by_people(second.windows_of(outputs, READING_S * RATE_HZ), people))
        said["pirsims_plain_zones"].append(by_people(plain, people))
    (folder / "truth.json").write_text(json.dumps(said, indent=1) + "\n")
    return said


def make_dataset(pirsim, recipe, folder, settings):
    words = [word for setting in (*SETTINGS, *settings) for word in ("--set", setting)]
    second.run_pirsim(pirsim, [], "dataset", recipe, *words, "-q", "--resume", "-o", folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pirsim")
    parser.add_argument("recipe")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--rooms", type=int, help="of the recipe's first kind (default: as the recipe says)")
    parser.add_argument("--days", type=int, help="of each room (default: as the recipe says)")
    parser.add_argument("--seed", type=int, default=1, help="of the rooms, and of what is wrong with their sensors")
    parser.add_argument("--plain", action="store_true", help="nothing is wrong with the sensors")
    options = parser.parse_args()

    settings = [f"seed={options.seed}"]
    settings += [] if options.rooms is None else [f"rooms.0.count={options.rooms}"]
    settings += [] if options.days is None else [f"days={options.days}"]
    dataset = options.output / "dataset"
    options.output.mkdir(parents=True, exist_ok=True)
    make_dataset(options.pirsim, options.recipe, dataset, settings)
    for number, scene in enumerate(sorted((dataset / "rooms").glob("room_*.gltf"))):
        folder = options.output / scene.stem
        if (folder / "truth.json").exists():
            continue
        draw = np.random.default_rng([options.seed, 4, number])
        wired_by = AsWired.plain if options.plain else lambda n_sensors: AsWired.drawn(draw, n_sensors)
        said = write_room(folder, number, Room(options.pirsim, dataset, scene.stem, wired_by), draw)
        print(scene.stem, said["log"], "motion by people", said["motion_by_people"], "pirsim's plain zones",
              said["pirsims_plain_zones"], flush=True)


if __name__ == "__main__":
    sys.exit(main())
