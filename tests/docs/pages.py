"""The project's pages, and their code blocks."""
import pathlib
import re
from typing import NamedTuple


class Block(NamedTuple):
    """A fenced block: ```language info ... ```"""
    line: int
    language: str
    info: str
    text: str


def pages(source):
    """Every Markdown page that readers are meant to see."""
    top = sorted(source.glob("*.md"))
    return top + [page for folder in ("docs", "data", "tests") for page in sorted((source / folder).rglob("*.md"))]


def blocks(page):
    found, opened = [], None
    for number, line in enumerate(pathlib.Path(page).read_text(encoding="utf-8").splitlines(), start=1):
        fence = re.fullmatch(r"```(\w*) ?(.*)", line)
        if not fence:
            if opened:
                opened[-1].append(line)
        elif opened:
            found.append(Block(*opened[:-1], "".join(text + "\n" for text in opened[-1])))
            opened = None
        else:
            opened = (number, fence.group(1), fence.group(2), [])
    assert opened is None, f"{page}:{opened[0]}: this block has no end"
    return found



def indented_lines(page):
    """Numbers and texts of lines outside of fenced blocks that Markdown shows as code, or as part of a list."""
    fenced = False
    for number, line in enumerate(pathlib.Path(page).read_text(encoding="utf-8").splitlines(), start=1):
        if line.startswith("```"):
            fenced = not fenced
        elif not fenced and line.startswith("    "):
            yield number, line
