#!/usr/bin/env python3
"""Writes the tables of columns in docs/formats from schema/columns.

Usage: write.py [--check]. --check changes nothing, and exits with 1 if a page differs. Needs a C++ compiler (CXX).
A page has a table where it has the marks `<!-- columns: NAME -->` and `<!-- end of columns -->`.
"""
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = re.compile(r"<!-- columns: (.+?) -->\n.*?<!-- end of columns -->\n", re.DOTALL)


def tables():
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "describe"
        subprocess.run([*shlex.split(os.environ.get("CXX", "c++")), "-std=c++20", f"-I{ROOT}/include", f"-I{ROOT}/src",
                        ROOT / "tools/columns/describe.cpp", ROOT / "src/schema/columns.cpp", "-o", program], check=True)
        text = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    return {match[1]: match[0] for match in TABLE.finditer(text)}


def main():
    made, shown, stale = tables(), set(), []
    for page in sorted((ROOT / "docs/formats").glob("*.md")):
        text = page.read_text()
        names = [match[1] for match in TABLE.finditer(text)]
        for name in names:
            if name not in made:
                sys.exit(f"{page}: no table is called '{name}'; there are {', '.join(made)}")
        shown.update(names)
        new = TABLE.sub(lambda match: made[match[1]], text)
        if new != text:
            stale.append(page.relative_to(ROOT))
            if "--check" not in sys.argv:
                page.write_text(new)
    if shown != set(made):
        sys.exit(f"no page shows the columns of {', '.join(sorted(set(made) - shown))}")
    for page in stale:
        print(f"{page}: its table of columns {'differs from schema/columns: run tools/columns/write.py' if '--check' in sys.argv else 'was written'}")
    return 1 if stale and "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
