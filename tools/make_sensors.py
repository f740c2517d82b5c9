#!/usr/bin/env python3
"""Writes data/sensors/<lens>.yaml: Panasonic's lenses from data/sensors/lens_library.json, and a dual element behind a
dome lens from the numbers below. Run it after the library or these numbers change."""
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
    sources["mean"] = ("inferred: " + CATALOGUE + ", p. 14: detection sensitivity 5.6 uW/cm2 on average, 7.6 at most, "
                       "which is the guaranteed least: 7.6 / 5.6")
    sources["sd"] = ("assumed: 7.6 uW/cm2 lies three standard deviations off the average, ln(7.6 / 5.6) / 3, so that "
                     "nearly all units are 1 to 1.85 times as sensitive; range considered 0.07 to 0.15")
    sources["polarity"] = "assumed: neighbours on the quad differ; considered: checkerboard, all the same"
    return sources | detector_sources(PAPIRS_DETECTOR)


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
    lines += ["sensitivity: {mean: 1.36, sd: 0.1}"]
    lines += ["polarity: checkerboard", *detector_lines(PAPIRS_DETECTOR), "sources:"]
    lines += [f'  {key}: "{text}"' for key, text in sources_of(name, lens).items()]
    lines += ["facets:"] + [facet_line(name, facet, lens) for facet in lens["facets"]]
    return "\n".join(lines) + "\n"


# A dual element (two strips side by side, of opposite sign) behind a dome of small lenses, as in cheap modules.
DOME_FOCAL_MM = 12.0
DOME_ELEMENTS_MM = [((0.5, 1.5), 1), ((-1.5, -0.5), -1)]  # from, to along x, and the sign
DOME_ELEMENT_HALF_HEIGHT_MM = 1.0
DOME_RINGS = [(0.0, 1), (17.0, 6), (34.0, 10), (51.0, 12)]  # degrees off the axis, facets
DUAL = "assumed: a generic dual element, two strips of 2 x 1 mm with a gap of 1 mm; "
DOME = "assumed: a generic dome lens, focal length 12 mm (8 to 25), 29 facets in rings at 0, 17, 34 and 51 degrees; "
MODULE = "assumed: as in cheap modules with a BISS0001 or a like circuit, 3.3 V; "
DUAL_DETECTOR = {
    "element": {
        "thermal_s": (0.2, "assumed: nobody says; range considered 0.05 to 1"),
        "electrical_s": (2.0, "assumed: nobody says; range considered 0.3 to 3"),
    },
    "amplifier": {
        "low_hz": (0.7, "assumed: as in " + REFERENCE_DESIGNS + "; range considered 0.3 to 0.7"),
        "high_hz": (10.6, "assumed: as in " + REFERENCE_DESIGNS + "; range considered 6.5 to 10.6"),
        "order": (2, "assumed: two equal amplifier stages, as in TIDA-00489; considered: 1 to 3"),
        "noise_v_pp": (0.2, MODULE + "range considered 0.1 to 0.4"),
        "offset_v": (1.65, MODULE + "half of the supply"),
        "lowest_v": (0.1, MODULE + "the supply's rail"),
        "highest_v": (3.2, MODULE + "the supply's rail"),
    },
    "comparator": {
        "positive_v": (0.66, "inferred: 0.7 of the supply (BISS0001 data sheet), assumed to be 3.3 V, less the offset"),
        "negative_v": (0.66, "inferred: the offset less 0.3 of the supply (BISS0001 data sheet), assumed to be 3.3 V"),
        "pulse_count": (2, "assumed: to suppress lone disturbances; considered: 1 to 4"),
        "pulse_window_s": (4.0, "assumed: range considered 2 to 8"),
        "pulse_signs": ("alternating", "assumed: as digital detectors offer; considered: any, alternating"),
    },
    "report": {
        "hold_s": (5.0, "assumed: adjustable on such modules, range considered 0.5 to 300"),
        "blind_s": (2.5, "assumed: the BISS0001's inhibit time, set by two parts; range considered 0.5 to 5"),
    },
}


def dome_zone(facet, left, right):
    """Corners, on the plane 1 m ahead, of what a strip of the element sees through the middle of a facet."""
    corners = []
    for x, y in ((left, -1), (right, -1), (right, 1), (left, 1)):
        # A point of the element looks through the facet's middle: x to the right, y up, forward.
        ray = (facet[0] - x, facet[1] - y * DOME_ELEMENT_HALF_HEIGHT_MM, facet[2])
        corners.append(f"[{ray[0] / ray[2] + 0.0:.4f}, {ray[1] / ray[2] + 0.0:.4f}]")
    return "[" + ", ".join(corners) + "]"


def dome_cluster(off_axis_deg, turn_deg):
    off_axis, turn = math.radians(off_axis_deg), math.radians(turn_deg)
    sideways = DOME_FOCAL_MM * math.sin(off_axis)
    facet = (sideways * math.cos(turn), sideways * math.sin(turn), DOME_FOCAL_MM * math.cos(off_axis))
    return ["  - zones:"] + [f"      - {{corners_m: {dome_zone(facet, *strip)}, polarity: {sign}}}"
                             for strip, sign in DOME_ELEMENTS_MM]


def dome_yaml():
    sources = {"plane_m": "assumed: any plane will do", "range_m": "assumed: range considered 3 to 7 m",
               "corners_m": DOME + "each strip seen from the middle of the facet",
               "polarity": DUAL + "wired in opposition"}
    sources |= detector_sources(DUAL_DETECTOR)
    lines = ["# Written by tools/make_sensors.py; the format is docs/formats/sensor.md.", "id: DUAL_DOME",
             "description: a generic dual element behind a dome lens, 58 zones; all assumed", "plane_m: 1.0",
             "range_m: 5.0", *detector_lines(DUAL_DETECTOR), "sources:"]
    lines += [f'  {key}: "{text}"' for key, text in sources.items()] + ["clusters:"]
    for off_axis_deg, facets in DOME_RINGS:
        for i in range(facets):
            lines += dome_cluster(off_axis_deg, (i + 0.5) * 360.0 / facets)
    return "\n".join(lines) + "\n"


def main():
    (SENSORS / "DUAL_DOME.yaml").write_text(dome_yaml())
    library = json.loads((SENSORS / "lens_library.json").read_text())
    for name, lens in library.items():
        if name.startswith("_"):
            continue
        (SENSORS / f"{name}.yaml").write_text(yaml_of(name, lens))


if __name__ == "__main__":
    main()
