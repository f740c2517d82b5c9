"""What an office sees of the bridge in 24 simulated hours: nothing but motion turns occupancy on, no message and no clock
ends it or makes it lie. Without a broker; the component's are in test_home_assistant.py."""

import json
import logging
import math
import pathlib
import random
import re
import types

import pytest
from counters import STEP_S, T0, doubting_counter, quick_counter

pytest.importorskip("paho.mqtt.client")
from pirsim_live import Counter, LiveRoom, Occupancy  # noqa: E402
from pirsim_live.mqtt import Bridge, Source, state_of  # noqa: E402

HOUR = 3600.0


class Office:
    """Two sensors, a bridge, and a clock; `said` is all that the bridge published, with the true time of it; `known` what
    it knew of the occupancy, also while it couldn't publish."""

    def __init__(self, counter, state_file=None):
        self.counter, self.state_file = counter, state_file
        self.now = self.ticks = T0
        self.said, self.known = [], []
        self.client = types.SimpleNamespace(publish=self._published, **dict.fromkeys(("will_set", "subscribe"), lambda *_, **__: None))
        self.start()

    def start(self):
        self.bridge = Bridge(Counter(self.counter), [Source("hall", "t/hall"), Source("desk", "t/desk")], self.client,
                             state_file=self.state_file, clock=lambda: self.now, monotonic=lambda: self.ticks)
        self.connect()

    def connect(self):
        self.bridge._greet(self.client, None, None, types.SimpleNamespace(is_failure=False))

    def lose(self):
        self.bridge._lose(self.client)

    def hear(self, payload, sensor="hall"):
        self.bridge._hear(self.client, None, types.SimpleNamespace(topic=f"t/{sensor}", payload=payload, retain=False))

    def quiet(self):
        for sensor in ("hall", "desk"):
            self.hear(b"OFF", sensor)

    def wait(self, seconds, every=15.0):
        end = self.ticks + seconds
        while self.ticks < end:
            step = min(every, end - self.ticks)
            self.now, self.ticks = self.now + step, self.ticks + step
            self.bridge._update()
            self.known.append((self.ticks, {None: None, True: "ON", False: "OFF"}[self.bridge._room.occupancy.is_on]))

    def _published(self, topic, payload, *_, **__):
        if topic == "pirsim/pirsim/state":
            self.said.append((self.ticks, json.loads(payload, parse_constant=lambda name: pytest.fail(name))))
            self.known.append((self.ticks, self.occupancy))

    @property
    def occupancy(self):
        return self.said[-1][1]["occupancy"]


def away(office, seconds):
    office.lose()
    office.wait(seconds)
    office.connect()


def restart(office, seconds, step=0.0):
    office.now, office.ticks = office.now + seconds + step, office.ticks + seconds
    office.start()


def step(office, seconds):
    office.now += seconds


def frozen(office, seconds):
    office.now, office.ticks = office.now + seconds, office.ticks + seconds


HAPPENS = {"nothing": lambda office: None,
           **{f"{minutes} minutes without the broker": lambda office, minutes=minutes: away(office, 60 * minutes)
              for minutes in (1, 10, 30, 120)},
           **{f"{seconds} s without the bridge": lambda office, seconds=seconds: restart(office, seconds)
              for seconds in (1, 299, 600, 7200, 86400)},
           **{f"a clock that steps by {seconds} s": lambda office, seconds=seconds: step(office, seconds)
              for seconds in (10, 40, 3600, 86400, 1e8, -10, -40, -3600, -86400, -1e8)},
           "a restart with a clock an hour behind": lambda office: restart(office, 10, -HOUR),
           "a restart with a clock a year ahead": lambda office: restart(office, 10, 3e7),
           "two hours in which the process slept": lambda office: frozen(office, 7200)}


def night(happens, counter, is_quiet, was_there, state_file=None):
    """24 hours without motion, and 10 min before them. Returns when and what occupancy became."""
    office = Office(counter, state_file if "bridge" in happens or "restart" in happens else None)
    if was_there:
        office.quiet()
        office.hear(b"ON")
        office.wait(60)
        office.hear(b"OFF")
        assert office.occupancy == "ON"
    began = office.ticks
    office.known.clear()
    HAPPENS[happens](office)
    if is_quiet:
        office.quiet()
    office.wait(24 * HOUR, every=240)
    told = [(at - began, what) for at, what in office.known]
    return [change for i, change in enumerate(told) if i == 0 or told[i - 1][1] != change[1]]


def turned_on(became, was_there):
    return "ON" in [what for _, what in became[1 if was_there else 0:]]


@pytest.mark.parametrize("happens", HAPPENS)
def test_a_silent_night_never_turns_occupancy_on(happens, tmp_path):
    for is_quiet, was_there in ((False, False), (True, False), (False, True), (True, True)):
        became = night(happens, doubting_counter(), is_quiet, was_there, tmp_path / f"{is_quiet}{was_there}.json")
        assert not turned_on(became, was_there), became
        if became[0][1] == "ON" and (not is_quiet or "10 minutes" in happens) and happens != "nothing" and "10 s" not in happens:
            assert became[1][0] <= 300 + 2 * STEP_S + 240 and became[1][1] is None, became  # five minutes, a reading's end


def test_what_ends_occupancy_is_known_silence(tmp_path):
    assert night("nothing", quick_counter(), True, True)[-1][1] == "OFF"
    assert night("1 s without the bridge", quick_counter(), True, True, tmp_path / "state")[-1][1] == "OFF"


@pytest.mark.parametrize("happens", ["nothing", "10 minutes without the broker", "600 s without the bridge",
                                     "a clock that steps by -3600 s", "a clock that steps by 86400 s"])
def test_the_rule_of_before_turns_it_on(happens, monkeypatch, tmp_path):
    """The twin: unknown that becomes P(nobody) < off_at."""
    def update(self, estimate):
        unknown = self.is_on is None or self.is_on
        self.is_on = True if estimate.moved else None if estimate.p_nobody is None else unknown and estimate.p_nobody < self.off_at
        return self.is_on
    monkeypatch.setattr(Occupancy, "update", update)
    was_there = happens != "nothing"
    assert turned_on(night(happens, doubting_counter(), True, was_there, tmp_path / "state"), was_there)


def test_occupancy_and_beliefs_are_those_from_before_a_short_restart(tmp_path):
    office = Office(quick_counter(), tmp_path / "state")
    office.quiet()
    office.wait(600)
    before = office.said[-1][1]
    assert before["occupancy"] == "OFF" and before["nobody"] > 90
    restart(office, 2)
    assert office.occupancy == "OFF"
    office.quiet()
    office.wait(60)
    assert office.occupancy == "OFF" and abs(office.said[-1][1]["nobody"] - before["nobody"]) < 3  # a reading is lost
    office.hear(b"ON")
    restart(office, 2)
    assert office.occupancy == "ON"


def readings_of(monkeypatch):
    """How many are computed from now on."""
    n, end = [0], Counter._end

    def counted(self):
        n[0] += 1
        return end(self)
    monkeypatch.setattr(Counter, "_end", counted)
    return n


@pytest.mark.parametrize("seconds", [40, 3600, 30 * 86400, 3e9, -40, -3600, -30 * 86400])
def test_a_step_of_the_clock_costs_nothing_and_begins_anew(seconds, monkeypatch, caplog):
    office = Office(quick_counter())
    office.quiet()
    office.hear(b"ON")
    office.wait(300)
    n = readings_of(monkeypatch)
    step(office, seconds)
    office.wait(1)
    assert n[0] <= 1 and "the clock stepped" in caplog.text and office.occupancy is None
    office.wait(120)
    assert office.said[-1][1] == {"people": None, "nobody": None, "occupancy": None}  # until they say something again
    office.hear(b"ON")
    assert office.occupancy == "ON"
    office.quiet()
    office.wait(900)
    assert office.occupancy == "OFF" and office.said[-1][1]["people"] == 0


def test_a_clock_that_creeps_back_does_not_keep_occupancy_on():
    office = Office(quick_counter())
    office.quiet()
    office.hear(b"ON")
    office.hear(b"OFF")
    for _ in range(20):
        office.wait(15)
        step(office, -20)  # each less than a reading
    assert office.occupancy is None


@pytest.mark.parametrize("seconds, occupancy", [(299, True), (301, None), (21_599, None)])
def test_occupancy_is_restored_for_five_minutes(seconds, occupancy):
    now = [T0]
    room = LiveRoom(Counter(quick_counter() | {"step_s": 3600.0}), clock=lambda: now[0], monotonic=lambda: now[0])
    room.update({"hall": True})
    now[0] += seconds
    again = LiveRoom(Counter(quick_counter() | {"step_s": 3600.0}), clock=lambda: now[0], monotonic=lambda: now[0])
    again.restore(room.state())
    assert again.occupancy.is_on is occupancy


def test_a_process_that_slept_has_not_seen_silence(monkeypatch):
    office = Office(quick_counter())
    office.quiet()
    office.wait(60)
    n = readings_of(monkeypatch)
    frozen(office, 86400)
    office.wait(1)
    assert n[0] == 0 and office.bridge._counter.last is None


@pytest.mark.parametrize("ahead_s", [40, 86400, 1e9])
def test_a_state_ahead_of_the_clock_is_begun_anew_and_said(ahead_s, tmp_path, caplog):
    office = Office(quick_counter(), tmp_path / "state")
    office.quiet()
    office.hear(b"ON")
    office.wait(60)
    restart(office, 5, -ahead_s)
    assert "s ahead of the clock" in caplog.text and office.occupancy is None
    office.quiet()
    office.hear(b"ON")
    office.quiet()
    office.wait(900)
    assert office.occupancy == "OFF" and office.said[-1][1]["people"] == 0


def test_a_state_that_cannot_be_written_is_said_once_and_counting_goes_on(tmp_path, caplog):
    folder = tmp_path / "full"
    folder.mkdir()
    office = Office(quick_counter(), folder / "state")
    office.quiet()
    office.wait(60)
    (folder / "state").unlink()
    folder.rmdir()
    caplog.clear()
    office.wait(600)
    assert office.said[-1][1]["people"] == 0 and len(caplog.records) == 1 and "counting goes on" in caplog.text
    folder.mkdir()
    office.wait(60)
    assert [file.name for file in folder.iterdir()] == ["state"]


@pytest.mark.parametrize("text", ["", "{", "[]", "null", "1", '"x"', "NaN", "[" * 100_000, "{}", b"\xff\xfe"])
def test_a_file_that_is_no_state_is_begun_anew_and_said(text, tmp_path, caplog):
    (tmp_path / "state").write_bytes(text if isinstance(text, bytes) else text.encode())
    office = Office(quick_counter(), tmp_path / "state")
    assert "begins anew" in caplog.text
    office.quiet()
    office.wait(600)
    assert office.said[-1][1]["people"] == 0


def test_a_battery_changes_nothing_and_a_word_that_is_no_state_makes_unknown():
    office = Office(quick_counter())
    office.quiet()
    office.wait(120)
    office.hear(b'{"battery": 97}')
    office.wait(60)
    assert office.bridge._counter._states == {"hall": False, "desk": False}
    office.hear(b"open")
    assert office.bridge._counter._states == {"hall": None, "desk": False}


@pytest.mark.parametrize("payload", [b"[" * 100_000, b'{"a":' * 100_000])
def test_a_message_that_is_too_deep_is_logged_and_unknown(payload, caplog):
    office = Office(quick_counter())
    office.hear(b"ON")
    office.hear(payload)
    assert "hall: t/hall says JSON that is too deep" in caplog.text and office.bridge._counter._states["hall"] is None


def test_whatever_a_message_raises_the_next_one_is_heard(monkeypatch, caplog):
    office = Office(quick_counter())
    monkeypatch.setattr("pirsim_live.mqtt.state_of", lambda *_: 1 / 0)
    office.hear(b"ON")
    assert "a message can't be taken: ZeroDivisionError" in caplog.text
    monkeypatch.undo()
    office.hear(b"ON")
    assert office.occupancy == "ON"


# -- what the page says -------------------------------------------------------------------------------------------------

PAGE = (pathlib.Path(__file__).parents[3] / "docs/howto/live.md").read_text(encoding="utf-8")


def test_the_pages_topics_and_messages_are_understood():
    rows = re.findall(r"^\| .* \| `({.*})` \| `(.*)` \|$", PAGE, re.MULTILINE)
    assert len(rows) >= 3
    for message, sensor in rows:
        source = Source.of(sensor)
        assert state_of(message.encode(), source.key) is ("true" in message or "ON" in message), message
        assert (source.key or "") not in source.topic or source.key is None


def test_the_pages_python_runs(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "counter.json").write_text(json.dumps(doubting_counter(("desk", "door"))))
    names = {}
    exec(re.search(r"```python\n(.*?)```", PAGE, re.DOTALL)[1], names)
    names["counter"].restore(json.loads(json.dumps(names["saved"])))


# -- at random ----------------------------------------------------------------------------------------------------------


SILENT = [b"OFF", b"0", b"0.0", b"off", b'{"occupancy": false}', b'{"state": 0}', b"", b"[" * 100_000, b'{"a":' * 50_000,
          b"NaN", b"Infinity", b'{"occupancy": NaN}', b"1e999", b"9" * 5000, b'{"battery": 97}', b'{"occupancy": [1]}',
          b'{"occupancy": {"a": true}}', b"null", b"2", b"-1", b"\x00", b"\xff\xfe1", b'{"occupancy"', b'"', b"[true]"]
MOTION = [b"ON", b"1", b"1.0", b'{"occupancy": true}', b'{"motion": 1.0}', b'{"presence": "detected"}']


def corrupted(draw, value):
    """One place of a tree of JSON is another one."""
    odd = [None, True, -1, 0, 0.5, 2, math.nan, math.inf, -math.inf, 1e308, 10**400, "", "x", [], {}, [[]], [math.nan], {"a": 1}]
    if isinstance(value, dict) and value and draw.random() < 0.9:
        key = draw.choice(list(value))
        return {name: one for name, one in value.items() if name != key} if draw.random() < 0.2 else {
            **value, key: corrupted(draw, value[key])}
    if isinstance(value, list) and value and draw.random() < 0.8:
        i = draw.randrange(len(value))
        return draw.choice([value[:i], value + value[:1], value[:i] + [corrupted(draw, value[i])] + value[i + 1:]])
    return draw.choice(odd)


@pytest.mark.parametrize("seed", range(4))
def test_messages_clocks_states_and_losses_at_random(seed, tmp_path, caplog):
    caplog.set_level(logging.CRITICAL)
    draw = random.Random(seed)
    office = Office(draw.choice((doubting_counter, quick_counter))(), tmp_path / "state")
    was_on = False  # by a sensor that may still be on
    n_on = 0
    for _ in range(1500):
        happens, before = draw.random(), len(office.said)
        is_motion = False
        if happens < 0.35:
            noise = bytes([0xff, *(draw.randrange(256) for _ in range(draw.randrange(30)))])
            office.hear(draw.choice([*SILENT, noise]), draw.choice(("hall", "desk")))
        elif happens < 0.45:
            office.hear(draw.choice(MOTION), draw.choice(("hall", "desk")))
            is_motion = was_on = True
        elif happens < 0.85:
            office.wait(10 ** draw.uniform(-1, 3), every=draw.choice((0.5, 15, 100)) * 4)
        elif happens < 0.90:
            step(office, draw.choice((-1, 1)) * 10 ** draw.uniform(-2, 7))
            office.wait(1)
        elif happens < 0.93:
            office.lose()
            office.wait(10 ** draw.uniform(-1, 4))
            office.connect()
        else:
            if draw.random() < 0.5 and office.state_file.exists():
                state = json.loads(office.state_file.read_text())
                state = corrupted(draw, {**state, "occupancy": None} if isinstance(state, dict) else state)
                office.state_file.write_text(json.dumps(state))
            restart(office, 10 ** draw.uniform(-1, 5), draw.choice((0, 0, 1, -1)) * 10 ** draw.uniform(-2, 7))
        told = [what["occupancy"] for _, what in office.said[max(0, before - 1):]]
        turned_on = any(now == "ON" != last for last, now in zip(told, told[1:]))
        assert not turned_on or is_motion or was_on, (seed, happens)
        n_on += turned_on
        was_on = any(office.bridge._counter._states.values()) or bool(office.bridge._counter._moved)
        for _, what in office.said[before:]:
            assert what["nobody"] is None or 0 <= what["nobody"] <= 100
            assert what["people"] in (None, 0, 1)
    assert n_on > 20
    office.now += 1e9
    office.quiet()
    office.hear(b"ON")
    assert office.occupancy == "ON"


def test_a_room_of_any_state_is_valid_or_refused(tmp_path):
    draw, now = random.Random(1), [T0]
    room = LiveRoom(Counter(quick_counter()), clock=lambda: now[0], monotonic=lambda: now[0])
    room.update({"hall": True, "desk": False})
    for _ in range(4):
        now[0] += 30
        room.update()
    good, n_refused = json.loads(json.dumps(room.state())), 0
    assert good["occupancy"] is True and good["time"] == T0 + 120
    for _ in range(3000):
        state = corrupted(draw, good)
        try:
            room.restore(state)
        except ValueError:
            n_refused += 1
            assert room.counter.last is None and room.occupancy.is_on is None and room.counter.time == -math.inf
        estimates = room.counter.update(max(T0 + 180, room.counter.time), {"desk": True})
        assert all(math.isfinite(p) for one in estimates for p in one.probabilities), state
    assert 2000 < n_refused < 3000
