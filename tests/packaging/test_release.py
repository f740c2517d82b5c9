#!/usr/bin/env python3
"""What tools/release relies on: it refuses a version that the files don't agree on, and its bill of materials names what
third_party/licences.toml lists.

Usage: test_release.py SOURCE_DIRECTORY [unittest arguments]; with an interpreter as tools/python_env makes one
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

SOURCE = None
TELLERS = "CMakeLists.txt", "CITATION.cff", "CHANGELOG.md"


class Versions(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        for name in (*TELLERS, "tools/release"):
            (self.folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / name, self.folder / name)
        self.version = re.search(r"project\(pirsim VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text())[1]

    def check(self, version):
        return subprocess.run([self.folder / "tools/release", "--check", version], capture_output=True, text=True)

    def test_the_files_agree(self):
        self.assertEqual(self.check(self.version).returncode, 0, self.check(self.version).stderr)
        self.assertEqual(self.check("99.9.9").stderr.count("tells version"), 3)

    def test_each_file_is_asked(self):
        for name in TELLERS:
            file = self.folder / name
            whole = file.read_text()
            file.write_text(whole.replace(self.version, "77.7.7"))
            told = self.check(self.version)
            self.assertEqual(told.returncode, 1)
            self.assertIn(f"{name} tells version '77.7.7', not {self.version}", told.stderr)
            file.write_text(whole)


class Bill(unittest.TestCase):
    def test_it_names_what_is_listed(self):
        def printed():
            return subprocess.run([sys.executable, SOURCE / "tools/sbom", "1.2.3", "abc", "1790000000"], check=True,
                                  capture_output=True, text=True).stdout
        bill = json.loads(printed())
        listed = tomllib.loads((SOURCE / "third_party/licences.toml").read_text())["library"]
        self.assertEqual(sorted(one["name"] for one in bill["components"]), sorted(one["name"] for one in listed))
        for one in bill["components"]:
            self.assertRegex(one["version"], r"^\d")
            self.assertTrue(one["licenses"][0].get("expression") or one["licenses"][0]["license"].get("id"), one)
        self.assertEqual((bill["specVersion"], bill["metadata"]["component"]["version"]), ("1.6", "1.2.3"))
        self.assertEqual(json.loads(printed()), bill)


if __name__ == "__main__":
    SOURCE = pathlib.Path(sys.argv[1]).resolve()
    unittest.main(argv=["test_release.py", *sys.argv[2:]], verbosity=2)
