#!/usr/bin/env python3
"""Writes what follows from the description of the specs (src/model/schema/fields.hpp): Python's classes,
python/pirsim/specs.py, and the tables of keys on pages, between `<!-- keys: ... -->` and `<!-- end of keys -->`.

Usage: write.py [--check] [COMPILER]   --check: says which of them isn't as it would be written, and exits with 1

A table's comment names what it has, part by part: `[FIELD... of] SPEC [in MAP] [but FIELD...]; ...`. Without names of
fields that is every field whose form in files is a plain number, word or list of numbers.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[2]
CLASSES = ROOT / "python/pirsim/specs.py"
PAGES = [f"docs/formats/{page}.md" for page in ("control", "coverage", "dataset", "plan", "scene", "script", "sensor")]
WIDTH = 120

HEAD = '''"""Scenes and scripts as plain objects: read from files, changed, or made from nothing.

Each class is one of the library's specs, with the same fields, units and defaults; a field's name ends in its unit.
Points are (x, y, z) in metres in glTF's frame (right-handed, +Y up, floor in XZ), floor points are (x, z). Lists and
dicts are ordinary ones. Nothing is checked before `pirsim.compile()`, which then names what it refuses.

Written by tools/specs/write.py from src/model/schema/fields.hpp; what has a form of its own is in _spec_parts.py.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, Sequence, Union

from . import _spec_parts
from ._spec_parts import Diagnostic, Floor, Frame, Mesh, Point2, Point3

if TYPE_CHECKING:
    from ._core import MeshSolid

__all__ = [
{names}
]


def _where() -> Any:
    return field(default_factory=Where, repr=False, compare=False, kw_only=True)


Activity = {activity}
"""What people of natural style are busy with; each action knows some of them."""
'''
OF_ITS_OWN = ["Diagnostic", "Floor", "Frame", "Mesh", "Point2", "Point3", "Activity", "Action"]
NOT_PRINTED = {("Cluster", "zones"), ("Person", "body_meshes")}
UNITS = {"_m_s": "m/s", "_m": "m", "_s": "s", "_k": "K", "_hz": "Hz", "_v": "V", "_v_pp": "V", "_deg": "deg",
         "_c": "deg C", "_mm": "mm", "_um": "um", "_mm2": "mm²", "deg_per_s": "deg/s", "_min": "min", "volts_per_watt": "V/W"}


def description(compiler):
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "describe"
        subprocess.run([compiler, "-std=c++20", f"-I{ROOT / 'include'}", f"-I{ROOT / 'src'}",
                        str(ROOT / "tools/specs/describe.cpp"), "-o", str(program)], check=True)
        return json.loads(subprocess.run([program], check=True, capture_output=True, text=True).stdout)


def docstring(text, indent="    "):
    sentence = (text[0].upper() + text[1:] if text.split()[0].islower() else text) + "." * (not text.endswith("."))
    return textwrap.fill(f'{indent}"""{sentence}"""', WIDTH, subsequent_indent=indent)


def default(spec, one):
    """The right side of a field: values that could be changed are made anew for each object."""
    value = one["default"]
    if one["name"] == "where":
        return "_where()"
    factory = {"[]": "list", "{}": "dict"}.get(value)
    if value.endswith("()") and value[0].isalpha():
        factory = value[:-2]
    elif value.startswith("[") and value != "[]" or value.endswith(")") and value[0].isalpha():
        factory = f"lambda: {value}"
    if factory is None:
        return value
    return f"field(default_factory={factory}{', repr=False' if (spec, one['name']) in NOT_PRINTED else ''})"


def class_text(name, spec):
    lines = [f"@dataclass(slots=True{', kw_only=True' if name == '_Action' else ''})",
             f"class {name}{'(_Action)' if spec['is_action'] else ''}:",
             docstring(spec["about"])]
    if spec["fields"]:
        lines.append("")
    for one in spec["fields"]:
        if name == "_Action" and one["name"] == "what":
            continue  # the classes that are derived from it
        lines.append(f"    {one['name']}: {one['type']} = {default(name, one)}")
        words = f"one of {', '.join(one['among'])}" if "among" in one else ""
        meaning = [text for text in (words, one["meaning"]) if text]
        if meaning:
            lines.append(docstring("; ".join(meaning)))
    if printing(name):
        lines += ["", "    def __repr__(self) -> str:", f"        return _spec_parts.{printing(name)}(self)"]
    return "\n".join(lines)


def printing(name):
    """The function of _spec_parts.py that says how objects of this class print, if there is one."""
    text = (ROOT / "python/pirsim/_spec_parts.py").read_text(encoding="utf-8")
    found = re.search(rf"^def (\w+)\(\w+: specs\.{name}\)", text, flags=re.MULTILINE)
    return found and found[1]


def classes(specs):
    made = {name: spec for name, spec in specs.items() if name[0].isupper() and "about" in spec}
    actions = [name for name, spec in made.items() if spec["is_action"]]
    names = textwrap.fill(", ".join(f'"{name}"' for name in sorted([*made, *OF_ITS_OWN])) + ",", WIDTH,
                          initial_indent="    ", subsequent_indent="    ")
    blocks = []
    for name, spec in made.items():
        if actions and name == actions[0]:
            blocks.append(class_text("_Action", specs["_Action"]))
        blocks.append(class_text(name, spec))
        if actions and name == actions[-1]:
            blocks.append(f"Action = Union[{', '.join(actions)}]")
    return HEAD.format(names=names, activity=specs["Activity"]) + "\n\n" + "\n\n\n".join(blocks) + "\n"


def shown(value):
    """A default value as a page has it."""
    if value in ("None", "[]", '""'):
        return ""
    text = re.sub(r"(\d)\.0\b", r"\1", value)
    if text.startswith('["'):
        return text.replace('"', "`")
    return f"`{text[1:-1]}`" if text.startswith('"') else text


def unit(name):
    return next((text for ending, text in sorted(UNITS.items(), key=lambda one: -len(one[0])) if name.endswith(ending)),
                "")


def is_plain(one):
    return one.get("plain") or re.fullmatch(r"(float|int|list\[float\]|Literal\[.*\])( \| None)?", one["type"]) is not None


def keys_of(part, specs):
    """(map, field) of each row."""
    wanted = re.fullmatch(r"(?:([\w ]+) of )?(\w+)(?: in ([\w.]+))?(?: but ([\w ]+))?", part.strip())
    only, spec, where, but = wanted.groups()
    fields = {one["name"]: one for one in specs[spec]["fields"]}
    if only:
        return [(where, fields[name]) for name in only.split()]
    return [(where, one) for name, one in fields.items() if is_plain(one) and name not in (but or "").split()]


def meaning_of(one):
    """With the words in front that the field knows, unless the row has them anyway."""
    literal = re.search(r"Literal\[(.*?)\]", one["type"])
    words = one.get("among") or re.findall(r"\w+", literal[1] if literal else "")
    has_all = all(f"`{word}`" in one["meaning"] + shown(one["default"]) for word in words)
    known = "" if has_all else ", ".join(f"`{word}`" for word in words)
    return "; ".join(text for text in (known, one["meaning"]) if text)


def table(parts, specs):
    lines = ["| key | unit | default | meaning |", "|---|---|---|---|"]
    for where, one in [row for part in parts.split(";") for row in keys_of(part, specs)]:
        key = f"{where}.{one['name']}" if where else one["name"]
        says_default = re.search(r"\bdefault \S|^required;", one["meaning"])
        cells = [f"`{key}`", unit(one["name"]), "" if says_default else shown(one["default"]), meaning_of(one)]
        lines.append("|" + "".join(f" {cell} |" if cell else " |" for cell in cells))
    return "\n".join(lines)


def page(text, specs):
    return re.sub(r"(<!-- keys: (.*?) -->\n).*?(<!-- end of keys -->)",
                  lambda found: f"{found[1]}{table(found[2], specs)}\n{found[3]}", text, flags=re.DOTALL)


def main():
    arguments = [one for one in sys.argv[1:] if one != "--check"]
    specs = description(arguments[0] if arguments else "c++")
    written = {CLASSES: classes(specs)}
    written |= {ROOT / name: page((ROOT / name).read_text(encoding="utf-8"), specs) for name in PAGES}
    others = [file for file, text in written.items() if not file.exists() or file.read_text(encoding="utf-8") != text]
    for file in others:
        if "--check" in sys.argv:
            print(f"{file.relative_to(ROOT)}:1: isn't what src/model/schema/fields.hpp describes; tools/specs/write.py writes it")
        else:
            file.write_text(written[file], encoding="utf-8")
    return 1 if others and "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
