#!/usr/bin/env python3
"""third_party/licences.toml names everything of others that pirsim carries, and nothing else: the shared libraries of the
programs and modules given (and what those need in turn), the headers that the layers may include, the folders of
third_party, and the packages that tools/install_deps installs for a build. Each licence's text is there.

Usage: check_licences.py SOURCE_DIRECTORY PROGRAM_OR_MODULE...
"""
import importlib.util
import pathlib
import re
import subprocess
import sys
import tomllib

# Of every system that a program for it runs on: pirsim doesn't carry them.
SYSTEM = re.compile(r"(linux-vdso|ld-linux|lib(c|m|dl|rt|pthread|gcc_s|stdc\+\+))[.-]")
TOOLS = {"build-essential", "cmake", "ninja-build", "pkg-config", "catch2", "tzdata", "mosquitto"}  # needed, not carried


def needed_by(file):
    """Names of the shared libraries that it needs, and that those need."""
    listed = subprocess.run(["ldd", file], capture_output=True, text=True, check=True).stdout
    direct = subprocess.run(["readelf", "-d", file], capture_output=True, text=True, check=True).stdout
    indirect = {name.split("/")[-1] for name in re.findall(r"^\s*(\S+\.so\S*)", listed, re.M)}
    return indirect | set(re.findall(r"NEEDED.*\[(.*)\]", direct))


def included(source):
    """Third-party headers, as tools/check_layers.py has them."""
    spec = importlib.util.spec_from_file_location("check_layers", source / "tools/check_layers.py")
    layers = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(layers)
    # These have no layer of their own: all may show GLM, only python/src sees nanobind.
    return {*layers.THIRD_PARTY, "glm", "nanobind"}


def installed(source):
    text = (source / "tools/install_deps").read_text(encoding="utf-8")
    packages = text.split("packages=(", 1)[1].split(")", 1)[0].split()
    return {name for name in packages if not name.startswith("python3")} - TOOLS


def faults(source, files):
    libraries = tomllib.loads((source / "third_party/licences.toml").read_text(encoding="utf-8"))["library"]
    sonames = {start: one["name"] for one in libraries for start in one.get("sonames", [])}
    used = set()
    needed = sorted(set().union(*(needed_by(file) for file in files)))
    for name in needed:
        if SYSTEM.match(name):
            continue
        claims = {owner for start, owner in sonames.items() if name.startswith(start)}
        used |= claims
        if not claims:
            yield f"the shared library {name} isn't listed"
    for key, found in (("headers", included(source)), ("debian", installed(source) | {"libtbb-dev"}),
                       ("folder", {path.name for path in (source / "third_party").iterdir() if path.is_dir()})):
        listed = {}
        for one in libraries:
            values = one.get(key, [])
            listed.update(dict.fromkeys(values if isinstance(values, list) else [values], one["name"]))
        for value in sorted(found - set(listed) - {"licences"}):
            yield f"{key}: {value} isn't listed"
        for value in sorted(set(listed) - found):
            yield f"{key}: {value} of {listed[value]} isn't there any more"
    for one in libraries:
        if one["carried"] == "linked" and one["name"] not in used:
            yield f"{one['name']} isn't linked any more"
        for text in one["texts"]:
            file = source / "third_party" / text
            if not file.is_file() or file.stat().st_size < 500:
                yield f"{one['name']}: third_party/{text} has no licence"
    texts = {text for one in libraries for text in one["texts"]}
    for file in sorted((source / "third_party/licences").iterdir()):
        if f"licences/{file.name}" not in texts:
            yield f"third_party/licences/{file.name} belongs to no library"


def main():
    found = [f"third_party/licences.toml: {fault}"
             for fault in faults(pathlib.Path(sys.argv[1]).resolve(), [pathlib.Path(name) for name in sys.argv[2:]])]
    print("\n".join(found) if found else "licences: every library has one")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
