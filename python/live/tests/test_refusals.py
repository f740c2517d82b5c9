"""What a counter's file may hold: pirsim-live refuses all that the command refuses, and no more."""

import copy
import json
import math
import random

import pytest
from counters import with_all_keys

from pirsim_live import Counter

GOOD = with_all_keys(random.Random(1))
# Kinds of corruption: what is put in the place, as it stands in the file.
KINDS = ["null", "true", "NaN", "Infinity", "-Infinity", "1e999", "1" + 400 * "0", "-1", "0", "1e-200", "0.5", "1", "2", "3",
         "1e18", '""', '"x"', '"\\ud800"', "[]", "[0.5]", '[""]', "[null, null]", "{}", '{"a": 1}', "[[]]", None]


def places(value, path=()):
    """Of the first of several alike; None behind a path: the list is longer, or shorter by one."""
    yield path
    if isinstance(value, dict):
        for key in value:
            yield from places(value[key], (*path, key))
    elif isinstance(value, list) and value:
        yield from places(value[0], (*path, 0))
        yield (*path, None)


def texts(path):
    """The file with each kind of corruption in this place."""
    told = copy.deepcopy(GOOD)
    parent = told
    for step in path[:-1]:
        parent = parent[step]
    if path and path[-1] is None:
        for changed in (parent + parent[:1], parent[:-1], parent[::-1], [parent[0]] * len(parent)):
            parent[:] = changed
            yield json.dumps(told)
        return
    for kind in KINDS:
        if kind is None and path and path[-1] != 0:
            yield json.dumps({**told, "later": 1} if not path[:-1] else told).replace(json.dumps(path[-1]), '"other"', 1)
        elif kind is not None and path:
            parent[path[-1]] = "@"
            yield json.dumps(told).replace('"@"', kind, 1)
        elif kind is not None:
            yield kind


ALL = [(path, text) for path in places(GOOD) for text in texts(path)]


def verdict(make, text, file):
    file.write_text(text)
    try:
        make(file)
    except ValueError:
        return "refused"
    return "taken"


def test_what_the_command_refuses_is_refused(tmp_path):
    counting = pytest.importorskip("pirsim.counting", reason="compares with the built pirsim")
    from pirsim.errors import FileError, InputError

    def make(file):
        try:
            counting.load(file)
        except (FileError, InputError) as fault:
            raise ValueError from fault
    assert verdict(make, json.dumps(GOOD), tmp_path / "c.json") == verdict(Counter, json.dumps(GOOD), tmp_path / "c.json") == "taken"
    differ, n = [], {"taken": 0, "refused": 0}
    for path, text in ALL:
        expected = verdict(make, text, tmp_path / "c.json")
        if path == ("step_s",) and '"step_s": 1e-200' in text:
            expected = "refused"  # the command takes no windows below a millisecond, which its reader of counters leaves to it
        n[expected] += 1
        if verdict(Counter, text, tmp_path / "c.json") != expected:
            differ.append((path, expected))
    assert not differ and n["refused"] > 400 and n["taken"] > 40, (differ, n)


@pytest.mark.parametrize("path, value", [
    (("step_s",), math.nan), (("step_s",), 0), (("step_s",), 86401), (("step_s",), None), (("sensors",), 2.0), (("counts",), 1),
    (("pirsim_counter",), True), (("pirsim_counter",), 3), (("model",), "logistic"), (("rooms",), []), (("rooms",), None),
    (("rooms", 0, "first", 0), math.nan), (("rooms", 0, "moves", 0), -0.1), (("rooms", 0, "moves", 0), 0.9999),
    (("rooms", 0, "versions", 0, "weight"), math.inf), (("rooms", 0, "versions", 0, "weight"), -0.25),
    (("rooms", 0, "versions", 0, "emissions", 0), 0.0), (("rooms", 0, "versions", 0, "emissions", 0), None),
    (("sensor_names",), ["hall", "hall"]), (("sensor_names",), ["hall"]), (("sensor_names", 1), None), (("holds_s", 0), -1),
    (("warning",), None), (("expected_error",), [1]), (("figures_off",), {}), (("later",), math.nan)])
def test_what_is_refused_without_the_command_beside(path, value, tmp_path):
    told = copy.deepcopy(GOOD)
    parent = told
    for step in path[:-1]:
        parent = parent[step]
    parent[path[-1]] = value
    (tmp_path / "c.json").write_text(json.dumps(told))
    for counter in (told, tmp_path / "c.json"):
        with pytest.raises(ValueError, match="isn't a counter of pirsim calibrate"):
            Counter(counter)


def test_a_file_of_other_bytes_is_refused_with_one_line(tmp_path):
    good = json.dumps(GOOD).encode()
    for wrong in (b"", b"[" * 100_000, b"{" * 100_000, b"\xff", good[:-1], good + b"x", b"9" * 5000, good.replace(b"hall", b"\xff")):
        (tmp_path / "c.json").write_bytes(wrong)
        with pytest.raises(ValueError, match="c.json: isn't a counter"):
            Counter(tmp_path / "c.json")
