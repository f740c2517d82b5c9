#!/usr/bin/env python3
"""tools/check_layers.py finds a list of all fields of a spec, one of a table's columns, circles of the Python package,
and nothing else.

Usage: test_check_layers.py SOURCE_DIRECTORY
"""
import importlib.util
import pathlib
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv.pop() if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parents[2])
module = importlib.util.spec_from_file_location("check_layers", SOURCE / "tools/check_layers.py")
check_layers = importlib.util.module_from_spec(module)
module.loader.exec_module(check_layers)

NAMES = ["seat", "wait_s", "width_m", "order", "low_hz", "high_hz"]
DESCRIPTION = ("struct Fields<DoorSpec> {\n  static constexpr std::tuple all{\n"
               + ",\n".join(f"      FIELD({name})" for name in NAMES) + ",\n      LABEL(where)};\n};\n")


class SplitNames(unittest.TestCase):
    def test_a_semicolon_in_a_name_and_none_elsewhere(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "tests/unit/door_test.cpp"
            file.parent.mkdir(parents=True)
            file.write_text('TEST_CASE("opens, shuts") { run("a;b"); }\nTEST_CASE("opens; shuts") {}\n')
            self.assertEqual([text.split(" ")[0] for text in check_layers.split_names(pathlib.Path(folder))],
                             ["tests/unit/door_test.cpp:2:"])


class Circles(unittest.TestCase):
    def circles_of(self, graph_of, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, content in files.items():
                (pathlib.Path(folder) / name).parent.mkdir(parents=True, exist_ok=True)
                (pathlib.Path(folder) / name).write_text(content)
            return list(check_layers.cycles(graph_of(pathlib.Path(folder))))

    def of_modules(self, modules):
        return self.circles_of(check_layers.python_imports,
                               {f"python/pirsim/{name}.py": text for name, text in modules.items()})

    def test_modules_that_import_each_other(self):
        for one, other in (("from ._b import x", "from ._a import y"), ("from . import _b", "from . import _a"),
                           ("def late():\n    from ._b import x", "from . import _core, _a")):
            with self.subTest(one):
                found = self.of_modules({"_a": one, "_b": other})
                self.assertEqual(found, ["python/pirsim/_b.py:1: a circle of includes or imports: "
                                         "python/pirsim/_a.py -> python/pirsim/_b.py -> python/pirsim/_a.py"])

    def test_a_module_that_imports_what_its_package_offers(self):
        self.assertEqual(len(self.of_modules({"__init__": "from ._a import x", "_a": "from . import y"})), 1)
        self.assertEqual(len(self.of_modules({"_a": "from .part import x", "part/__init__": "from ._b import x",
                                              "part/_b": "from .. import _a"})), 1)

    def test_none_without_a_circle_or_for_types_alone(self):
        self.assertEqual(self.of_modules({
            "__init__": "from ._a import x\nfrom . import part", "_a": "from . import _core, _b",
            "_b": "import os\nif TYPE_CHECKING:\n    from ._a import x",
            "part/__init__": "from .. import _core\nfrom .._a import x"}), [])

    def test_headers_of_the_bindings(self):
        files = {"python/src/a.hpp": '#include "b.hpp"\n', "python/src/b.hpp": "#include <map>\n",
                 "python/src/c.cpp": '#include "a.hpp"\n'}
        self.assertEqual(self.circles_of(check_layers.binding_includes, files), [])
        files["python/src/b.hpp"] = '#include "a.hpp"\n'
        self.assertEqual(len(self.circles_of(check_layers.binding_includes, files)), 1)


class Houses(unittest.TestCase):
    def found_in(self, name, *includes):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for file, content in (("src/model/schema/fields.hpp", ""),
                                  (name, "".join(f"#include {include}\n" for include in includes))):
                (root / file).parent.mkdir(parents=True, exist_ok=True)
                (root / file).write_text(content)
            return [text.split(": ", 1)[1] for text in check_layers.violations(root)]

    def test_a_house_uses_those_below(self):
        self.assertEqual(self.found_in("src/surveys/sight.cpp", '"engine/sim/study.hpp"', '"pirsim/random.hpp"'), [])
        for name, include, told in (
                ("src/engine/rt/room.cpp", '"app/session.hpp"', "engine must not include app (app/session.hpp)"),
                ("src/surveys/sight.cpp", '"pirsim/calibrate.hpp"',
                 "surveys must not include logs (pirsim/calibrate.hpp)"),
                ("src/stats/trees.cpp", '"engine/sim/study.hpp"',
                 "stats must not include engine (engine/sim/study.hpp)"),
                ("include/pirsim/scene.hpp", '"pirsim/dataset.hpp"',
                 "model must not include rooms (pirsim/dataset.hpp)")):
            with self.subTest(name):
                self.assertEqual(self.found_in(name, include), [told])

    def test_rooms_of_a_house_know_those_below(self):
        self.assertEqual(self.found_in("src/engine/sim/a.cpp", '"engine/body/arms.hpp"', '"pirsim/effects.hpp"'), [])
        for include in ('"engine/sim/actor.hpp"', '"pirsim/study.hpp"'):
            with self.subTest(include):
                self.assertEqual(self.found_in("src/engine/body/arms.cpp", include),
                                 [f"engine/body must not include engine/sim ({include[1:-1]})"])
        self.assertIn("not in a room of engine", self.found_in("src/engine/loose.cpp")[0])

    def test_a_library_has_its_place(self):
        self.assertEqual(self.found_in("src/engine/rt/room.cpp", "<embree3/rtcore.h>"), [])
        for name in ("src/engine/sim/actor.cpp", "include/pirsim/rays.hpp"):
            with self.subTest(name):
                self.assertEqual(self.found_in(name, "<embree3/rtcore.h>"),
                                 ["embree3/rtcore.h may only be included in src/engine/rt/"])


class ListedAgain(unittest.TestCase):
    def found_in(self, text):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, content in (("src/model/schema/fields.hpp", DESCRIPTION), ("src/files/door.cpp", text)):
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(content)
            return list(check_layers.listed_again(root))

    def test_all_members_line_by_line(self):
        found = self.found_in("\n" + "".join(f"  print(door.{name});\n" for name in NAMES))
        self.assertEqual(len(found), 1)
        self.assertTrue(found[0].startswith("src/files/door.cpp:2: lists all fields of DoorSpec again"), found)

    def test_all_keys_or_pointers(self):
        self.assertEqual(len(self.found_in("".join(f'add("{name}", &DoorSpec::{name});\n' for name in NAMES))), 1)

    def test_a_structured_binding(self):
        self.assertEqual(len(self.found_in(f"const auto& [{', '.join(NAMES)}, where] = door;\n")), 1)
        self.assertEqual(len(self.found_in("const auto& [%s] = door;\n" % ",\n            ".join(NAMES))), 1)

    def test_each_list_is_found(self):
        one = "".join(f"  print(door.{name});\n" for name in NAMES)
        self.assertEqual(len(self.found_in(one + "\n\n" + one)), 2)

    def test_some_fields_or_all_of_them_far_apart_are_no_list(self):
        self.assertEqual(self.found_in("".join(f"  print(door.{name});\n" for name in NAMES[1:])), [])
        self.assertEqual(self.found_in("".join(f"  print(door.{name});\n\n" for name in NAMES)), [])
        self.assertEqual(self.found_in(" ".join(NAMES) + "\n"), [])

    def test_the_description_itself_is_none(self):
        self.assertEqual(self.found_in(""), [])


class Columns(unittest.TestCase):
    LISTS = ('constexpr ColumnInfo day{"day", Holds::whole, "x"};\n'
             'constexpr Column<Sample> rows[]{\n    {{"trial", Holds::text, "x"}, trial},\n'
             '    {{"time_s",\n Holds::number}, time_s},\n    {{"people", Holds::count}, people},\n};\n')

    def test_a_list_gives_its_names_and_what_tables_share(self):
        self.assertEqual(check_layers.tables_in(self.LISTS), {"rows": {"trial", "time_s", "people", "day"}})

    def test_three_columns_in_a_row_are_a_list(self):
        tables = check_layers.tables_in(self.LISTS)
        for text, lines in ((r'a;\nout << "trial,time_s,people\n";', [1]),
                            ('\n\nnames{"trial", "time_s",\n "people"}', [3]), ('"x,day,trial,people,y"', [1]),
                            ('{"trial", "x", "people", "day"}', []), ('"trial,people"', []),
                            ('{{"trial", trial}, {"time_s", time}, {"people", people}}', [])):
            with self.subTest(text):
                self.assertEqual([line for line, _ in check_layers.columns_again(text, tables)], lines)

    def test_they_are_told_with_their_place(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, content in (("src/model/schema/columns.cpp", self.LISTS), ("src/files/a.cpp", '\nf("time_s,people,day");\n')):
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(content)
            self.assertEqual(list(check_layers.second_lists(root)),
                             ["src/files/a.cpp:2: columns of 'rows' are listed a second time: take them from their list"])


if __name__ == "__main__":
    unittest.main()
