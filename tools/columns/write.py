#!/usr/bin/env python3
"""Writes the tables of columns in docs/formats from schema/columns.

Usage: write.py [--check] [COMPILER]   --check changes nothing, and exits with 1 if a page differs.

A page has a table where it has the marks `<!-- columns: NAME -->` and `<!-- end of columns -->`.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = re.compile(r"<!-- columns: (.+?) -->\n.*?<!-- end of columns -->\n", re.DOTALL)


def tables(compiler):
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "describe"
        subprocess.run([compiler, "-std=c++20", f"-I{ROOT}/include", f"-I{ROOT}/src",
                        ROOT / "tools/columns/describe.cpp", ROOT / "src/model/schema/columns.cpp", "-o", program], check=True)
        text = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    return {match[1]: match[0] for match in TABLE.finditer(text)}


def main():
    arguments = [one for one in sys.argv[1:] if one != "--check"]
    check = "--check" in sys.argv
    made, shown, fault = tables(arguments[0] if arguments else "c++"), set(), 0
    for page in sorted((ROOT / "docs/formats").glob("*.md")):
        text = page.read_text(encoding="utf-8")
        names = {match[1] for match in TABLE.finditer(text)}
        for name in names - set(made):
            sys.exit(f"{page}: no table is called '{name}'; there are {', '.join(made)}")
        shown |= names
        new = TABLE.sub(lambda match: made[match[1]], text)
        if new == text:
            continue
        if check:
            print(f"{page.relative_to(ROOT)}:1: a table isn't what schema/columns says; tools/columns/write.py writes it")
            fault = 1
        else:
            page.write_text(new, encoding="utf-8")
    if shown != set(made):
        sys.exit(f"no page shows the columns of {', '.join(sorted(set(made) - shown))}")
    return fault


if __name__ == "__main__":
    sys.exit(main())
