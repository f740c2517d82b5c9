#!/usr/bin/env python3
"""Checks the Spack recipes beside this file without Spack: each is run with directives that note what they are given. A
recipe's class has its folder's name, checksums are SHA-256, the version is the project's, and each library that
cmake/PirsimDeps.cmake looks for is a dependency or a resource. With a clone of spack-packages, every other dependency
exists there, with the variants that are asked for.

Usage: lint_spack.py SOURCE_DIRECTORY [CLONE_OF_SPACK_PACKAGES]
"""
import pathlib
import re
import sys
import types

# What PirsimDeps.cmake calls them, where Spack's name is another.
CALLED = {"Eigen3": "eigen", "VEGA": "vega", "STB": "stb", "ZLIB": "zlib-api", "Python3": "python",
          "Python": "python", "PkgConfig": "pkgconfig", "SQLite3": "sqlite"}
NOT_A_PACKAGE = {"Threads"}  # a compiler brings it along
VIRTUAL = {"c", "cxx", "pkgconfig", "zlib-api"}


class Recipe:
    def __init__(self, file):
        self.file, self.calls = file, []

        def note(directive):
            return lambda *args, **kwargs: self.calls.append((directive, args, kwargs))

        api = types.ModuleType("spack.package")
        for directive in ("depends_on", "version", "license", "resource", "generator", "variant", "conflicts"):
            setattr(api, directive, note(directive))
        build = types.ModuleType("build systems")
        build.CMakePackage = build.Package = type("Package", (), {})
        sys.modules.update({"spack": types.ModuleType("spack"), "spack.package": api})
        for name in ("spack_repo", "spack_repo.builtin", "spack_repo.builtin.build_systems"):
            sys.modules[name] = types.ModuleType(name)
        for name in ("cmake", "generic"):
            sys.modules[f"spack_repo.builtin.build_systems.{name}"] = build
        self.scope = {}
        exec(compile(file.read_text(encoding="utf-8"), file, "exec"), self.scope)  # pylint: disable=exec-used

    def noted(self, directive):
        return [(args, kwargs) for name, args, kwargs in self.calls if name == directive]

    def dependencies(self):
        """name -> the spec that is asked for"""
        return {re.match(r"[\w-]+", args[0]).group(): args[0] for args, _ in self.noted("depends_on")}


def faults(source, clone):
    folder = source / "tools/packaging/spack_repo/pirsim"
    recipes = {file.parent.name: Recipe(file) for file in sorted(folder.glob("packages/*/package.py"))}
    for name, recipe in recipes.items():
        if not isinstance(recipe.scope.get(name.capitalize()), type):
            yield f"{recipe.file}: no class {name.capitalize()}"
        for directive in ("version", "resource"):
            for args, kwargs in recipe.noted(directive):
                manual = getattr(recipe.scope.get(name.capitalize()), "manual_download", False)
                if not (manual and directive == "version") and not re.fullmatch(r"[0-9a-f]{64}", kwargs.get("sha256", "")):
                    yield f"{recipe.file}: {directive} {args or kwargs['name']} has no SHA-256"
        if not recipe.noted("license"):
            yield f"{recipe.file}: no license"
        for needed, spec in recipe.dependencies().items():
            if clone and needed not in recipes and needed not in VIRTUAL:
                known = clone / "repos/spack_repo/builtin/packages" / needed.replace("-", "_") / "package.py"
                if not known.exists():
                    yield f"{recipe.file}: Spack has no package {needed}"
                    continue
                text = known.read_text(encoding="utf-8")
                for variant in re.findall(r"[+~](\w+)", spec):
                    if not re.search(rf'variant\(\s*"{variant}"', text):
                        yield f"{recipe.file}: {needed} has no variant {variant}"

    pirsim = recipes["pirsim"]
    project = re.search(r"project\(pirsim VERSION (\S+)", (source / "CMakeLists.txt").read_text(encoding="utf-8"))
    if [args[0] for args, _ in pirsim.noted("version")] != [project.group(1)]:
        yield f"{pirsim.file}: the project's version is {project.group(1)}"
    listed = (source / "cmake/PirsimDeps.cmake").read_text(encoding="utf-8")
    looks_for = r"find_package\(([\w-]+)", r"find_path\((\w+?)_(?:INCLUDE_)?DIR", r"pkg_check_modules\((\w+)"
    wanted = {library for pattern in looks_for for library in re.findall(pattern, listed)} - NOT_A_PACKAGE
    there = set(pirsim.dependencies()) | {kwargs["name"] for _, kwargs in pirsim.noted("resource")}
    for library in sorted(wanted):
        if CALLED.get(library, library.lower().replace("_", "-")) not in there:
            yield f"{pirsim.file}: cmake/PirsimDeps.cmake looks for {library}"


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    clone = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
    found = list(faults(source, clone))
    print("\n".join(found), file=sys.stderr)
    print(f"{len(found)} faults in the Spack recipes")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
