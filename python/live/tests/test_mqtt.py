"""The bridge with a real broker: what it hears is what pirsim counts, through all that happens to messages."""

import csv
import json
import os
import pathlib
import random
import shutil
import socket
import subprocess
import sys
import time
import types

import pytest
from counters import STEP_S, T0, random_counter
from test_counter import bits_of, made, same  # noqa: F401

np = pytest.importorskip("numpy")
counting = pytest.importorskip("pirsim.counting")
paho = pytest.importorskip("paho.mqtt.client")
pytestmark = pytest.mark.skipif(shutil.which("mosquitto") is None, reason="needs Debian's package mosquitto")

from pirsim_live import Counter, words  # noqa: E402
from pirsim_live.mqtt import Bridge, Source, state_of  # noqa: E402


@pytest.mark.parametrize("payload, key, state", [
    (b"ON", None, True), (b"off", None, False), (b"1", None, True), (b" 0 ", None, False), (b"unavailable", None, None),
    (b"", None, None), (b"\xff", None, None), (b'"on"', None, True), (b"true", None, True), (b"null", None, None),
    (b'{"occupancy": true, "battery": 97}', None, True), (b'{"state": "OFF"}', None, False),
    (b'{"pir": 1, "occupancy": false}', "pir", True), (b'{"occupancy": null}', None, None)])
def test_messages(payload, key, state):
    assert state_of(payload, key) is state


@pytest.mark.parametrize("options, told", [
    (["--name", "a b"], "--name"), (["--off-at", "90"], "off_at"), (["--state", "nowhere/x"], "--state"), (["--state", "/dev/full"], "--state"),
    (["--port", "99999"], "--port"), (["--port", "0"], "--port"), (["--off-at", "nan"], "off_at"), (["--ca", "ca.pem"], "--tls"), (["--tls", "--ca", "ca.pem"], "no file 'ca.pem'"), (["--password-file", "p"], "--user"),
    (["--counter", "nonsense.json"], "nonsense.json: isn't a counter"), (["--sensor", "a=t", "--sensor", "b=t"], "one topic")])
def test_faults_are_told_before_anything_is_connected(options, told, tmp_path):
    two = random_counter(random.Random(1), 2) | {"sensor_names": ["a", "b"]}
    (tmp_path / "counter.json").write_text(json.dumps(two))
    (tmp_path / "nonsense.json").write_text("{]")
    (tmp_path / "options.txt").write_text("# of the hall\n--broker 127.0.0.1 --port 1\n--counter counter.json\n")
    sensors = [] if "--sensor" in options else ["--sensor", "a=t/a", "--sensor", "b=t/b"]
    done = subprocess.run([sys.executable, "-m", "pirsim_live", "mqtt", "@options.txt", *sensors, *options], cwd=tmp_path,
                          capture_output=True, text=True, timeout=20)
    assert done.returncode == 2 and told in done.stderr, done.stderr


def test_sensors_that_say_nothing_or_no_word_of_motion_are_told(made, caplog):  # noqa: F811
    now = [float(T0)]
    client = types.SimpleNamespace(**dict.fromkeys(("will_set", "publish", "subscribe"), lambda *_, **__: None))
    bridge = Bridge(Counter(made(random.Random(3), sensors=2)), [Source("sensor_1", "a"), Source("sensor_2", "b")], client,
                    clock=lambda: now[0], monotonic=lambda: now[0])
    bridge._greet(client, None, None, types.SimpleNamespace(is_failure=False))
    bridge._hear(client, None, types.SimpleNamespace(topic="a", payload=b"open", retain=False))
    assert "sensor_1: a says b'open'" in caplog.text and "nothing was heard" not in caplog.text
    now[0] += 400
    bridge._update()
    assert "nothing was heard of sensor_2:" in caplog.text


TEXTS = {True: "1 1.0 1,0 +1 01 1e0 1. .1e1 ON Motion", False: "0 0.0 0,00 -0 00 0e5 .0 OFF No",
         None: "2 -1 0.5 1_0 0x1 1e400 \u0661 1,0,0 1.0.0 1e inf nan ++1 on. \u212aon " + (words.LONGEST + 1) * "0"}


@pytest.mark.parametrize("state", TEXTS)
def test_words_and_numbers_are_states(state):
    for text in TEXTS[state].split():
        assert state_of(text.encode()) is state_of(f"\t{text}\n".encode()) is state, text
        assert state_of(json.dumps({"motion": text}).encode()) is state, text
    for word in {True: words.ON, False: words.OFF, None: words.UNKNOWN}[state]:
        assert state_of(word.encode()) is state_of(word.upper().encode()) is state, word


@pytest.mark.skipif("PIRSIM" not in os.environ, reason="PIRSIM names the command")
def test_words_and_numbers_are_read_as_the_command_reads_logs(tmp_path):
    """A log of a sensor a text: it goes on and off, then says the text at the begin of a window."""
    known = [word for table in (words.ON, words.OFF, words.UNKNOWN) for word in table if word]
    texts = [text for texts in TEXTS.values() for text in texts.split()] + known
    rows = [(60 * i + k / 10, f"pir_{k}", "on" if i % 2 else "off") for k in range(len(texts)) for i in range(100)]
    rows += [(6000, f"pir_{k}", text) for k, text in enumerate(texts)] + [(6090, "pir_0", "off")]
    (tmp_path / "log.csv").write_text("time_s;sensor;state\n" + "".join(f"{at};{sensor};{text}\n" for at, sensor, text in sorted(rows)))
    subprocess.run([os.environ["PIRSIM"], "log", tmp_path / "log.csv", "--step", "30", "-o", tmp_path / "rows.csv"], check=True,
                   capture_output=True)
    with open(tmp_path / "rows.csv") as file:
        [row] = [row for row in csv.DictReader(file) if float(row["time_s"]) == 6030]
    told = {text: {"1": True, "0": False, "": None}[row[f"pir_{k}"]] for k, text in enumerate(texts)}
    assert told == {text: state_of(text.encode()) for text in texts}


@pytest.mark.parametrize("key, message, state", [
    ("Switch1.Action", {"Switch1": {"Action": "ON"}}, True), ("Switch1.Action", {"Switch1.Action": "OFF"}, False),
    ("a.b.c", {"a": {"b": {"c": 1.0}}}, True), (None, {"id": 0, "state": False}, False), ("a", {"a": {"b": True}}, None),
    ("a.b", {"a": 1}, KeyError), ("a.b", {"a": {"c": 1}}, KeyError), ("a", {}, KeyError), (None, {"battery": 97}, KeyError)])
def test_keys_are_steps_into_json_which_may_say_nothing_of_motion(key, message, state):
    payload = json.dumps(message).encode()
    if state is KeyError:
        with pytest.raises(KeyError):
            state_of(payload, key)
    else:
        assert state_of(payload, key) is state


def test_topics_are_told_from_keys():
    for text, source in {"hall=zigbee2mqtt/hall": ("zigbee2mqtt/hall", None), "hall=a/b:pir": ("a/b", "pir"),
                         "hall=shelly-aa/status/input:0": ("shelly-aa/status/input:0", None),
                         "hall=shelly-aa/status/input:0:state": ("shelly-aa/status/input:0", "state"),
                         "hall=tele/SENSOR:Switch1.Action": ("tele/SENSOR", "Switch1.Action"),
                         "hall=a4:c1/motion": ("a4:c1/motion", None)}.items():
        assert Source.of(text) == Source("hall", *source)
    for wrong in ("hall", "=a", "hall=", "hall=a/#", "hall=a:", "hall=:a"):
        with pytest.raises(ValueError):
            Source.of(wrong)


class Broker:
    def __init__(self, folder, *lines):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.config = folder / "mosquitto.conf"
        self.config.write_text("\n".join([f"listener {self.port} 127.0.0.1", "persistence false", "user root", *(lines or ["allow_anonymous true"])]))
        self.start()

    def start(self):
        self.process = subprocess.Popen(["mosquitto", "-c", self.config], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(100):
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", self.port)) == 0:
                    return
            time.sleep(0.05)
        raise RuntimeError("mosquitto doesn't start")

    def stop(self):
        self.process.kill()
        self.process.wait()


@pytest.fixture
def broker(tmp_path):
    broker = Broker(tmp_path)
    yield broker
    broker.stop()


class House:
    """Sensors, a bridge, and a clock that stands still unless it is told."""

    def __init__(self, broker, counter_file, folder):
        self.broker, self.counter_file, self.folder = broker, counter_file, folder
        self.now = self.ticks = T0
        self.told = []  # estimates of all readings that ended
        self.sensors = paho.Client(paho.CallbackAPIVersion.VERSION2)
        self.sensors.connect("127.0.0.1", broker.port)
        self.sensors.loop_start()
        self.start()

    def start(self):
        counter = Counter(self.counter_file)
        update = counter.update

        def listened(*more):
            ended = update(*more)
            self.told += ended
            return ended
        counter.update = listened
        self.client = paho.Client(paho.CallbackAPIVersion.VERSION2, clean_session=True)
        self.bridge = Bridge(counter, [Source(name, f"house/{name}") for name in counter.sensors], self.client,
                             state_file=self.folder / "state.json", clock=lambda: self.now, monotonic=lambda: self.ticks)
        self.heard, self.subscribed = 0, 0
        hear = self.client.on_message

        def heard(*more):
            hear(*more)
            self.heard += 1
        self.client.on_message = heard
        self.client.on_subscribe = lambda *_: setattr(self, "subscribed", self.subscribed + 1)
        self.connect()
        self.counter = counter

    def connect(self):
        wanted = self.subscribed + len({source.topic for source in self.bridge._sources})
        self.client.connect("127.0.0.1", self.broker.port)
        self.until(lambda: self.subscribed >= wanted)

    def until(self, holds):
        for _ in range(2000):
            if holds():
                return
            self.client.loop(0.01)
        raise AssertionError("nothing came")

    def go_to(self, at, step=0.0):
        """step: so much of it by the clock alone."""
        until = self.ticks + at - self.now - step
        while self.ticks < until:
            wait = min(240.0, until - self.ticks)
            self.now, self.ticks = self.now + wait, self.ticks + wait
            self.bridge._update()
        self.now, self.ticks = at, until
        self.bridge._update()

    def say(self, sensor, payload, times=1, retain=False):
        wanted = self.heard + times
        for _ in range(times):
            self.sensors.publish(f"house/{sensor}", payload, qos=1, retain=retain).wait_for_publish(5)
        self.until(lambda: self.heard >= wanted)

    def stop(self):
        self.client.disconnect()
        self.sensors.loop_stop()
        self.sensors.disconnect()


@pytest.mark.parametrize("days", [1, pytest.param(30, marks=pytest.mark.slow)])
def test_days_with_restarts_lost_and_doubled_messages_and_steps_of_the_clock_are_counted_as_pirsim_does(
        days, broker, made, tmp_path):  # noqa: F811
    draw = random.Random(days)
    file = made(draw, sensors=2)
    house = House(broker, file, tmp_path)
    names, known, at = house.counter.sensors, [], T0  # known: (time, sensor, state) as the bridge may know them
    begun, ended = [0], []  # readings with which counting begins anew, and before which it did
    for _ in range(240 * days):
        at = round(at + draw.expovariate(days * 240 / (days * 86400 - 3600)), 3)
        house.go_to(at)
        happens = draw.random()
        sensor, state = draw.choice(names), draw.random() < 0.5
        if happens < 0.01:  # the bridge starts anew
            house.client.disconnect()
            house.client.loop(0.01)
            house.start()
            begin = STEP_S * int(at // STEP_S)
            known = [event for event in known if event[0] < begin] + [(begin, name, None) for name in names]
        elif happens < 0.02:  # the broker does
            broker.stop()
            house.until(lambda: not house.bridge._connected)
            known += [(at, name, None) for name in names]
            broker.start()
            house.connect()
            house.sensors.reconnect()
        elif happens < 0.03:  # the clock steps: an hour that never was
            ended.append(int((at - T0) // STEP_S))
            at += 3600
            house.go_to(at, step=3600)
            begun.append(int((at - T0) // STEP_S))
            known += [(T0 + STEP_S * begun[-1], name, None) for name in names]
        elif happens < 0.06:  # a message that the broker keeps for whoever comes later, and is older than that
            house.say(sensor, "ON", retain=True)
            house.say(sensor, "OFF")
            known += [(at, sensor, True), (at, sensor, False)]
            at += 90
            house.go_to(at)
            house.client.unsubscribe(f"house/{sensor}")
            house.client.subscribe(f"house/{sensor}", 1)
            wanted = house.heard + 1
            house.until(lambda: house.heard >= wanted)
            house.sensors.publish(f"house/{sensor}", b"", qos=1, retain=True).wait_for_publish(5)
            wanted += 1
            house.until(lambda: house.heard >= wanted)
            known.append((at, sensor, None))  # an empty message says nothing
        elif happens < 0.08:  # what no sensor says
            house.say(sensor, draw.choice([b"[" * 100_000, b"\xff\x00", b"9" * 5000, '{"occupancy": NaN}']))
            known.append((at, sensor, None))
        else:
            house.say(sensor, draw.choice(["ON", '{"occupancy": true}'] if state else ["OFF", '{"occupancy": false}']),
                      times=2 if draw.random() < 0.1 else 1)
            known.append((at, sensor, state))
    n = int((at - T0) // STEP_S) + 1
    house.go_to(T0 + n * STEP_S)
    parts = list(zip(begun, [*ended, n]))
    assert [one.time for one in house.told] == [T0 + STEP_S * (i + 1) for begin, end in parts for i in range(begin, end)]
    bits = bits_of(known, names, n)
    assert 0.02 < (bits == 2).mean() < 0.9 and (bits == 1).sum() > 20 and len(parts) > 1
    pirsims = counting.load(file)
    same(house.told, np.concatenate([pirsims.estimate(bits[begin:end], smoothed=False).probabilities for begin, end in parts]))
    house.stop()


def test_a_clock_that_steps_back_begins_anew(broker, made, tmp_path):  # noqa: F811
    house = House(broker, made(random.Random(6), sensors=1), tmp_path)
    house.say("sensor_1", "ON")
    house.go_to(T0 + 7200)
    house.go_to(T0 + 3600 + 7, step=-3593)
    assert house.counter.time == T0 + 3607 and house.counter.last is None
    house.go_to(T0 + 3600 + 67)
    assert house.told[-1].time == T0 + 3660 and not house.told[-1].known
    house.stop()


def test_home_assistant_is_told_of_a_device_and_hears_motion_at_once(broker, made, tmp_path):  # noqa: F811
    seen = {}
    watcher = paho.Client(paho.CallbackAPIVersion.VERSION2)
    watcher.on_message = lambda _client, _data, message: seen.__setitem__(message.topic, message.payload.decode())
    watcher.connect("127.0.0.1", broker.port)
    watcher.subscribe([("homeassistant/#", 1), ("pirsim/#", 1)])
    watcher.loop_start()
    house = House(broker, made(random.Random(4), sensors=2), tmp_path)

    def until(holds):
        for _ in range(1000):
            if holds():
                return
            house.client.loop(0.01)
            time.sleep(0.005)
        raise AssertionError(seen)
    until(lambda: len(seen) >= 3)
    device = json.loads(seen["homeassistant/device/pirsim_pirsim/config"])
    parts = device["cmps"]
    assert {name: part["p"] for name, part in parts.items()} == {
        "people": "sensor", "nobody": "sensor", "occupancy": "binary_sensor", "problem": "binary_sensor"}
    assert len({part["unique_id"] for part in parts.values()}) == 4 and parts["people"]["expire_after"] == 90
    assert seen["pirsim/pirsim/status"] == "online"
    assert json.loads(seen["pirsim/pirsim/state"]) == {"people": None, "nobody": None, "occupancy": None}
    house.say("sensor_1", "ON")
    until(lambda: json.loads(seen["pirsim/pirsim/state"])["occupancy"] == "ON")
    house.say("sensor_1", "OFF")
    house.go_to(T0 + 60)
    until(lambda: json.loads(seen["pirsim/pirsim/state"])["people"] is not None)
    assert 0 <= json.loads(seen["pirsim/pirsim/state"])["nobody"] <= 100
    house.client.socket().shutdown(socket.SHUT_RDWR)  # dies without a word
    until(lambda: seen["pirsim/pirsim/status"] == "offline")
    watcher.loop_stop()
    house.stop()


def test_the_command_counts_with_a_password_and_goes_on_after_the_broker_did(made, tmp_path):  # noqa: F811
    subprocess.run(["mosquitto_passwd", "-c", "-b", tmp_path / "passwords", "bridge", "secret"], check=True, capture_output=True)
    broker = Broker(tmp_path, f"password_file {tmp_path / 'passwords'}")
    (tmp_path / "password").write_text("secret\n")
    word = ["mqtt", "--counter", str(made(random.Random(5), sensors=1)), "--broker", "127.0.0.1", "--port", str(broker.port),
            "--sensor", "sensor_1=hall", "--user", "bridge", "--password-file", str(tmp_path / "password")]
    (tmp_path / "options").write_text("\n".join(word[1:]))
    command = [sys.executable, "-m", "pirsim_live", "mqtt", f"@{tmp_path / 'options'}"]
    seen = []
    watcher = paho.Client(paho.CallbackAPIVersion.VERSION2)
    watcher.username_pw_set("bridge", "secret")
    watcher.on_connect = lambda client, *_: client.subscribe("pirsim/pirsim/status", 1)
    watcher.on_message = lambda _client, _data, message: seen.append(message.payload.decode())
    watcher.reconnect_delay_set(1, 1)
    watcher.connect("127.0.0.1", broker.port)
    watcher.loop_start()
    bridge = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)

    def until(holds, seconds=20):
        for _ in range(20 * seconds):
            if holds():
                return
            time.sleep(0.05)
        bridge.kill()
        raise AssertionError((seen, bridge.communicate()[1]))
    until(lambda: seen[-1:] == ["online"])
    broker.stop()
    seen.clear()
    broker.start()
    until(lambda: seen[-1:] == ["online"])
    bridge.terminate()
    assert bridge.wait(10) == 0
    until(lambda: seen[-1:] == ["offline"])
    watcher.loop_stop()
    broker.stop()
    for wrong, code in ((["mqtt", "--counter", "nowhere.json", *word[3:]], 4), ([*word, "--sensor", "hall=x"], 2)):
        result = subprocess.run([sys.executable, "-m", "pirsim_live", *wrong], capture_output=True, text=True)
        assert result.returncode == code and result.stderr.startswith("error: "), result
    assert pathlib.Path(word[2]).exists()


@pytest.mark.skipif(shutil.which("openssl") is None, reason="needs openssl to make a certificate")
@pytest.mark.parametrize("trusts", [True, False])
def test_a_broker_with_another_certificate_is_refused(trusts, made, tmp_path):  # noqa: F811
    subprocess.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "1", "-subj", "/CN=127.0.0.1", "-addext",
                    "subjectAltName=IP:127.0.0.1", "-keyout", tmp_path / "key.pem", "-out", tmp_path / "ca.pem"],
                   check=True, capture_output=True)
    broker = Broker(tmp_path, "allow_anonymous true", f"certfile {tmp_path / 'ca.pem'}", f"keyfile {tmp_path / 'key.pem'}")
    bridge = subprocess.Popen([sys.executable, "-m", "pirsim_live", "mqtt", "--counter", made(random.Random(5), sensors=1), "--broker",
                               "127.0.0.1", "--port", str(broker.port), "--sensor", "sensor_1=hall", "--tls",
                               *(["--ca", tmp_path / "ca.pem"] if trusts else [])], stderr=subprocess.PIPE, text=True)
    line = bridge.stderr.readline()
    assert line.startswith("connected: ") if trusts else "certificate verify failed" in line, line
    bridge.terminate()
    assert bridge.wait(10) == 0
    bridge.stderr.close()
    broker.stop()
