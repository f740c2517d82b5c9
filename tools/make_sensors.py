#!/usr/bin/env python3
"""Writes data/sensors/<model>.yaml: Panasonic's lenses from data/sensors/lens_library.json, modules and devices of
other makes from the numbers below. Run it after the library or these numbers change."""
import json
import math
import pathlib

SENSORS = pathlib.Path(__file__).resolve().parent.parent / "data" / "sensors"
QUAD = "four 0.6 mm squares with 0.4 mm gaps"
DRAWING = "measured: the catalogue's vector drawing of the zones, "
CONFIDENCE = {
    "EKMC1604111": "68 of 68 zone centres checked against a second drawing (ekmc1604111_zones.csv)",
    "EKMC1606111": "completed by symmetry", "AMN32111": "completed by symmetry", "EKMC1607111": "a sketch",
}


def sources_of(name, lens):
    confidence = CONFIDENCE.get(name, "every zone found in it")
    sources = {"plane_m": "quoted: the plane on which the catalogue draws the zones",
               "x_m": DRAWING + confidence, "y_m": DRAWING + confidence}
    distance_m, page, is_plane, targets = RATED[name]
    if name == "EKMC1604111":
        law = "inferred: from the quad (" + QUAD + ") and the drawing, "
        sources["half_spacing_ratio"] = law + "0.5 * sqrt(2) * 1.0 mm / 10.0 mm"
        sources["half_diagonal_ratio"] = law + "0.5 * sqrt(2) * 0.6 mm / 10.0 mm"
        sources["range_m"] = sources["lens_step"] = "quoted: 12, 6 and 3 m for the first, second and third lens step"
    else:
        sources["zone_side_m"] = DRAWING + "side of a single zone"
        sources["range_m"] = f"quoted: {CATALOGUE}, p. {page}: up to {distance_m:g} m, drawn as an arc"
        if is_plane:
            sources["range_m"] = (f"inferred: {CATALOGUE}, p. {page}, rates a plane {distance_m:g} m ahead; each "
                                  "facet's distance is as far as that plane in its direction")
            sources["lens_step"] = "inferred: facets that see the plane from equally far away have equal apertures"
        sources["pitch_m"] = pitch_source(lens)
        if any("missing_element" in facet for facet in lens["facets"]):
            sources["missing"] = DRAWING + "three of the four zones are drawn"
    for key in dict.fromkeys(key for target in targets for key in target if key != "lens_step"):
        sources[key] = f"quoted: {CATALOGUE}, p. {page}"
    sources["polarity"] = "assumed: neighbours on the quad differ; considered: checkerboard, all the same"
    return sources | detector_sources(papirs_detector())


CATALOGUE = "Panasonic's catalogue of PIR motion sensors (2020)"
SLIGHT = {"width_m": 0.2, "height_m": 0.2, "speed_m_s": 0.5, "zones": 1}
WITHIN_RINGS_DEG = 1.0  # facets that are equally far off the axis but for how exactly a drawing is read


def slight_motion(*rings):
    return [{"lens_step": ring} | SLIGHT for ring in rings]


# Rated distance in metres, page, whether a plane that far ahead is rated (the drawing ends at it) and not an arc, and
# the targets of lens steps that aren't a plate of 700 x 250 mm at 1 m/s that crosses two zones.
RATED = {
    "EKMC1607111": (5, 6, False, []),
    "EKMC1601111": (5, 7, False, []),
    "EKMC1691111": (2.5, 8, True, slight_motion(1, 2, 3)),
    "EKMC1693111": (2.2, 9, True, slight_motion(1, 2, 3) + [{"lens_step": 4, "width_m": 0.2, "height_m": 0.4}]),
    "EKMC1606111": (12, 10, True, []),
    "EKMC1604111": (None, 12, False, []),
    "EKMC1603111": (12, 13, False, []),
    "AMN31111": (5, 17, False, []),
    "AMN32111": (2, 18, True, slight_motion(1, 2, 3)),
    "AMN33111": (5, 19, True, []),
    "AMN34111": (10, 20, False, []),
}


QUOTED_ANALOG = "quoted: data sheet of the analogue sibling EKMC26, "
REFERENCE_DESIGNS = "Texas Instruments' reference designs TIDA-010027 (0.3 to 6.5 Hz) and TIDA-00489 (0.7 to 10.6 Hz)"
# Keys of a detector, their values and where they come from; docs/physics/analog.md explains them.
PAPIRS_DETECTOR = {
    "element": {
        "thermal_s": (0.15, "assumed: nobody says; range considered 0.05 to 1"),
        "electrical_s": (1.0, "assumed: nobody says; range considered 0.3 to 3"),
    },
    "amplifier": {
        "low_hz": (0.3, "assumed: as in " + REFERENCE_DESIGNS + "; range considered 0.3 to 0.7"),
        "high_hz": (6.5, "assumed: as in " + REFERENCE_DESIGNS + "; range considered 6.5 to 10.6"),
        "order": (2, "assumed: two equal amplifier stages, as in TIDA-00489; considered: 1 to 3"),
        "noise_v_pp": (0.08, QUOTED_ANALOG + "steady noise 80 mVpp, at most 150 mVpp"),
        "offset_v": (1.1, QUOTED_ANALOG + "1.0 to 1.2 V"),
        "lowest_v": (0.2, QUOTED_ANALOG + "saturates at 0.2 V or less"),
        "highest_v": (1.9, QUOTED_ANALOG + "saturates at 1.9 V or more"),
    },
    "comparator": {
        "positive_v": (0.45, "assumed: half of what the output can swing; range considered 0.2 to 0.6"),
        "negative_v": (0.45, "assumed: half of what the output can swing; range considered 0.2 to 0.6"),
    },
}


# Mount, trimmer and what stands before a sensor weigh more than its make: docs/physics/analog.md#units
IN_ROOMS = {
    "median": (4.1, "fitted: a bench, an office, a study cube, meeting rooms and a house have 1.1 to 9.6; range considered 0.8 to 12.8"),
    "installation_sd": (0.9, "fitted: to the same five; range considered 0.5 to 1"),
}
PAPIRS_SENSITIVITY = IN_ROOMS | {
    "sd": (0.1, "assumed: 7.6 uW/cm2, the most, lies three standard deviations off the average, ln(7.6 / 5.6) / 3; "
                "range considered 0.07 to 0.15"),
}


def papirs_detector():
    return {"sensitivity": PAPIRS_SENSITIVITY} | PAPIRS_DETECTOR


def detector_sources(detector):
    return {key: source for block in detector.values() for key, (_, source) in block.items()}


def detector_lines(detector):
    for name, block in detector.items():
        yield name + ": {" + ", ".join(f"{key}: {value}" for key, (value, _) in block.items()) + "}"


def pitch_source(lens):
    if any("pitch_m" in facet for facet in lens["facets"]):
        return DRAWING + "where it shows; inferred for the others by the same ratio to zone_side_m"
    return "inferred: zone_side_m * 1.0 / 0.6, from the quad (" + QUAD + ")"


def pitch_ratio(lens):
    drawn = [facet["pitch_m"] / facet["zone_side_m"] for facet in lens["facets"] if "pitch_m" in facet]
    return sum(drawn) / len(drawn) if drawn else 1.0 / 0.6


def off_axis_deg(facet, lens):
    return math.degrees(math.atan2(math.hypot(facet["x"], facet["y"]), lens["plane_m"]))


def rings(lens):
    """Where the rings of facets begin, degrees off the axis."""
    begins = []
    for angle in sorted(off_axis_deg(facet, lens) for facet in lens["facets"]):
        if not begins or angle > begins[-1] + WITHIN_RINGS_DEG:
            begins.append(angle)
    return begins


def facet_line(name, facet, lens):
    fields = {"x_m": facet["x"] + 0.0, "y_m": facet["y"] + 0.0}
    if "step" in facet:
        fields |= {"lens_step": facet["step"], "range_m": facet["range_m"]}
    else:
        pitch = facet.get("pitch_m", round(facet["zone_side_m"] * pitch_ratio(lens), 4))
        fields |= {"zone_side_m": facet["zone_side_m"], "pitch_m": pitch}
        if "missing_element" in facet:
            fields["missing"] = "outer"
        distance_m, _, is_plane, _ = RATED[name]
        if is_plane:
            angle = off_axis_deg(facet, lens)
            fields["lens_step"] = sum(begin <= angle for begin in rings(lens))
            fields["range_m"] = round(distance_m / math.cos(math.radians(angle)), 2)
    return "  - {" + ", ".join(f"{key}: {value}" for key, value in fields.items()) + "}"


def yaml_of(name, lens):
    lines = ["# Written by tools/make_sensors.py from lens_library.json; the format is docs/formats/sensor.md.",
             f"id: {name}", f"description: Panasonic PaPIRs {lens['family'].split(' (')[0]}, {lens['zones']} zones",
             f"plane_m: {float(lens['plane_m'])}"]
    distance_m, _, is_plane, targets = RATED[name]
    if name == "EKMC1604111":
        lines += ["layout: diamond", "half_spacing_ratio: 0.0707", "half_diagonal_ratio: 0.0424"]
    else:
        lines += ["layout: square"] + ([] if is_plane else [f"range_m: {float(distance_m)}"])
    if targets:
        lines += ["targets:"] + ["  - {" + ", ".join(f"{key}: {value}" for key, value in target.items()) + "}"
                                 for target in targets]
    lines += ["polarity: checkerboard", *detector_lines(papirs_detector()), "sources:"]
    lines += [f'  {key}: "{text}"' for key, text in sources_of(name, lens).items()]
    lines += ["facets:"] + [facet_line(name, facet, lens) for facet in lens["facets"]]
    return "\n".join(lines) + "\n"


# -- what other makes sell: a dual element behind a dome of small lenses, of which nobody has a drawing -------------

CIRCUIT = "assumed: in volts of a module with 3.3 V, of which only the ratios matter; "
DUAL_DETECTOR = {
    "element": {
        "thermal_s": (0.2, "assumed: nobody says; range considered 0.05 to 1"),
        "electrical_s": (2.0, "assumed: nobody says; range considered 0.3 to 3"),
    },
    "amplifier": {
        "low_hz": (0.3, "assumed: as in " + REFERENCE_DESIGNS + "; range considered 0.2 to 0.7"),
        "high_hz": (8.0, "assumed: as in " + REFERENCE_DESIGNS + "; range considered 6.5 to 10.6"),
        "order": (2, "assumed: two equal amplifier stages, as in TIDA-00489; considered: 1 to 3"),
        "noise_v_pp": (0.2, CIRCUIT + "range considered 0.1 to 0.4"),
        "offset_v": (1.65, CIRCUIT + "half of the supply"),
        "lowest_v": (0.1, CIRCUIT + "the supply's rail"),
        "highest_v": (3.2, CIRCUIT + "the supply's rail"),
    },
    "comparator": {
        "positive_v": (0.66, "inferred: 0.7 of 3.3 V (BISS0001 data sheet) less the offset; "
                             "assumed for circuits of another kind"),
        "negative_v": (0.66, "inferred: the offset less 0.3 of 3.3 V (BISS0001 data sheet); "
                             "assumed for circuits of another kind"),
    },
}
HC_SR501 = (2.3, "fitted: a bench has 1.1, an office 3.1 and a study cube 3.7, trimmers at their most; half of it with the "
                 "trimmer at half; range considered 0.8 to 12.8")
AS_A_WALKER = (0.7, "inferred: somebody who walks past is just noticed at the rated distance; range considered 0.5 to 1.1")
UNITS_SD = (0.2, "assumed: twice that of PaPIRs, since nobody promises a least; range considered 0.1 to 0.4")
A_STAGE = (2.5, "inferred: two stages of 10 uF and 10 kOhm, 1.6 Hz each (the module's circuit); range considered 0.3 to 2.5")
ZIGBEE2MQTT = "https://www.zigbee2mqtt.io/devices/"
ISSUES = "https://github.com/Koenkk/zigbee2mqtt/issues/"
T1 = ("assumed: as its successor, the T1 (https://privatehomelab.com/aqara-motion-sensor-t1-rtcgq12lm-zigbee2mqtt-"
      "home-assistant/); range considered ")
HUB = "# That motion is over is said by the hub, after a clear time of its own, which is told to those who read its log"
AQARA = {
    "range_m": (7, T1 + "5 to 7 m"),
    "dome": {"wide_deg": (170, T1 + "120 to 170"),
             "tall_deg": (100, "assumed: nobody says; range considered 60 to 170")},
}
DEVICES = {
    "HC-SR501": {
        "description": "module with a BISS0001; generic dome",
        "names": ["HW-416", "HW-416-B"],
        "notes": ["# Its trimmers set the range, 3 to 7 m, and hold_s, 5 to 200 s (0.3 to 300 s told elsewhere). With",
                  "# its jumper on L motion doesn't prolong the output: again_s is then as long as hold_s."],
        "range_m": (7, "quoted: 3 to 7 m, https://www.radiolocman.com/op/device.html?di=602835&/HC-SR501"),
        "dome": {"wide_deg": (110, "quoted: a cone of 110 degrees, same page; 100, 120 and 140 told elsewhere")},
        "report": {"hold_s": (5, "quoted: 5 to 200 s by a trimmer, https://www.dkvolt.dk/produkt/pir-sensor-mini/"),
                   "blind_s": (2.5, "quoted: 2.5 s, http://escol.com.my/Products/HC-SR501.htm; 3 s told elsewhere")},
    },
    "AM312": {
        "description": "mini module; generic dome",
        "names": ["AS312", "HC-SR312", "M5Stack Unit PIR"],
        "range_m": (5, "quoted: 3 to 5 m, https://www.tagelabs.com/post/pir-sensors; 5 m with the AS312, "
                       "https://docs.m5stack.com/en/unit/pir"),
        "dome": {"lenses": (21, "assumed: nobody has a drawing; range considered 10 to 30"),
                 "wide_deg": (100, "quoted: a cone of about 100 degrees, same pages")},
        "report": {"hold_s": (2, "quoted: about 2 s, re-triggered, same pages; 2.3 to 3 s of the AM412"),
                   "blind_s": (2, "quoted: about 2 s, same pages")},
    },
    "RTCGQ11LM": {
        "description": "Aqara motion sensor; generic dome",
        "names": ["Aqara Motion Sensor", "lumi.sensor_motion.aq2"],
        "notes": [HUB, "# (hold_s of a log's map; the effect pulse_stretching): 90, 70 or 60 s."],
        **AQARA,
        "report": {"again_s": (60, "quoted: ignores motion for 60 s, " + ZIGBEE2MQTT + "RTCGQ11LM.html")},
    },
    "RTCGQ14LM": {
        "description": "Aqara motion sensor P1; generic dome",
        "names": ["Aqara Motion Sensor P1", "Aqara P1", "MS-S02", "lumi.motion.ac02"],
        "notes": [HUB, "# (hold_s of a log's map; the effect pulse_stretching): again_s + 2 s in Zigbee2MQTT."],
        **AQARA,
        "report": {"again_s": (30, "quoted: 2 to 65535 s can be set (detection_interval, " + ZIGBEE2MQTT +
                                   "RTCGQ14LM.html); 30 by default (deCONZ's description)")},
    },
    "SML001": {
        "description": "Philips Hue motion sensor; generic dome",
        "names": ["Philips Hue Motion Sensor", "Hue Motion Sensor", "9290012607"],
        "range_m": (5, "quoted: about 5 m, https://www.lukeangel.com/blog/hue-motion-sensor-purpose-built-lighting-"
                       "automation/"),
        "dome": {"wide_deg": (100, "assumed: a review says 60 (same page); range considered 60 to 120"),
                 "tall_deg": (90, "quoted: 90 degrees, same page")},
        "report": {"hold_s": (10, "measured: by users, 10 s after motion, 60 s of motion end at 70 s, "
                                  "https://github.com/Koenkk/zigbee-herdsman-converters/pull/184; can be set")},
    },
    "E1745": {
        "description": "IKEA TRADFRI motion sensor; generic dome",
        "names": ["IKEA TRADFRI Motion Sensor", "TRADFRI Motion Sensor"],
        "notes": ["# Its predecessor, the E1525, has a dial for the time on."],
        "range_m": (5, "assumed: nobody says; range considered 4 to 8 m"),
        "dome": {"wide_deg": (120, "assumed: nobody says; range considered 100 to 140"),
                 "tall_deg": (90, "assumed: nobody says; range considered 60 to 120")},
        "report": {"hold_s": (180, "measured: by users, off 180 s after the last report, " + ZIGBEE2MQTT +
                                   "E1525_E1745.html"),
                   "again_s": (97, "measured: by users, again after 97 s (same page) or 100 s (" + ISSUES + "3468)")},
    },
    "SNZB-03": {
        "description": "Sonoff motion sensor; generic dome",
        "names": ["Sonoff SNZB-03", "eWeLink RHK09", "MS01"],
        "range_m": (6, "quoted: 6 m, https://ixbt.com/live/chome/sonoff-snzb-03-byudzhetnyy-zigbee-datchik-dvizheniya-"
                       "obzor-i-podklyuchenie-v-tuya-smart-i-home-assistant.html"),
        "dome": {"wide_deg": (110, "quoted: 110 degrees, same page"),
                 "tall_deg": (90, "assumed: nobody says; range considered 60 to 110")},
        "report": {"hold_s": (60, "quoted: off after a minute without motion, the maker in " + ISSUES + "4874")},
    },
}


def device_yaml(name, device):
    is_bench = name == "HC-SR501"
    sensitivity = IN_ROOMS | {"median": HC_SR501 if is_bench else AS_A_WALKER, "sd": UNITS_SD}
    detector = DUAL_DETECTOR
    if is_bench:
        detector = detector | {"amplifier": detector["amplifier"] | {"low_hz": A_STAGE}}
    numbers = {"dome": device["dome"], "sensitivity": sensitivity, **detector, "report": device["report"]}
    sources = {"range_m": device["range_m"][1], **detector_sources(numbers)}
    lines = ["# Written by tools/make_sensors.py; the format is docs/formats/sensor.md.", *device.get("notes", []),
             f"id: {name}", f"description: {device['description']}", f"names: [{', '.join(device['names'])}]",
             f"range_m: {device['range_m'][0]}", *detector_lines(numbers), "sources:"]
    return "\n".join(lines + [f'  {key}: "{text}"' for key, text in sources.items()]) + "\n"


# -- Panasonic's wide lens, and its parts under other names ---------------------------------------------------------

WIDE_COLUMNS_M = [0.0, 0.275, -0.275, 0.53, -0.53, 0.815, -0.815, 1.165, -1.165, 1.615, -1.615]
# (x, y), half of the distance of opposite zones, lens step
WIDE_FACETS_M = [((x, y), 0.128, 1) for y in (-0.033, -0.285) for x in WIDE_COLUMNS_M] + [
    ((side * x, -0.02), spacing, 2) for x, spacing in ((2.275, 0.15), (3.525, 0.22)) for side in (1, -1)]
WIDE_DRAWING = "measured: the catalogue's picture of the zones at 1 m, whose pixels are 4 cm; centres to about 1 cm"


def wide_cluster(middle, spacing, step):
    """Four diamonds, the images of the turned quad: 0.6 mm squares, 1.0 mm from centre to centre."""
    yield f"  - lens_step: {step}\n    zones:"
    for i, (right, up) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):
        x, y = middle[0] + spacing * right, middle[1] + spacing * up
        corners = [f"[{x + 0.6 * spacing * a:.4f}, {y + 0.6 * spacing * b:.4f}]"
                   for a, b in ((1, 0), (0, 1), (-1, 0), (0, -1))]
        yield f"      - {{corners_m: [{', '.join(corners)}], polarity: {1 if i % 2 == 0 else -1}}}"


def wide_yaml():
    sources = {"plane_m": "quoted: the plane on which the catalogue draws the zones",
               "range_m": f"quoted: {CATALOGUE}, p. 11: up to 5 m, drawn as an arc",
               "lens_step": "quoted: area A, then area B to its sides",
               "contrast_k": f"quoted: {CATALOGUE}, p. 11: 8 K in area B",
               "corners_m": WIDE_DRAWING + "; sizes inferred from the quad (" + QUAD + ")",
               "polarity": "assumed: neighbours on the quad differ; considered: checkerboard, all the same"}
    detector = papirs_detector()
    sources |= detector_sources(detector)
    lines = ["# Written by tools/make_sensors.py; the format is docs/formats/sensor.md.", "id: EKMC1605111",
             "description: Panasonic PaPIRs EKM 05 horizontally wide, 104 zones", "plane_m: 1.0", "range_m: 5.0",
             "targets:", "  - {lens_step: 2, contrast_k: 8}", *detector_lines(detector), "sources:"]
    lines += [f'  {key}: "{text}"' for key, text in sources.items()] + ["clusters:"]
    for facet in WIDE_FACETS_M:
        lines += wide_cluster(*facet)
    return "\n".join(lines) + "\n"


NAMES = {"EKMC1603111": ["Everything Presence One", "Everything Presence Pro", "EP1"]}
EKMB = "quoted: timing chart of the 1 uA type, "


def with_names(name, text):
    names = f"names: [{', '.join(NAMES[name])}]\n" if name in NAMES else ""
    return text.replace("\nplane_m:", f"\n{names}plane_m:", 1)


def battery_yaml(text):
    """The type of 1 uA, which holds and then is blind, of the model with the same lens that follows its comparator."""
    text = text.replace("EKMC1601111", "EKMB1101111").replace("zones\n", "zones, for batteries (1 uA)\n", 1)
    text = text.replace("\nsources:", "\nreport: {hold_s: 2.6, blind_s: 1.3}\nsources:", 1)
    sources = f'  hold_s: "{EKMB}about 2.6 s"\n  blind_s: "{EKMB}about 1.3 s of mask"\n'
    return text.replace("\nfacets:", "\n" + sources + "facets:", 1)


def main():
    texts = {name: device_yaml(name, device) for name, device in DEVICES.items()}
    texts["EKMC1605111"] = wide_yaml()
    library = json.loads((SENSORS / "lens_library.json").read_text())
    texts |= {name: with_names(name, yaml_of(name, lens)) for name, lens in library.items() if name[0] != "_"}
    texts["EKMB1101111"] = battery_yaml(texts["EKMC1601111"])
    for name, text in texts.items():
        (SENSORS / f"{name}.yaml").write_text(text)


if __name__ == "__main__":
    main()
