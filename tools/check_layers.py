#!/usr/bin/env python3
"""Checks the houses of pirsim and their rooms: who may include whom, no cycles, each third-party library in its one place.

Usage: check_layers.py [ROOT]; prints every violation as file:line: message and exits with 1 if there is any.
The tables below are those in docs/architecture.md. Beside these it finds columns of rows that are listed outside
of schema/columns, and modules of the Python package that import each other in a circle.
"""
import ast
import pathlib
import re
import sys

# from below to above: a house may use those before it
HOUSES = ("model", "stats", "engine", "files", "show", "surveys", "rooms", "logs", "reconcile", "app")
BELOW = {house: set(HOUSES[:place]) for place, house in enumerate(HOUSES)}
BELOW["stats"] = {"model"}
# rooms of a house: who may include whom
ROOMS = {
    "model": {"core": set(), "geom": {"core"}, "schema": {"core", "geom"}},
    "engine": {"study": set(), "rt": {"study"}, "body": {"study"}, "pir": {"study"}, "effects": {"study", "pir"},
               "sim": {"study", "rt", "body", "pir", "effects"}},
    "files": {"disk": set(), "read": {"disk"}, "write": {"disk", "read"}},
    "reconcile": {
        "data": set(),
        "ensemble": {"data"},
        "inference": {"data", "ensemble"},
        "selftest": {"data", "ensemble", "inference"},
        "report": {"data", "ensemble", "inference", "selftest"},
    },
}
# public header -> the house, and room, that it belongs to; include/pirsim/pirsim.hpp is the umbrella and belongs to none
PUBLIC = {
    "error": "model/core", "dates": "model/core", "input_file": "model/core", "interval": "model/core", "random": "model/core", "version": "model/core",
    "geometry": "model/geom", "shapes": "model/geom", "rays": "model/geom",
    "sensor": "model/schema", "scene": "model/schema", "script": "model/schema", "schedule": "model/schema", "occupancy": "model/schema",
    "survey": "model/schema", "sample": "model/schema", "columns": "model/schema", "response": "model/schema",
    "effects": "engine/effects",
    "model": "engine/sim", "state": "engine/sim", "study": "engine/sim", "recording": "engine/sim",
    "coverage": "surveys", "look": "surveys",
    "room": "rooms", "flat": "rooms", "dataset": "rooms",
    "csv": "files", "io": "files", "log": "logs",
    "control": "surveys", "counting": "logs", "calibrate": "logs",
    "reconcile": "reconcile", "reconcile_outcome": "reconcile",
}
# header prefix of a third-party library -> the only houses or rooms that may include it
THIRD_PARTY = {
    "embree": {"engine/rt"},
    "tiny_gltf": {"files"},
    "yaml-cpp": {"files"},
    "nlohmann": {"files", "show", "surveys", "rooms", "logs", "reconcile"},
    "stb": {"show"},
    "zlib": {"files", "show"},
    "zstd": {"files"},
    "sqlite3": {"logs"},
    "OpenMesh": {"model/geom"},
    "date": {"logs", "files"},
    "Random123": {"model/core"},
    "nlopt": {"surveys"},
    "Eigen": {"stats"},
    "boost/math": {"stats"},
    "openssl": {"model/core"},
    "CLI": {"app"},
}
# the files that include a library, since its macros must be the same everywhere
GATES = {"Eigen": ("src/stats/linear_algebra.hpp", "src/stats/linear_algebra.cpp")}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


# folders whose files, as any user of the library, may include public headers alone, beside their own and the description
# of the specs
OUTSIDE = ("python/src",)
DESCRIPTION = "src/model/schema/fields.hpp"
# a field: `spec.field`, `&Spec::field`, its name in quotes, or one of a structured binding
NAMED = re.compile(r'(?:\.|::|->)(\w+)\b(?!\()|"(\w+)"|auto&? \[([^\]]*)')
DESCRIPTIONS = ("model/schema/fields.hpp", "model/schema/words.hpp")


def place_of(name: str):
    """House and room (or none) of a file, named as it is included; (None, None) of what is no part of pirsim."""
    parts = name.split("/")
    if parts[0] == "pirsim":
        house, _, room = PUBLIC.get(parts[-1].removesuffix(".hpp"), "").partition("/")
        return house or None, room or None
    if parts[0] not in BELOW or len(parts) < 2:
        return None, None
    return parts[0], parts[1] if parts[0] in ROOMS and len(parts) > 2 else None


def place_fault(own, name: str):
    """Of a file at this place that includes `name`."""
    (house, room), (other, other_room) = own, place_of(name)
    if house is None or other is None:
        return None
    if other != house:
        return None if other in BELOW[house] else f"{house} must not include {other} ({name})"
    if room is None or other_room in (None, room) or other_room in ROOMS[house][room]:
        return None
    return f"{house}/{room} must not include {house}/{other_room} ({name})"


def stray_files(root: pathlib.Path):
    """Every file of a house with rooms is in one of them."""
    for layer, rooms in ROOMS.items():
        for file in sorted((root / "src" / layer).rglob("*.?pp")):
            room = file.relative_to(root / "src" / layer).parts[0]
            if room not in rooms:
                yield f"{file.relative_to(root)}:1: not in a room of {layer}: {', '.join(rooms)}"


def violations(root: pathlib.Path):
    files = sorted([*root.glob("include/**/*.hpp"), *root.glob("src/**/*.hpp"), *root.glob("src/**/*.cpp")])
    graph = {}
    for file in files:
        here = file.relative_to(root)
        key = str(here).removeprefix("include/").removeprefix("src/")
        house, room = place_of(key)
        graph[key] = []
        for number, line in enumerate(file.read_text().splitlines(), 1):
            match = INCLUDE.match(line)
            if not match:
                continue
            name = match.group(2)
            if match.group(1) == '"':
                graph[key].append(name)
            if fault := place_fault((house, room), name):
                yield f"{here}:{number}: {fault}"
            for prefix, gate in GATES.items():
                if match.group(1) == "<" and name.startswith(prefix + "/") and str(here) not in gate:
                    yield f"{here}:{number}: {name} may only be included in {' and '.join(gate)}"
            for prefix, homes in THIRD_PARTY.items():
                if match.group(1) == "<" and (name == prefix or name.startswith((prefix + "/", prefix + "."))
                                              or (prefix == "embree" and name.startswith("embree"))):
                    if not homes & {house, f"{house}/{room}"} or here.parts[0] == "include":
                        yield f"{here}:{number}: {name} may only be included in src/{'/, src/'.join(sorted(homes))}/"
    yield from stray_files(root)
    yield from cycles(graph)
    yield from cycles(binding_includes(root))
    yield from cycles(python_imports(root))
    yield from listed_again(root)
    yield from second_lists(root)
    yield from split_names(root)
    for folder in OUTSIDE:
        yield from private_includes(root, folder)


def split_names(root: pathlib.Path):
    """CMake's lists split a test's name at a ';': two tests that don't exist, and none that runs."""
    for file in sorted(root.glob("tests/**/*_test.cpp")):
        for number, line in enumerate(file.read_text().splitlines(), 1):
            if re.match(r'TEST_CASE\("[^"]*;', line):
                yield f"{file.relative_to(root)}:{number}: a test's name has a ';', at which CTest splits it"


def private_includes(root: pathlib.Path, folder: str):
    for file in sorted((root / folder).glob("*.[ch]pp")):
        for number, line in enumerate(file.read_text().splitlines(), 1):
            match = INCLUDE.match(line)
            if not match or (root / folder / match.group(2)).is_file() or match.group(2) in DESCRIPTIONS:
                continue
            name = match.group(2)
            if (root / "src" / name).is_file() or (match.group(1) == '"' and not name.startswith("pirsim/")):
                yield f"{file.relative_to(root)}:{number}: only public headers may be included here ({name})"


def listed_again(root: pathlib.Path):
    """Every list of all fields of a larger spec, on lines that follow each other, outside of their description."""
    specs = described_specs(root)
    for file in sorted([*root.glob("src/**/*.[ch]pp"), *root.glob("python/src/*.[ch]pp")]):
        here = file.relative_to(root)
        lines = re.sub(r"auto&? \[[^\]]*\]", lambda found: found[0].replace("\n", " ") + "\n" * found[0].count("\n"),
                       file.read_text()).splitlines()  # a structured binding is one line
        for spec, fields in specs.items() if str(here) != DESCRIPTION else ():
            began, last, seen = 0, 0, set()
            for number, line in enumerate(lines, 1):
                named = {name for names in NAMED.findall(line) for name in re.findall(r"\w+", "".join(names))} & fields
                if not named:
                    continue
                if number > last + 1:
                    began, seen = number, set()
                last, seen = number, seen | named
                if seen == fields:
                    yield f"{here}:{began}: lists all fields of {spec} again: go through their description, {DESCRIPTION}"
                    seen = set()


def described_specs(root: pathlib.Path):
    """The fields of each spec that has enough of them for a list to be one of all; labels are often left out."""
    text = (root / DESCRIPTION).read_text()
    found = re.findall(r"struct Fields<([\w:]+)> \{(.*?)\n\};", text, re.DOTALL)
    specs = {spec: set(re.findall(r"FIELD\((\w+)", text)) for spec, text in found}
    return {spec: fields for spec, fields in specs.items() if len(fields) >= 6}


COLUMNS = "columns"  # the files that have the lists of rows
COLUMN_LIST = re.compile(r"(?:Column<\w+>|ColumnInfo) (\w+)\[\]\{(.*?)\n\};", re.DOTALL)
COLUMN = re.compile(r'\{"(\w+)",\s*Holds::')
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
LITERALS = re.compile(LITERAL.pattern + r"(?:\s*,\s*" + LITERAL.pattern + ")+")


def tables_in(text: str):
    """Names of the columns of each list; those of a single ColumnInfo belong to every table."""
    shared = {name for name in COLUMN.findall(COLUMN_LIST.sub("", text))}
    shared |= set(re.findall(r'\w+\{"(\w+)",\s*Holds::', text))
    return {table: set(COLUMN.findall(body)) | shared for table, body in COLUMN_LIST.findall(text)}


def columns_again(text: str, tables, enough=3):
    """Lines on which so many columns of a table stand one after the other, in one text or in neighbouring ones."""
    found = {}
    for match in [*LITERAL.finditer(text), *LITERALS.finditer(text)]:
        words = [word for part in LITERAL.findall(match.group(0)) for word in part.replace("\\n", "").split(",")]
        longest = {table: longest_run(words, names) for table, names in tables.items()}
        table = max(longest, key=longest.get, default=None)
        if table and longest[table] >= enough:
            found[text.count("\n", 0, match.start()) + 1] = table
    return sorted(found.items())


def longest_run(words, names):
    run = longest = 0
    for word in words:
        run = run + 1 if word.strip() in names else 0
        longest = max(longest, run)
    return longest


def second_lists(root: pathlib.Path):
    texts = {file: file.read_text() for folder in ("include", "src", "python/src")
             for file in sorted((root / folder).rglob("*.?pp"))}
    tables = tables_in("\n".join(text for file, text in texts.items() if file.stem == COLUMNS))
    for file, text in texts.items():
        for number, table in columns_again(text, tables) if file.stem != COLUMNS else ():
            yield f"{file.relative_to(root)}:{number}: columns of '{table}' are listed a second time: take them from their list"


def binding_includes(root: pathlib.Path):
    """Which file of python/src includes which other."""
    files = {file.name: file for file in sorted((root / "python/src").glob("*.?pp"))}
    found = {name: [match.group(2) for match in map(INCLUDE.match, file.read_text().splitlines()) if match]
             for name, file in files.items()}
    return {f"python/src/{name}": [f"python/src/{target}" for target in targets if target in files]
            for name, targets in found.items()}


def python_imports(root: pathlib.Path):
    """Which file of the Python package imports which other, but for those that it imports for types alone."""
    graph = {}
    for file in sorted((root / "python/pirsim").rglob("*.py")):
        targets = [target for node in imports_in(ast.parse(file.read_text())) for target in imported_files(file, node)]
        graph[str(file.relative_to(root))] = [str(target.relative_to(root)) for target in targets]
    return graph


def imports_in(node):
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.If) and isinstance(child.test, ast.Name) and child.test.id == "TYPE_CHECKING":
            continue
        if isinstance(child, ast.ImportFrom) and child.level > 0:
            yield child
        yield from imports_in(child)


def imported_files(file: pathlib.Path, node: ast.ImportFrom):
    """Of `from .a import b`: a/b.py if there is one, else a.py, or a/__init__.py. `_core` is the compiled module."""
    base = file.parents[node.level - 1].joinpath(*(node.module or "").split("."))
    for name in (alias.name for alias in node.names if alias.name != "_core"):
        places = (base / f"{name}.py", base / name / "__init__.py", base.with_suffix(".py"), base / "__init__.py")
        yield from [place for place in places if place.is_file()][:1]


def cycles(graph):
    state = {}

    def visit(node, path):
        state[node] = "open"
        for target in graph.get(node, []):
            if state.get(target) == "open":
                yield f"{node}:1: a circle of includes or imports: {' -> '.join([*path, node, target])}"
            elif target in graph and target not in state:
                yield from visit(target, [*path, node])
        state[node] = "done"

    for node in graph:
        if node not in state:
            yield from visit(node, [])


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent.parent)
    found = list(violations(root))
    print("\n".join(found) if found else "layers: no violation")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
