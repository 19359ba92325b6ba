# SPDX-FileCopyrightText: 2026 The warmccd developers
# SPDX-License-Identifier: BSD-3-Clause

"""Runs programs that query libccd, as they are, on this library."""

import argparse
import os
import pathlib
import sys

from . import get_library

_HERE = pathlib.Path(__file__).resolve().parent


def _run(arguments: argparse.Namespace) -> "list[str]":
    """Returns the program's command, and sets the environment in which it runs on this library."""
    preloaded = ["libwarmccd-middle.so"] * arguments.middle + ["libccd.so.2"] + ["libwarmccd-fcl.so"] * arguments.signed_distance
    folder = str(_HERE / "lib")
    # Elsewhere ld.so may find the system's libccd.so.2, and say nothing.
    if ":" in folder or ";" in folder:
        sys.exit(f"warmccd: {folder}: no program can be run on a library whose path has ':' or ';', at which ld.so splits it")
    # By their names: a path in LD_PRELOAD is split at its blanks.
    for variable, separator, values in [
        ("LD_LIBRARY_PATH", ":", [folder]),
        ("LD_PRELOAD", " ", preloaded),
    ]:
        others = [value for value in [os.environ.get(variable)] if value]
        os.environ[variable] = separator.join(values + others)
    return [arguments.program, *arguments.arguments]


def _compare(arguments: argparse.Namespace) -> "list[str]":
    """Returns the command of the recorder's script, which reads its own options."""
    recorder = _HERE / "recorder"
    script = ["sh", str(recorder / "compare.sh"), "--recorder", str(recorder), "--library", get_library()]
    return script + arguments.arguments


def main() -> None:
    parser = argparse.ArgumentParser(prog="warmccd", description=__doc__)
    commands = parser.add_subparsers(metavar="COMMAND", required=True)

    run = commands.add_parser("run", help="run a program on this library")
    run.add_argument("--signed-distance", action="store_true", help="FCL's signed distances too (fcl.distance)")
    run.add_argument("--middle", action="store_true", help="contact positions in the middle of the witness points, which costs less:"
                     " for programs that use no position; what rests slides by them")
    run.add_argument("program", metavar="PROGRAM", help="such as python")
    run.add_argument("arguments", metavar="ARGUMENT", nargs=argparse.REMAINDER)
    run.set_defaults(command=_run)

    # No prefix of options: all arguments are the script's.
    compare = commands.add_parser("compare", help="run a program as it is, and print what would change on this library",
                                  prefix_chars="\0", add_help=False)
    compare.add_argument("arguments", nargs=argparse.REMAINDER)
    compare.set_defaults(command=_compare)

    arguments = parser.parse_args()
    command = arguments.command(arguments)
    try:
        os.execvp(command[0], command)
    except OSError as error:
        sys.exit(f"warmccd: {command[0]}: {error.strerror}")


if __name__ == "__main__":
    main()
