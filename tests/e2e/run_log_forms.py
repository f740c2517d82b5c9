#!/usr/bin/env python3
"""`pirsim log` on logs as public projects write them: forms times troubles, each made from what two sensors really did.
Whatever is printed is what they did; whatever is refused is refused by a message whose map, cut out of it, gives what they
did, or by the words that REFUSED has.

Usage: run_log_forms.py PIRSIM DATA_DIR [unittest arguments]. Needs python3 only.
"""
import datetime
import gzip
import json
import random
import re
import subprocess
import zoneinfo

from program import PIRSIM, Case, main

UTC = datetime.timezone.utc
BERLIN = zoneinfo.ZoneInfo("Europe/Berlin")
START = datetime.datetime(2026, 3, 2, 6, tzinfo=UTC)  # 07:00 in Berlin
HOURS = 5
UNITS = {"s": 1 / 3600, "min": 1 / 60, "h": 1, "d": 24}


def tracks():
    """Of each sensor (begin, end) of its motion, whole seconds: a quiet one and a busy one."""
    draw = random.Random(73)
    result = {}
    for name, gap in (("hall", 160), ("desk", 260)):
        result[name], at = [], 0
        while (at := at + 20 + int(draw.expovariate(1 / gap))) < HOURS * 3600 - 90:
            result[name].append((at, at + draw.randrange(9, 75)))
            at = result[name][-1][1]
    return result


TRACKS = tracks()


class Moment:
    def __init__(self, second):
        self.utc = START + datetime.timedelta(seconds=second)
        self.local = self.utc.astimezone(BERLIN)
        self.second = second
        self.epoch = int(self.utc.timestamp())
        self.z = self.utc.strftime("%Y-%m-%dT%H:%M:%S.000Z")
        self.text = self.local.strftime("%Y-%m-%d %H:%M:%S")
        self.days = (self.local.replace(tzinfo=None) - datetime.datetime(1899, 12, 30)).total_seconds() / 86400

    def at(self, pattern):
        return self.local.strftime(pattern)


def events(line, header=(), on="on", off="off", name="{}"):
    """Lines of changes: header, body, and the share of the known time that each sensor moves."""
    told = sorted([(i, sensor, off) for i, sensor in enumerate(TRACKS)] + [
        (at, sensor, word) for sensor, track in TRACKS.items() for begin, end in track for at, word in ((begin, on), (end, off))])
    last = told[-1][0]
    shares = [sum(end - begin for begin, end in track) / (last - i) for i, track in enumerate(TRACKS.values())]
    return list(header), [line(Moment(at), name.format(sensor), word) for at, sensor, word in told], shares, last / 3600


def readings(line, header=(), step=30, on="1", off="0"):
    """A line every `step` seconds, with a word a sensor that moved in it."""
    count = HOURS * 3600 // step
    moved = [[any(begin < (i + 1) * step and end > i * step for begin, end in track) for i in range(count)]
             for track in TRACKS.values()]
    return (list(header), [line(Moment((i + 1) * step), [on if bits[i] else off for bits in moved]) for i in range(count)],
            [sum(bits) / count for bits in moved], HOURS)


def intervals(line, header=()):
    """A line a stretch of motion."""
    told = sorted((begin, end, sensor) for sensor, track in TRACKS.items() for begin, end in track)
    long = max(end for _, end, _ in told) - told[0][0]
    return (list(header), [line(Moment(begin), Moment(end), sensor, i) for i, (begin, end, sensor) in enumerate(told)],
            [sum(end - begin for begin, end in track) / long for track in TRACKS.values()], long / 3600)


def one(line):
    """A document of JSON: one line, made of all."""
    header, body, shares, hours = line
    return header, ["[" + ",".join(body) + "]"], shares, hours


J = json.dumps
FORMS = {
    "Home Assistant's history": events(lambda m, s, v: f"{s},{v},{m.z}",
           ["entity_id,state,last_changed"], name="binary_sensor.{}_motion"),
    "Home Assistant's table": events(lambda m, s, v: f"{m.second},{s},{v},{m.epoch}.25",
           ["state_id,entity_id,state,last_updated_ts"], name="binary_sensor.{}_motion"),
    "Node-RED": events(lambda m, s, v: J({"sensor": s, "state": v, "time": m.z})),
    "Zigbee2MQTT 1": events(lambda m, s, v: f"Zigbee2MQTT:info  {m.text}: MQTT publish: "
                            f"topic 'zigbee2mqtt/{s}', payload '{{\"battery\":97,\"occupancy\":{v}}}'", on="true", off="false"),
    "Zigbee2MQTT 2": events(lambda m, s, v: f"[{m.text}] info: \tz2m:mqtt: MQTT publish: "
                            f"topic 'zigbee2mqtt/{s}', payload '{{\"occupancy\":{v}}}'", on="true", off="false"),
    "openHAB": events(lambda m, s, v: f"{m.text}.123 [INFO ] [openhab.event.ItemStateChangedEvent   ] - "
                      f"Item '{s}' changed from {'OFF' if v == 'ON' else 'ON'} to {v}", on="ON", off="OFF"),
    "FHEM's FileLog": events(lambda m, s, v: f"{m.at('%Y-%m-%d_%H:%M:%S')} {s} motion: {v}"),
    "ioBroker": events(lambda m, s, v: f'"{s}","{m.epoch}000","{v}","1","0"', ['"name","ts","val","ack","q"'],
           on="true", off="false", name="zigbee.0.{}.occupancy"),
    "Hubitat": events(lambda m, s, v: f'"{s}","motion","{v}","","{s} is {v}","DEVICE","{m.text}.000"',
           ['"device","name","value","unit","description","source","date"'], on="active", off="inactive"),
    "SmartThings": events(lambda m, s, v: f"{m.at('%m/%d/%Y %H:%M:%S')}\t{s}\tmotion\t{v}\t{s} is {v}",
           ["Date/Time\tDevice\tEvent Name\tEvent Value\tDescription"], on="active", off="inactive"),
    "ESPHome": events(lambda m, s, v: f"[{m.at('%H:%M:%S')}][D][binary_sensor:036]: '{s} PIR': Sending state {v}",
           on="ON", off="OFF"),
    "CASAS aruba": events(lambda m, s, v: f"{m.text}.000012 {s} {v}", on="ON", off="OFF", name="M_{}"),
    "CASAS hh": events(lambda m, s, v: f"{m.text}.5\tM{['hall', 'desk'].index(s):03}\tKitchen\tKitchenArea\t{v}\tControl4-Motion",
           on="ON", off="OFF"),
    "AppDaemon": events(lambda m, s, v: f"{m.text}.000001 INFO motionlog: binary_sensor.{s}_motion: "
                        f"{'off' if v == 'on' else 'on'} -> {v}"),
    "old and new": events(lambda m, s, v: f"{m.text},{s},{1 - int(v)},{v}", ["time,sensor,from,to"], on="1", off="0"),
    "a line a property": events(lambda m, s, v: f"{m.text},{s},motion,{v}" + f"\n{m.text},{s},light,{m.second // 60 % 2}" *
                                (m.second % 3 == 0), ["date,device,type,state"], on="1", off="0"),
    "Home Assistant, all domains": events(lambda m, s, v: f"{s},{v},{m.z}" + "".join(
        f"\n{x},{('off', 'on')[m.second // 7 % 2]},{m.z}" for x in ("light.motion_night_light", "binary_sensor.hall_motion_tamper")),
           ["entity_id,state,last_changed"], name="binary_sensor.{}_motion"),
    "vacant": readings(lambda m, b: f"{m.text},{b[0]},{b[1]}", ["time,hall_vacant,desk_vacant"], on="0", off="1"),
    "hours": readings(lambda m, b: f"{m.second / 3600:.6f},{b[0]},{b[1]}", ["Time (h),pir_hall,pir_desk"]),
    "Arduino's milliseconds": readings(lambda m, b: f"{m.second}000,{b[0]},{b[1]}", ["time,pir_hall,pir_desk"]),
    "MySQL's batch": events(lambda m, s, v: f"{m.second}\t{m.text}\t{s}\t{v}", ["id\tts\tsensor\tstate"], on="1", off="0"),
    "Z-Wave": events(lambda m, s, v: f"{m.text},{s},{v}", ["time,name,value"], on="255", off="0"),
    "Tuya": events(lambda m, s, v: f"{m.text},{s},{v}", ["time,device,event"], on="pir", off="none"),
    "days since 1900, events": events(lambda m, s, v: f"{m.days:.8f},{s},{v}", ["Time,Sensor,State"], on="ON", off="OFF"),
    "UCI 864": readings(lambda m, b: f"{m.at('%Y/%m/%d,%H:%M:%S')},24.9,121,{b[0]},{b[1]}",
           ["Date,Time,S1_Temp,S1_Light,S6_PIR,S7_PIR"]),
    "a German spreadsheet": readings(lambda m, b: f"{m.at('%d.%m.%Y %H:%M:%S')};{b[0]};{b[1]};20,5",
           ["Zeit;PIR Flur;PIR Tisch;Temperatur"]),
    "days since 1900": readings(lambda m, b: f"{m.days:.9f},{b[0]},{b[1]}", ["Time,PIR1,PIR2"]),
    "days since 1900, decimal commas": readings(lambda m, b: f"{m.days:.5f}".replace(".", ",") + f";{b[0]};{b[1]}",
           ["Zeit;PIR1;PIR2"]),
    "R's write.csv": readings(lambda m, b: f'"{m.second}",{m.text},{b[0]},{b[1]}', ['"","time","hall","desk"'],
           on="TRUE", off="FALSE"),
    "R's write.table": readings(lambda m, b: f'"{m.second}","{m.text}",{b[0]},{b[1]}', ['"time","hall","desk"']),
    "pandas": readings(lambda m, b: f"{m.text}+01:00,{b[0]},{b[1]}", [",hall,desk"], on="True", off="False"),
    "Grafana": readings(lambda m, b: f"{m.epoch}000,{b[0]},{b[1]}", ['"Time","motion hall","motion desk"']),
    "MATLAB": readings(lambda m, b: f"{m.at('%d-%b-%Y %H:%M:%S')},{b[0]},{b[1]}", ["Time,pir_hall,pir_desk"]),
    "counts": readings(lambda m, b: f"{m.z},{b[0]},{b[1]},21", ["time,motion_hall,motion_desk,temperature"],
           on="7", off="0", step=60),
    "Frigate": intervals(lambda a, b, s, i: f"{a.epoch}.{i:06}-ab,{s},person,{a.epoch}.25,{b.epoch}.25",
           ["id,camera,label,start_time,end_time"]),
    "van Kasteren": intervals(lambda a, b, s, i: f"{a.at('%d-%b-%Y %H:%M:%S')}\t{b.at('%d-%b-%Y %H:%M:%S')}\t{5 + 3 * (s == 'desk')}\t1",
           ["Start time\tEnd time\tID\tVal"]),
    "InfluxDB": events(lambda m, s, v: f",,0,2026-02-20T00:00:00Z,2026-03-03T00:00:00Z,{m.z},{v},{s}",
           [",result,table,_start,_stop,_time,_value,entity_id"], on="1", off="0"),
    "an array of JSON": one(events(lambda m, s, v: J({"entity_id": s, "state": v, "last_changed": m.z}))),
}
TROUBLES = ("plain", "crlf", "utf16", "gz", "doubled", "newest first", "cut", "title", "comments", "header again", "blank lines",
            "two files", "overlap")
# (form, trouble): words of the refusal; everything else is right, or its refusal's map makes it right.
REFUSED = {("ioBroker", "cut"): "a quote that isn't closed", ("Hubitat", "cut"): "a quote that isn't closed",
           ("R's write.table", "cut"): "a quote that isn't closed",
           ("AppDaemon", "title"): "expected 2 fields, got 8",
           ("Home Assistant, all domains", "cut"): "another kind of time",
           ("Node-RED", "title"): "may be a time", ("Node-RED", "comments"): "may be a time",
           ("R's write.table", "title"): "may be a time", ("CASAS aruba", "title"): "expected 2 fields, got 4",
           ("ESPHome", "newest first"): "turn the lines round", ("ESPHome", "two files"): "join them in one",
           ("ESPHome", "overlap"): "join them in one"}


def files(header, body, trouble):
    """Name: bytes."""
    middle = len(body) // 2
    if trouble == "doubled":
        body = body[:middle] + [body[middle]] + body[middle:]
    elif trouble == "newest first":
        body = body[::-1]
    elif trouble == "title":
        header = ["Motion report", *header]
    elif trouble == "comments":
        header = ["# logger 1.2", "# at home", *header]
    elif trouble == "header again":
        body = body[:middle] + header + body[middle:]
    elif trouble == "blank lines":
        body = [*body[:middle], "", *body[middle:], "", ""]
    elif trouble in ("two files", "overlap"):
        return {f"{i}.csv": ("\n".join(header + part) + "\n").encode()
                for i, part in enumerate((body[:middle + (20 if trouble == "overlap" else 0)], body[middle:]), 1)}
    text = ("\r\n" if trouble == "crlf" else "\n").join(header + body) + "\n"
    if trouble == "cut":
        text = text[:-len(body[-1]) // 2 - 1]
    data = text.encode("utf-16" if trouble == "utf16" else "utf-8")
    return {"log.csv.gz": gzip.compress(data)} if trouble == "gz" else {"log.csv": data}


def printed(text):
    """Hours, and of each sensor the per cent of the known time that it moves."""
    hours = re.search(r"\(([\d.]+) (s|min|h|d)\)", text)
    table = text.split("\nsensor ", 1)[-1].split("\n\n")[0].splitlines()[1:]
    return float(hours[1]) * UNITS[hours[2]], sorted(float(re.search(r"  +([\d.]+) %", line)[1]) for line in table)


class Forms(Case):
    def log(self, names, *args):
        result = subprocess.run([PIRSIM, "log", *names, *args], capture_output=True, text=True, timeout=60, cwd=self.folder)
        return result.returncode, result.stdout, result.stderr

    def right(self, text, shares, hours):
        got_hours, got = printed(text)
        return (abs(got_hours - hours) < 0.1 and len(got) == len(shares) and
                all(abs(a - 100 * b) < 0.3 for a, b in zip(got, sorted(shares))))

    def outcome(self, form, trouble):
        """Nothing, or what is wrong."""
        header, body, shares, hours = FORMS[form]
        made = files(header, body, trouble)
        for name, data in made.items():
            self.write(name, data)
        args, seen = [], set()
        while True:
            code, text, told = self.log(made, *args)
            if words := REFUSED.get((form, trouble)):
                return None if code == 3 and words in told else f"code {code}, expected to be refused with '{words}': {told[:300]}"
            if code == 0:
                return None if self.right(text, shares, hours) else f"wrong, after {args}: {text[:400]} {told[:200]}"
            offered = re.findall(r"\{pirsim_log: 1(?:[^{}]|\{[^{}]*\})*\}", told)
            if code != 3 or not offered or told in seen:
                return f"code {code}: {told[:300]}"
            seen.add(told)
            for choice in offered:  # of several one is right
                self.write("map.yaml", choice)
                args = ["--map", "map.yaml"]
                tried, text, _ = self.log(made, *args)
                if tried == 0 and self.right(text, shares, hours):
                    return None


def add(form, number):
    def test(self):
        troubles = TROUBLES[:1] if len(FORMS[form][1]) == 1 else TROUBLES
        wrong = {trouble: found for trouble in troubles if (found := self.outcome(form, trouble))}
        self.assertEqual(wrong, {})
    setattr(Forms, f"test_{number:02}_" + re.sub(r"\W+", "_", form), test)


for number_of, form_of in enumerate(FORMS):
    add(form_of, number_of)

if __name__ == "__main__":
    main()
