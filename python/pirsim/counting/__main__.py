"""Counting from the shell: python -m pirsim.counting --help."""

from __future__ import annotations

import argparse
import pathlib
import sys
import warnings

from .. import errors
from .._inputs import keep_inputs, require_place
from . import load, train


def _options() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m pirsim.counting", description="count people from motion")
    commands = parser.add_subparsers(dest="command", required=True)
    training = commands.add_parser("train", help="a counter from a dataset of pirsim dataset")
    training.add_argument("dataset", metavar="DATASET", help="the dataset's folder")
    training.add_argument("-o", "--output", metavar="FILE", required=True, help="gets the counter, as JSON")
    training.add_argument("--model", choices=("hidden_markov", "logistic"), default="hidden_markov",
                          help="default: %(default)s; logistic needs scikit-learn")
    training.add_argument("--step", metavar="SECONDS", type=float, default=30.0,
                          help="between readings; default: %(default)g")
    training.add_argument("--sensors", metavar="N", type=int, help="learn from rooms with so many sensors only")
    training.add_argument("--threads", metavar="N", type=int, default=0, help="default: all cores")
    counting = commands.add_parser("estimate", help="the people of a log")
    counting.add_argument("counter", metavar="COUNTER", help="the counter's file")
    counting.add_argument("--log", metavar="FILE", required=True, nargs="+", help="the log; several are parts of one")
    counting.add_argument("--map", metavar="FILE", help="what the log's columns mean (pirsim log --print-map)")
    counting.add_argument("--forward", action="store_true",
                          help="each reading by those before it alone (default: by those after it as well)")
    counting.add_argument("-o", "--output", metavar="FILE", required=True, help="gets the counts, as CSV")
    return parser


def _inputs(options: argparse.Namespace) -> list[tuple[str, str | pathlib.Path]]:
    if options.command == "train":  # all of the dataset; a counter that somebody keeps there isn't of it
        return [("DATASET", file) for file in pathlib.Path(options.dataset).rglob("*")
                if file.suffix != ".json" or file.name == "datapackage.json"]
    return [("COUNTER", options.counter), *(("--log", file) for file in options.log), ("--map", options.map or "")]


def _work(options: argparse.Namespace) -> None:
    keep_inputs([("-o", options.output)], _inputs(options))
    require_place(options.output)
    if options.command == "train":
        train(options.dataset, options.step, options.model, sensors=options.sensors,
              threads=options.threads).save(options.output)
    else:
        estimates = load(options.counter).estimate(options.log, not options.forward, map=options.map)
        estimates.write_csv(options.output)


def main(arguments: list[str] | None = None) -> int:
    options = _options().parse_args(arguments)
    warnings.showwarning = lambda message, *_, **__: print(message, file=sys.stderr)
    try:
        _work(options)
    except errors.Error as error:
        print(error, file=sys.stderr)
        return int(error.code)
    except (ImportError, TypeError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return int(errors.ErrorCode.USAGE)
    except OSError as error:
        print(f"error: {error}", file=sys.stderr)
        return int(errors.ErrorCode.IO)
    return 0


if __name__ == "__main__":
    sys.exit(main())
