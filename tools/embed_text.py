#!/usr/bin/env python3
"""Writes files into a C++ source: functions that give them, or one that gives a table of all by name.

Usage: embed_text.py OUTPUT.cpp HEADER NAMESPACE NAME=FILE[+FILE...]...   several files are one text; a font is bytes
       embed_text.py OUTPUT.cpp HEADER NAMESPACE --table NAME FILE...   a span of {stem of FILE, text}
"""
import pathlib
import sys

CHUNK = 16000  # bytes; compilers limit the length of one literal


def literals(text: str) -> str:
    assert ')text"' not in text
    chunks = [text[i:i + CHUNK] for i in range(0, len(text), CHUNK)] or [""]
    return "\n".join(f'R"text({chunk})text"' for chunk in chunks)


def bytes_as_literals(data: bytes) -> str:
    chunks = [data[i:i + 32] for i in range(0, len(data), 32)]
    return "\n".join('"' + "".join(f"\\{byte:03o}" for byte in chunk) + '"' for chunk in chunks)


def function(name: str, *files: str) -> str:
    if files[0].endswith(".ttf"):
        text = bytes_as_literals(pathlib.Path(files[0]).read_bytes())
    else:
        text = literals("".join(pathlib.Path(file).read_text(encoding="utf-8") for file in files))
    return (f"std::string_view {name}() noexcept {{\n  static constexpr char text[] =\n{text};\n"
            f"  return {{text, sizeof text - 1}};\n}}\n")


def table(name: str, files: list[str]) -> str:
    texts = "".join(f"static {function(f'text_{i}', file)}" for i, file in enumerate(files))
    rows = "".join(f'{{"{pathlib.Path(file).stem}", text_{i}()}}, ' for i, file in enumerate(files))
    return (f"{texts}std::span<const NamedText> {name}() {{\n"
            f"  static const NamedText texts[] = {{{rows}}};\n  return texts;\n}}\n")


def main():
    output, header, namespace, *rest = sys.argv[1:]
    parts = [f'#include "{header}"\n\nnamespace {namespace} {{\n']
    if rest[0] == "--table":
        parts.append(table(rest[1], rest[2:]))
    else:
        for name, files in (pair.split("=", 1) for pair in rest):
            parts.append(function(name, *files.split("+")))
    parts.append(f"}}  // namespace {namespace}\n")
    pathlib.Path(output).write_text("\n".join(parts), encoding="utf-8")


if __name__ == "__main__":
    main()
