"""Homes' logs in CASAS' form as events, and what a recogniser may know at each of them."""
import csv
import datetime
import pathlib
import re
from dataclasses import dataclass

import numpy as np

WINDOW = 30       # events that count as the last ones
MEMORY_S = 300.0  # after which an event weighs 1/e
OTHER = "other"   # no labelled activity goes on
# What sensors are told by, in every home; contacts of doors by the area behind them.
PLACES = ["living_room", "kitchen", "bedroom", "study", "bath", "corridor", "door_bedroom", "door_bath", "door_front"]
HAPPENS = {"ON": True, "OPEN": True, "CLOSE": True, "OFF": False}  # that a sensor ends its pulse tells nothing new
LABEL = re.compile(r"(?:(resident_\d+|visitor|R\d+)_)?(.+)")        # a person or nobody in particular, what they do


class BadInput(Exception):
    """What is wrong with a file, as `file:line: what`."""


@dataclass(frozen=True)
class Stretch:
    """Events one after the other, from one log."""
    seconds: np.ndarray  # float [event], from the midnight before the first
    places: np.ndarray   # int [event], index into PLACES
    done: list           # [event] of sets: what is done meanwhile, by anybody; {OTHER} if no label says
    people: set          # whom labels name


@dataclass(frozen=True)
class Home:
    name: str
    stretches: list

    def is_of_one(self):
        return len(set().union(*(stretch.people for stretch in self.stretches))) <= 1


def place_of(area):
    """bedroom_2 is a bedroom, and what is no kind of room that is known here counts as a corridor."""
    kind = re.sub(r"_\d+$", "", area)
    return PLACES.index(kind if kind in PLACES else "corridor")


def _parsed(line, area_of):
    """Moment, sensor, whether that is an event, and of a label person, activity, and `begin` or `end`."""
    date, clock, sensor, state, *label = line.split()
    if label and (len(label) < 2 or label[-1] not in ("begin", "end")):
        raise ValueError(f"'{' '.join(label)}' neither begins nor ends")
    if sensor in area_of and state not in HAPPENS:
        raise ValueError(f"'{state}' is no state of {sensor}")
    person, activity = LABEL.fullmatch("_".join(label[:-1])).groups() if label else ("", "")
    return (datetime.datetime.fromisoformat(f"{date} {clock}"), sensor, sensor in area_of and HAPPENS[state],
            person or "", activity, label[-1] if label else "")


def read_log(path, area_of):
    """A log `date time sensor state [label begin|end]`. area_of: sensor to area; other sensors are left out.

    Raises BadInput with file and line for what can't be read.
    """
    moments, places, done, going_on, people, event = [], [], [], set(), set(), None
    for number, line in enumerate(pathlib.Path(path).read_text().splitlines(), 1):
        try:
            moment, sensor, is_event, person, activity, turn = _parsed(line, area_of)
        except ValueError as error:
            raise BadInput(f"{path}:{number}: {error}") from error
        if turn:
            people.add(person)
        if turn == "begin":
            going_on.add((person, activity))
        if is_event and (moment, sensor) != event:  # a line with two labels stands twice
            event = moment, sensor
            moments.append(moment)
            places.append(place_of(area_of[sensor]))
            done.append(set())
        if is_event:
            done[-1].update(what for _, what in going_on)
        if turn == "end":
            going_on.discard((person, activity))
    if not moments:
        raise BadInput(f"{path}: no event of a sensor whose area is known")
    midnight = moments[0].replace(hour=0, minute=0, second=0, microsecond=0)
    return Stretch(np.array([(m - midnight).total_seconds() for m in moments]), np.array(places),
                   [what or {OTHER} for what in done], people)


def read_homes(folder):
    """The homes of a dataset with `exports: [casas]`: their logs, by the area that each sensor watches."""
    folder, areas = pathlib.Path(folder), {}
    with open(folder / "sensors.csv", newline="") as file:
        for line in csv.DictReader(file):
            areas.setdefault(int(line["room"]), {"door_front": "door_front"})[line["sensor"]] = line["area"]
    with open(folder / "areas.csv", newline="") as file:  # the contact of a door is called by the area behind it
        for line in csv.DictReader(file):
            areas[int(line["room"])][f"door_{line['area']}"] = f"door_{line['area']}"
    homes = []
    for room, area_of in areas.items():
        logs = folder / "exports/casas" / f"room_{room:04d}"
        homes.append(Home(f"home {room}", [read_log(log, area_of) for log in sorted(logs.glob("*.txt"))]))
        if not homes[-1].stretches:
            raise BadInput(f"{logs}: no logs; does the recipe say `exports: [casas]`?")
    return homes


def time_of_day(stretch):
    """float [event, 1]: hours since four in the morning, when nearly everybody sleeps."""
    return ((stretch.seconds / 3600 - 4) % 24)[:, None]


def here(stretch):
    """float [event, place]: 1 where the event is."""
    return np.eye(len(PLACES))[stretch.places]


def features(stretch):
    """float [event, feature]: what is known when each event happens, from it and earlier ones alone.

    As Krishnan and Cook (2014, doi 10.1016/j.pmcj.2012.07.003), but with kinds of rooms for sensors: the time of day,
    the event's place, seconds since the event before and since the first of the last WINDOW ones (logarithms), how
    many of these each place had, and the same of all events with weights that fade with age.
    """
    is_at, seconds = here(stretch), stretch.seconds
    first = np.maximum(0, np.arange(len(seconds)) - WINDOW + 1)
    since = np.diff(seconds, prepend=seconds[0])
    so_far = np.vstack([np.zeros(len(PLACES)), np.cumsum(is_at, axis=0)])
    faded = np.zeros_like(is_at)
    for i in range(len(seconds)):
        faded[i] = is_at[i] + (faded[i - 1] * np.exp(-since[i] / MEMORY_S) if i > 0 else 0)
    return np.column_stack([time_of_day(stretch), is_at, np.log1p(since), np.log1p(seconds - seconds[first]),
                            so_far[1:] - so_far[first], faded])
