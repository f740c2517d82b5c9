#!/usr/bin/env python3
"""Follows every relative link of the pages: the file is there, and so is the heading that an anchor names. A path of the
project that a page names in `code` must exist as well.

Usage: check_links.py SOURCE_DIRECTORY
"""
import pathlib
import re
import sys

from pages import pages

LINK = re.compile(r"\]\(([^()\s]+)\)")
PATH = re.compile(r"`((?:src|include|tests|tools|data|docs|cmake)/[\w./-]*\w)/?`")
HEADING = re.compile(r"^#+ +(.*?) *$", re.MULTILINE)


def without_code(text):
    """The same lines, with code made empty: brackets in it are no links, # no headings."""
    return re.sub(r"^```.*?^```$", lambda block: "\n" * block.group().count("\n"), text, flags=re.DOTALL | re.MULTILINE)


def anchors(page):
    """As GitHub makes them of headings."""
    found, seen = set(), {}
    for heading in HEADING.findall(without_code(page.read_text(encoding="utf-8"))):
        text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        anchor = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
        again = seen.get(anchor, 0)
        seen[anchor] = again + 1
        found.add(f"{anchor}-{again}" if again else anchor)
    return found


def place_of(page, source, text, at):
    line = text.count("\n", 0, at) + 1
    return f"{page.relative_to(source)}:{line}"


def missing_paths(page, source):
    text = without_code(page.read_text(encoding="utf-8"))
    for match in PATH.finditer(text):
        if not (source / match.group(1)).exists():
            yield f"{place_of(page, source, text, match.start())}: no file {match.group(1)}"


def broken_links(page, source):
    text = re.sub(r"`[^`\n]*`", "", without_code(page.read_text(encoding="utf-8")))
    for match in LINK.finditer(text):
        target = match.group(1)
        if re.match(r"[a-z]+:", target):
            continue
        place = place_of(page, source, text, match.start())
        file, _, anchor = target.partition("#")
        path = (page.parent / file).resolve() if file else page
        if not path.exists():
            yield f"{place}: no file {target}"
        elif not path.is_relative_to(source):
            yield f"{place}: {target} leads out of the project"
        elif anchor and (path.suffix != ".md" or anchor not in anchors(path)):
            yield f"{place}: no heading for {target}"


def main():
    source = pathlib.Path(sys.argv[1]).resolve()
    checked = pages(source)
    faults = [fault for page in checked for check in (broken_links, missing_paths)
              for fault in check(page, source)]
    print("\n".join(faults), file=sys.stderr)
    assert len(checked) > 20, checked
    # A page that nobody links to, by itself or with its folder, isn't read.
    linked = {(page.parent / target.partition("#")[0]).resolve() for page in checked
              for target in LINK.findall(page.read_text(encoding="utf-8"))}
    lost = [page for page in checked if page.is_relative_to(source / "docs") and not {page, page.parent} & linked]
    for page in lost:
        print(f"{page.relative_to(source)}: no page links here", file=sys.stderr)
    print(f"{len(checked)} pages, {len(faults) + len(lost)} faults")
    return 1 if faults or lost else 0


if __name__ == "__main__":
    sys.exit(main())
