#!/usr/bin/env python3
"""Writes text files into a C++ source, as functions that give them.

Usage: embed_text.py OUTPUT.cpp HEADER NAMESPACE NAME=FILE...
"""
import pathlib
import sys

CHUNK = 16000  # bytes; compilers limit the length of one literal


def literals(text: str) -> str:
    assert ')text"' not in text
    chunks = [text[i:i + CHUNK] for i in range(0, len(text), CHUNK)] or [""]
    return "\n".join(f'R"text({chunk})text"' for chunk in chunks)


def main():
    output, header, namespace, *pairs = sys.argv[1:]
    parts = [f'#include "{header}"\n\nnamespace {namespace} {{\n']
    for pair in pairs:
        name, file = pair.split("=", 1)
        text = pathlib.Path(file).read_text(encoding="utf-8")
        parts.append(f"std::string_view {name}() noexcept {{\n  static constexpr char text[] =\n{literals(text)};\n"
                     f"  return {{text, sizeof text - 1}};\n}}\n")
    parts.append(f"}}  // namespace {namespace}\n")
    pathlib.Path(output).write_text("\n".join(parts), encoding="utf-8")


if __name__ == "__main__":
    main()
