"""Starts the program in the package. Not a part of the package, which would import numpy first."""

import os
import sys


def main() -> None:
    program = os.path.join(os.path.dirname(__file__), "pirsim", "pirsim")
    os.execv(program, ["pirsim", *sys.argv[1:]])
