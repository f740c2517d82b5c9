"""Readings: which sensor saw motion in each half minute, and how many people there were at its end."""
import csv
import datetime
import gzip
import hashlib
import json
import pathlib
from dataclasses import dataclass, replace

import numpy as np

SECONDS = 30.0      # of a reading, as in UCI 864
LONGEST_GAP = 300.0  # s; what lies further apart isn't one stretch


@dataclass(frozen=True)
class Stretch:
    """Readings of one room and day without a gap."""
    room: str
    motion: np.ndarray  # bool [reading, sensor]
    people: np.ndarray  # int [reading]
    units: np.ndarray   # str [reading]: the day, or the hour of a single day; whatever is held back is whole units


@dataclass(frozen=True)
class Piece:
    """Which readings of a stretch are trained on or scored, and what each of them counts."""
    stretch: Stretch
    keep: np.ndarray  # bool [reading]
    weight: float = 1.0

    def units(self):
        return set(self.stretch.units[self.keep])


def _bit(text):
    if text not in ("0", "1"):
        raise ValueError(f"'{text}' is neither 0 nor 1")
    return text == "1"


def whole(stretches, weight=1.0):
    return [Piece(s, np.ones(len(s.people), bool), weight) for s in stretches]


def first_mornings(pieces, n):
    """The first day of every room, then the second ones, until there are n."""
    days = {}
    for piece in pieces:
        days.setdefault(piece.stretch.room, set()).update(piece.units())
    by_turns = sorted((place, room, day) for room, own in days.items() for place, day in enumerate(sorted(own)))
    if len(by_turns) < n:
        raise ValueError(f"{len(by_turns)} mornings where {n} are wanted")
    chosen = {day for _, _, day in by_turns[:n]}
    return [piece for piece in pieces if piece.units() <= chosen]


def among(stretches, units, weight=1.0):
    """The readings of these units."""
    pieces = [Piece(s, np.isin(s.units, sorted(units)), weight) for s in stretches]
    return [p for p in pieces if p.keep.any()]


def check_apart(train, test, rooms=False):
    """Refuses to score what was trained on: no day in both, and with `rooms` no room either."""
    shared = set().union(*(p.units() for p in train)) & set().union(*(p.units() for p in test))
    if rooms:
        shared |= {p.stretch.room for p in train} & {p.stretch.room for p in test}
    if shared:
        raise ValueError(f"trained on what is to be tested: {sorted(shared)[:3]}")


def read_dataset(folder):
    """The parts of a dataset of `pirsim dataset`: name to stretches."""
    folder = pathlib.Path(folder)
    package = json.loads((folder / "datapackage.json").read_text())
    parts = {}
    for resource in package["resources"]:
        fields = [f["name"] for f in resource.get("schema", {}).get("fields", [])]
        if resource["name"] in ("train", "validation", "test_days", "test_rooms") and "people" in fields:
            paths = resource["path"] if isinstance(resource["path"], list) else [resource["path"]]
            parts[resource["name"]] = [_read_day(folder, path) for path in paths]
    return parts


def _read_day(folder, path):
    opened = gzip.open(folder / path, "rt") if path.endswith(".gz") else open(folder / path)
    with opened as file:
        rows = list(csv.reader(file))
    columns = {name: i for i, name in enumerate(rows[0])}
    last = columns["departures"]
    sensors = [i for name, i in columns.items()
               if i > last and not name.startswith("people_") and rows[1][i] != ""]  # people_: of areas
    motion = np.array([[row[i] == "1" for i in sensors] for row in rows[1:]], dtype=bool)
    people = np.array([int(row[columns["people"]]) for row in rows[1:]])
    per = round(SECONDS / float(rows[1][columns["time_s"]]))
    n = len(people) // per
    # The same scene is the same room, whichever dataset it is in.
    name = pathlib.Path(path).parent.name
    room = hashlib.sha256((folder / "rooms" / (name + ".gltf")).read_bytes()).hexdigest()[:12]
    day = f"{room} {rows[1][columns['time']][:10]}"
    return Stretch(room, motion[:n * per].reshape(n, per, -1).any(axis=1), people[per - 1:n * per:per],
                   np.full(n, day))


class BadInput(Exception):
    """What is wrong with a file that the user gave, as `file:line: what`."""


def _moment(date, clock):
    """UCI 864's `2017/12/22` and `10:49:41`, also as a spreadsheet rewrites them (`2017-12-22`, `0:00:34`)."""
    year, month, day = (int(part) for part in date.replace("/", "-").split("-"))
    hour, minute, second = (int(part) for part in clock.split(":"))
    return datetime.datetime(year, month, day, hour, minute, second)


def read_uci864(path):
    """Occupancy_Estimation.csv as UCI publishes it: the PIR columns and the count, in stretches without gaps.

    Raises BadInput with file and line for what can't be read.
    """
    wanted = {"Date", "Time", "S6_PIR", "S7_PIR", "Room_Occupancy_Count"}
    times, motion, people = [], [], []
    try:
        with open(path, newline="") as file:
            rows = csv.DictReader(file)
            missing = sorted(wanted - set(rows.fieldnames or []))
            if missing:
                raise BadInput(f"{path}:1: no column {', '.join(missing)}; is this UCI 864's Occupancy_Estimation.csv?")
            for row in rows:
                try:
                    times.append(_moment(row["Date"], row["Time"]))
                    motion.append([_bit(row["S6_PIR"]), _bit(row["S7_PIR"])])
                    people.append(int(row["Room_Occupancy_Count"]))
                except (TypeError, ValueError, AttributeError) as error:
                    raise BadInput(f"{path}:{rows.line_num}: {error}; expected a date as 2017/12/22, a time as 10:49:41, "
                                   "bits of 0 or 1 and a count") from None
                if len(times) > 1 and times[-1] < times[-2]:
                    raise BadInput(f"{path}:{rows.line_num}: {times[-1]} comes before {times[-2]} of the line above")
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise BadInput(f"{path}: {error}") from None
    if not times:
        raise BadInput(f"{path}: no readings")
    motion, people = np.array(motion), np.array(people)
    seconds = np.array([(t - times[0]).total_seconds() for t in times])
    days = np.array([t.date().isoformat() for t in times])
    cuts = np.flatnonzero((np.diff(seconds) > LONGEST_GAP) | (days[1:] != days[:-1])) + 1
    stretches = [Stretch("uci864", motion[i], people[i], days[i]) for i in np.split(np.arange(len(times)), cuts)]
    if len(set(days)) > 3:
        return stretches
    # Too few days to hold one back: hours are, which are less apart from each other than days.
    hours = np.array([f"{t.date().isoformat()} {t.hour:02d}h" for t in times])
    return [replace(s, units=hours[i]) for s, i in zip(stretches, np.split(np.arange(len(times)), cuts))]
