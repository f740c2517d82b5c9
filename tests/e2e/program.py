"""What the end-to-end tests share: the program, the shipped data, calls that must end as expected, and cases that have
a folder each. Their first two arguments are the program and the folder `data`."""
import csv
import io
import pathlib
import subprocess
import sys
import tempfile
import unittest

PIRSIM, DATA = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])


def pirsim(*args, code=0, **options):
    """Calls it; what it printed is text unless `options`, those of subprocess.run(), say otherwise."""
    result = subprocess.run([PIRSIM, *map(str, args)],
                            **{"capture_output": True, "encoding": "utf-8", "timeout": 600, **options})
    assert result.returncode == code, f"{args}: exit code {result.returncode}, expected {code}\n{result.stderr[:2000]}"
    return result


def run(*args, **options):
    """As pirsim(): standard output and error."""
    result = pirsim(*args, **options)
    return result.stdout, result.stderr


def rows(text):
    """A table of pirsim, a dictionary a line."""
    return list(csv.DictReader(io.StringIO(text)))


def made_folder(add_cleanup):
    """One that is removed when a test, or the tests of a class, have run."""
    holder = tempfile.TemporaryDirectory()
    add_cleanup(holder.cleanup)
    return pathlib.Path(holder.name)


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = made_folder(self.addCleanup)

    def write(self, name, content):
        """A file of the test's folder, made of a text or bytes."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path


def main(first=3):
    """Runs the cases of the script; `first`: place of the first argument that is unittest's."""
    unittest.main(argv=[sys.argv[0], *sys.argv[first:]], verbosity=2)
