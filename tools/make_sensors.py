#!/usr/bin/env python3
"""Writes data/sensors/<lens>.yaml from data/sensors/lens_library.json. Run it after the library changes."""
import json
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
    if name == "EKMC1604111":
        law = "inferred: from the quad (" + QUAD + ") and the drawing, "
        sources["half_spacing_ratio"] = law + "0.5 * sqrt(2) * 1.0 mm / 10.0 mm"
        sources["half_diagonal_ratio"] = law + "0.5 * sqrt(2) * 0.6 mm / 10.0 mm"
        sources["range_m"] = sources["lens_step"] = "quoted: 12, 6 and 3 m for the first, second and third lens step"
    else:
        sources["zone_side_m"] = DRAWING + "side of a single zone"
        sources["range_m"] = RANGES_M[name][1]
        sources["pitch_m"] = pitch_source(lens)
        if any("missing_element" in facet for facet in lens["facets"]):
            sources["missing"] = DRAWING + "three of the four zones are drawn"
    sources["polarity"] = "assumed: neighbours on the quad differ; considered: checkerboard, all the same"
    return sources


RANGES_M = {
    "EKMC1601111": (5, "quoted: 'lens 01: 5 m distance standard', ordering information of the EKMB series"),
    "EKMC1603111": (12, "quoted: 'lens 03: 12 m long distance', ordering information of the EKMB series"),
    "AMN32111": (2, "quoted: 2 m, distributor's data of the AMN32112J (same lens in white)"),
    "AMN34111": (10, "quoted: 10 m, distributor's data of the AMN34112J (same lens in white)"),
    "EKMC1606111": (12, "assumed: as the other long-distance lens (03), range considered 5 to 12 m"),
    "EKMC1607111": (5, "assumed: as lens 01, which is drawn on the same plane, range considered 3 to 8 m"),
    "EKMC1691111": (5, "assumed: as lens 01, which is drawn on the same plane, range considered 2 to 8 m"),
    "EKMC1693111": (5, "assumed: as lens 01, which is drawn on the same plane, range considered 2 to 8 m"),
    "AMN31111": (5, "assumed: as lens 01, which is drawn on the same plane, range considered 3 to 8 m"),
    "AMN33111": (5, "assumed: the plane on which the zones are drawn, range considered 5 to 10 m"),
}


def pitch_source(lens):
    if any("pitch_m" in facet for facet in lens["facets"]):
        return DRAWING + "where it shows; inferred for the others by the same ratio to zone_side_m"
    return "inferred: zone_side_m * 1.0 / 0.6, from the quad (" + QUAD + ")"


def pitch_ratio(lens):
    drawn = [facet["pitch_m"] / facet["zone_side_m"] for facet in lens["facets"] if "pitch_m" in facet]
    return sum(drawn) / len(drawn) if drawn else 1.0 / 0.6


def facet_line(facet, lens):
    fields = {"x_m": facet["x"] + 0.0, "y_m": facet["y"] + 0.0}
    if "step" in facet:
        fields |= {"lens_step": facet["step"], "range_m": facet["range_m"]}
    else:
        pitch = facet.get("pitch_m", round(facet["zone_side_m"] * pitch_ratio(lens), 4))
        fields |= {"zone_side_m": facet["zone_side_m"], "pitch_m": pitch}
        if "missing_element" in facet:
            fields["missing"] = "outer"
    return "  - {" + ", ".join(f"{key}: {value}" for key, value in fields.items()) + "}"


def yaml_of(name, lens):
    lines = ["# Written by tools/make_sensors.py from lens_library.json; the format is docs/formats/sensor.md.",
             f"id: {name}", f"description: Panasonic PaPIRs {lens['family'].split(' (')[0]}, {lens['zones']} zones",
             f"plane_m: {float(lens['plane_m'])}"]
    if name == "EKMC1604111":
        lines += ["layout: diamond", "half_spacing_ratio: 0.0707", "half_diagonal_ratio: 0.0424"]
    else:
        lines += ["layout: square", f"range_m: {float(RANGES_M[name][0])}"]
    lines += ["polarity: checkerboard", "sources:"]
    lines += [f'  {key}: "{text}"' for key, text in sources_of(name, lens).items()]
    lines += ["facets:"] + [facet_line(facet, lens) for facet in lens["facets"]]
    return "\n".join(lines) + "\n"


def main():
    library = json.loads((SENSORS / "lens_library.json").read_text())
    for name, lens in library.items():
        if name.startswith("_"):
            continue
        (SENSORS / f"{name}.yaml").write_text(yaml_of(name, lens))


if __name__ == "__main__":
    main()
