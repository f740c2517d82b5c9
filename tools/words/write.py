#!/usr/bin/env python3
"""Writes the words that pirsim-live knows for states, python/live/custom_components/pirsim/live/words.py, from the table
that logs are read by, src/files/read/state_words.hpp.

Usage: write.py [--check]   --check changes nothing, and exits with 1 if the module differs.
"""
import pathlib
import re
import sys
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[2]
TABLE = ROOT / "src/files/read/state_words.hpp"
MODULE = ROOT / "python/live/custom_components/pirsim/live/words.py"
HEAD = '"""Words for states of motion sensors. Written by tools/words/write.py from src/files/read/state_words.hpp."""\n'


def module():
    text = re.sub(r"//.*", "", TABLE.read_text(encoding="utf-8"))
    lines = [HEAD]
    for name in ("on", "off", "unknown"):
        words = re.findall(r'"((?:[^"\\]|\\.)*)"', re.search(rf"\b{name}_words{{(.*?)}};", text, re.DOTALL)[1])
        if odd := [word for word in words if "\\" in word or word != word.lower()]:
            sys.exit(f"{TABLE.relative_to(ROOT)}:1: a word isn't plain small text: {odd}")
        quoted = ", ".join(f'"{word}"'.replace(" ", "\0") for word in words)  # no line breaks within a word
        lines.append(textwrap.fill(f"{name.upper()} = frozenset({{{quoted}}})", 120, subsequent_indent="    ",
                                   break_on_hyphens=False, break_long_words=False).replace("\0", " "))
    lines.append(f"LONGEST = {re.search(r'longest_state = ([0-9]+);', text)[1]}")
    return "\n".join(lines) + "\n"


def main():
    text = module()
    if MODULE.exists() and MODULE.read_text(encoding="utf-8") == text:
        return 0
    if "--check" in sys.argv:
        print(f"{MODULE.relative_to(ROOT)}:1: isn't what {TABLE.relative_to(ROOT)} says; tools/words/write.py writes it")
        return 1
    MODULE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
