"""From the topics of motion sensors to people, P(nobody) and occupancy, by MQTT; Home Assistant discovers them."""

from __future__ import annotations

import json
import logging
import os
import re
import string
import time
from dataclasses import dataclass
from typing import Any, Callable, Iterable

import paho.mqtt.client as paho

from . import __version__, words
from .counter import Counter, State
from .room import LiveRoom

_log = logging.getLogger("pirsim_live")
_KEYS = ("occupancy", "presence", "motion", "state")
_NUMBER = re.compile(r"[+-]?([0-9]+[.,]?[0-9]*|[.,][0-9]+)(e[+-]?[0-9]+)?")
_SMALL = str.maketrans(string.ascii_uppercase, string.ascii_lowercase)
_UNHEARD_S = 300.0  # after which the log names the sensors that said nothing; assumed (1-30 min)


def state_of_word(text: str) -> State:
    """Motion, none, or unknown, as `pirsim log` reads words and numbers; unknown for what is neither."""
    word = text.strip().translate(_SMALL)
    number = float(word.replace(",", ".", 1)) if len(word) <= words.LONGEST and _NUMBER.fullmatch(word) else None
    return True if word in words.ON or number == 1 else False if word in words.OFF or number == 0 else None


def state_of(payload: bytes, key: str | None = None) -> State:
    """What a message says; None: unknown, as of any word that is no state. Of JSON the key, `Switch1.Action` being Action
    in Switch1, or the first of occupancy, presence, motion and state. Raises KeyError for JSON that says nothing of it,
    such as a battery's."""
    text = payload.decode("utf-8", "replace").strip()
    try:
        told = json.loads(text)
    except ValueError:
        told = text
    if isinstance(told, dict):
        key = key or next((one for one in _KEYS if one in told), _KEYS[0])
        for step in [key] if key in told else key.split("."):
            if not isinstance(told, dict):
                raise KeyError(key)
            told = told[step]
    return state_of_word(str(told))


@dataclass(frozen=True)
class Source:
    """Where a sensor's messages come from."""

    sensor: str
    topic: str
    key: str | None = None
    """Of a JSON message."""

    @classmethod
    def of(cls, text: str) -> Source:
        """SENSOR=TOPIC, or SENSOR=TOPIC:KEY; a number behind the last colon, as in Shelly's input:0, is part of the topic.
        Raises ValueError."""
        sensor, equals, topic = text.partition("=")
        before, colon, key = topic.rpartition(":")
        is_key = colon and not re.fullmatch("[0-9]+|.*/.*", key)
        topic, colon, key = (before, colon, key) if is_key else (topic, "", "")
        if not (sensor and equals and topic) or (colon and not key) or set("#+") & set(topic):
            raise ValueError(f"expected SENSOR=TOPIC or SENSOR=TOPIC:KEY, got {text!r}")
        return cls(sensor, topic, key or None)


class Bridge:
    """A counter between a broker's topics. One thread: call turn() again and again, or run()."""

    def __init__(self, counter: Counter, sources: Iterable[Source], client: paho.Client, *, name: str = "pirsim",
                 off_at: float = 0.9, discovery: str = "homeassistant", state_file: str | os.PathLike[str] | None = None,
                 clock: Callable[[], float] = time.time, monotonic: Callable[[], float] = time.monotonic) -> None:
        """client: not connected yet; its callbacks and its will are the bridge's. Raises ValueError if a sensor of the
        counter has no topic, or a topic is of none."""
        self._sources = list(sources)
        told = [source.sensor for source in self._sources]
        if sorted(told) != sorted(counter.sensors):
            raise ValueError(f"the counter has the sensors {', '.join(counter.sensors)}; topics are given for {', '.join(told) or 'none'}")
        if len({(source.topic, source.key) for source in self._sources}) < len(self._sources):
            raise ValueError("two sensors have one topic")
        self._room = LiveRoom(counter, off_at, clock=clock, monotonic=monotonic)
        self._counter, self._client, self._name, self._discovery = counter, client, name, discovery
        self._clock, self._monotonic = clock, monotonic
        self._state_file, self._is_saved = state_file, True
        self._connected = False
        self._unheard, self._hears_since_s = set(told), monotonic()
        if state_file is not None and os.path.exists(state_file):
            try:
                with open(state_file, encoding="utf-8") as file:
                    self._room.restore(json.load(file))
            except (OSError, ValueError, RecursionError) as fault:
                _log.warning("%s: begins anew: %s", state_file, fault)
        client.will_set(self._topic("status"), "offline", qos=1, retain=True)
        client.on_connect, client.on_message, client.on_disconnect = self._greet, self._hear, self._lose

    def _topic(self, what: str) -> str:
        return f"pirsim/{self._name}/{what}"

    # -- what the broker says -----------------------------------------------------------------------------------------

    def _greet(self, client: paho.Client, _data: Any, _flags: Any, reason: Any, _properties: Any = None) -> None:
        if reason.is_failure:
            _log.error("the broker refuses: %s", reason)
            return
        self._connected, self._hears_since_s = True, self._monotonic()
        self._forget()  # who knows what was missed
        for topic in sorted({source.topic for source in self._sources}):
            client.subscribe(topic, qos=1)
        client.publish(f"{self._discovery}/device/pirsim_{self._name}/config", json.dumps(self._device()), 1, True)
        client.publish(self._topic("status"), "online", 1, True)
        _log.info("connected: %d sensors, counts are on %s", len(self._sources), self._topic("state"))
        self._tell()

    def _lose(self, _client: paho.Client, *_: Any) -> None:
        if self._connected:
            _log.warning("lost the broker: nothing is known of the sensors")
        self._connected = False
        self._forget()

    def _hear(self, _client: paho.Client, _data: Any, message: paho.MQTTMessage) -> None:
        if message.retain:  # of who knows when
            return
        try:
            for source in self._sources:
                if source.topic == message.topic:
                    self._take(source, message.payload)
        except Exception as fault:  # whatever it is, the next message is heard
            _log.warning("a message can't be taken: %s: %s", type(fault).__name__, str(fault)[:200])

    def _take(self, source: Source, payload: bytes) -> None:
        try:
            state = state_of(payload, source.key)
        except KeyError:
            return
        except RecursionError:
            _log.warning("%s: %s says JSON that is too deep: unknown", source.sensor, source.topic)
            state = None
        if state is None and source.sensor in self._unheard:
            _log.warning("%s: %s says %r, which is neither motion nor none", source.sensor, source.topic, payload[:60])
        self._unheard.discard(source.sensor)
        self._update({source.sensor: state})

    # -- the counter ---------------------------------------------------------------------------------------------------

    def _forget(self) -> None:
        self._update(dict.fromkeys(self._counter.sensors))

    def _update(self, states: dict[str, State] | None = None) -> None:
        if self._room.update(states):
            self._tell()
            self._save()
        if self._connected and self._unheard and self._monotonic() > self._hears_since_s + _UNHEARD_S:
            _log.warning("nothing was heard of %s: are the topics right?", ", ".join(sorted(self._unheard)))
            self._unheard = set()

    def _save(self) -> None:
        if self._state_file is None:
            return
        made = f"{os.fspath(self._state_file)}.new"
        try:
            with open(made, "w", encoding="utf-8") as file:
                json.dump(self._room.state(), file)
            os.replace(made, self._state_file)
        except OSError as fault:
            if self._is_saved:
                _log.warning("%s: can't be written, counting goes on: %s", self._state_file, fault)
            self._is_saved = False
        else:
            self._is_saved = True

    # -- what it says --------------------------------------------------------------------------------------------------

    def _tell(self) -> None:
        if not self._connected:
            return
        last, is_on = self._counter.last, self._room.occupancy.is_on
        told = {"people": last.people if last else None,
                "nobody": round(100 * last.p_nobody, 1) if last and last.p_nobody is not None else None,
                "occupancy": None if is_on is None else "ON" if is_on else "OFF"}
        self._client.publish(self._topic("state"), json.dumps(told), qos=1)

    def _device(self) -> dict[str, Any]:
        """As Home Assistant discovers it."""
        def part(platform: str, key: str, name: str, **more: Any) -> dict[str, Any]:
            return {"p": platform, "unique_id": f"pirsim_{self._name}_{key}", "name": name,
                    "value_template": f"{{{{ value_json.{key} }}}}", "expire_after": round(3 * self._counter.step_s),
                    "default_entity_id": f"{platform}.{self._name}_{key}", **more}
        problem = {"p": "binary_sensor", "unique_id": f"pirsim_{self._name}_problem", "name": "Unlike the simulated rooms",
                   "device_class": "problem", "entity_category": "diagnostic",
                   "default_entity_id": f"binary_sensor.{self._name}_problem",
                   "value_template": "ON" if self._counter.warning else "OFF"}
        return {"dev": {"ids": [f"pirsim_{self._name}"], "name": self._name, "mf": "pirsim", "mdl": "people counter"},
                "o": {"name": "pirsim-live", "sw": __version__},
                "state_topic": self._topic("state"), "availability": [{"topic": self._topic("status")}], "qos": 1,
                "cmps": {"people": part("sensor", "people", "People", state_class="measurement"),
                         "nobody": part("sensor", "nobody", "Nobody there", unit_of_measurement="%"),
                         "occupancy": part("binary_sensor", "occupancy", "Occupancy", device_class="occupancy"),
                         "problem": problem}}

    # -- its thread ----------------------------------------------------------------------------------------------------

    def turn(self, timeout_s: float = 1.0) -> bool:
        """Hears what the broker says within that time, and ends readings. False: the connection is lost."""
        until_end = max(0.0, self._counter.next_end - self._clock())
        alive = self._client.loop(min(timeout_s, until_end) if until_end else timeout_s) == paho.MQTT_ERR_SUCCESS
        self._update()
        return alive

    def run(self, host: str, port: int, stopped: Callable[[], bool]) -> None:
        """Until stopped. Connects again and again, at most a minute apart."""
        pause_s, next_try = 1.0, -1e9
        while not stopped():
            if self._client.is_connected() or self._connected or self._client.socket() is not None:
                if self.turn():
                    pause_s = 1.0 if self._connected else pause_s
                    continue
                next_try = self._monotonic() + pause_s
            elif self._monotonic() >= next_try:
                try:
                    self._client.connect(host, port, keepalive=30)
                    continue
                except OSError as fault:
                    _log.warning("%s:%d: %s", host, port, fault)
                pause_s = min(60.0, 2 * pause_s)
                next_try = self._monotonic() + pause_s
            time.sleep(0.2)
            self._update()
        if self._connected:
            self._client.publish(self._topic("status"), "offline", 1, True)
            self.turn(0.2)
            self._connected = False  # not lost
        self._client.disconnect()
