"""pirsim-live --help."""

from __future__ import annotations

import argparse
import logging
import os
import re
import shlex
import signal
import sys

from . import __version__
from .counter import Counter


class _Parser(argparse.ArgumentParser):
    def convert_arg_line_to_args(self, arg_line: str) -> list[str]:
        return shlex.split(arg_line, comments=True)


def _options() -> argparse.ArgumentParser:
    parser = _Parser(prog="pirsim-live", description="count people live, by a counter of pirsim calibrate",
                     fromfile_prefix_chars="@")
    parser.add_argument("--version", action="version", version=__version__)
    commands = parser.add_subparsers(dest="command", required=True)
    mqtt = commands.add_parser("mqtt", help="from topics of motion sensors to people, P(nobody) and occupancy",
                               fromfile_prefix_chars="@", epilog="@FILE: options from a file, as on the command line; # begins a comment")
    mqtt.add_argument("--counter", metavar="FILE", required=True, help="counter.json of pirsim calibrate")
    mqtt.add_argument("--broker", metavar="HOST", required=True)
    mqtt.add_argument("--port", metavar="N", type=int, help="default: 1883, or 8883 with --tls")
    mqtt.add_argument("--sensor", metavar="SENSOR=TOPIC[:KEY]", action="append", default=[],
                      help="of each sensor of the counter; KEY of JSON messages, as state or Switch1.Action (default: occupancy, "
                           "presence, motion, state)")
    mqtt.add_argument("--name", default="pirsim", help="of the device, and in its topics; default: %(default)s")
    mqtt.add_argument("--off-at", metavar="P", type=float, default=0.9,
                      help="occupancy ends at this P(nobody); default: %(default)g")
    mqtt.add_argument("--user", metavar="NAME")
    mqtt.add_argument("--password-file", metavar="FILE", help="its first line is the password")
    mqtt.add_argument("--tls", action="store_true", help="the broker's certificate must be valid")
    mqtt.add_argument("--ca", metavar="FILE", help="with --tls: of who signed it (default: the system's)")
    mqtt.add_argument("--state", metavar="FILE", help="keeps beliefs and occupancy over restarts")
    return parser


def _check(options: argparse.Namespace) -> None:
    """Before anything is connected. Raises ValueError."""
    faults = [
        (not re.fullmatch("[A-Za-z0-9_-]+", options.name), "--name: letters, digits, - and _ alone: Home Assistant asks for that"),
        (options.port is not None and not 0 < options.port < 65536, "--port: from 1 to 65535"),
        (options.password_file is not None and options.user is None, "--password-file needs --user"),
        (options.ca is not None and not options.tls, "--ca goes with --tls"),
        (options.ca is not None and not os.path.isfile(options.ca), f"--ca: there is no file {options.ca!r}"),
        (options.state is not None and not os.path.isdir(os.path.dirname(os.path.abspath(options.state))),
         f"--state: there is no folder for {options.state!r}"),
        (options.state is not None and os.path.exists(options.state) and not os.path.isfile(options.state),
         f"--state: {options.state!r} is no file"),
    ]
    for is_fault, told in faults:
        if is_fault:
            raise ValueError(told)


def _run_mqtt(options: argparse.Namespace) -> None:
    _check(options)
    import paho.mqtt.client as paho

    from .mqtt import Bridge, Source
    client = paho.Client(paho.CallbackAPIVersion.VERSION2, client_id=f"pirsim-live-{options.name}", clean_session=True)
    if options.user is not None:
        password = None
        if options.password_file is not None:
            with open(options.password_file, encoding="utf-8") as file:
                password = file.readline().rstrip("\r\n")
        client.username_pw_set(options.user, password)
    if options.tls:
        client.tls_set(ca_certs=options.ca)
    bridge = Bridge(Counter(options.counter), map(Source.of, options.sensor), client, name=options.name,
                    off_at=options.off_at, state_file=options.state)
    stops: list[int] = []
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda received, _frame: stops.append(received))
    bridge.run(options.broker, options.port or (8883 if options.tls else 1883), lambda: bool(stops))


def main(arguments: list[str] | None = None) -> int:
    options = _options().parse_args(arguments)
    logging.basicConfig(format="%(message)s", level=logging.INFO)
    try:
        _run_mqtt(options)
    except (OSError, ValueError) as fault:
        print(f"error: {fault}", file=sys.stderr)
        return 4 if isinstance(fault, OSError) else 2
    except ImportError:
        print("error: pirsim-live mqtt needs paho-mqtt: pip install paho-mqtt", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
