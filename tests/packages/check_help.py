#!/usr/bin/env python3
"""Checks that each option and subcommand that a program's --help prints is in its man page and in its completions.

usage: check_help.py PROGRAM [SUBCOMMAND...]

SUBCOMMAND is one that the program parses by itself, so that its --help does not list it. The names come from the
printed text of --help alone. Exit code 0: all are there; 1: the names that are missing are printed.
"""
import re
import subprocess
import sys

OPTION = re.compile(r"^  ((?:-\w,)?--[a-z][a-z0-9-]*|-\w)(?=[ \n]|$)", re.MULTILINE)
SUBCOMMANDS = re.compile(r"^Subcommands:\n((?:  .*\n?)+)", re.MULTILINE)


def printed(program, *words):
    return subprocess.run([program, *words], check=True, capture_output=True, text=True).stdout


def names_of_help(text):
    """Returns the options and the subcommands of a text of --help."""
    options = {name for entry in OPTION.findall(text) for name in entry.split(",")}
    listed = SUBCOMMANDS.search(text)
    subcommands = re.findall(r"^  (\S+)", listed.group(1), re.MULTILINE) if listed else []
    return options, subcommands


def missing(program, path, more, texts):
    """Yields a line for each name that a text lacks, of the subcommand at `path` and of all below it."""
    options, subcommands = names_of_help(printed(program, *path, "--help"))
    if "--help" not in options:
        yield f"--help of {' '.join([program, *path])} lists no options"
    for option in options:
        dashes, name = re.match(r"(--?)(.*)", option).groups()
        patterns = {
            "man": re.escape("\\fB" + option.replace("-", "\\-") + "\\fR"),
            "bash": r"(?<=[ '])" + re.escape(option) + r"(?=[ '])",
            "zsh": "'" + re.escape(option) + r"\[",
            "fish": (" -l " if dashes == "--" else " -s ") + re.escape(name) + " ",
        }
        for kind, pattern in patterns.items():
            if not re.search(pattern, texts[kind]):
                yield f"{kind}: {' '.join(path)} {option} is missing"
    for subcommand in [*subcommands, *more]:
        words = [*path, subcommand]
        for kind, pattern in {
            "man": r'^\.SS "\\fB' + re.escape(" ".join(words)) + r"\\fR",
            "bash": r"'/" + re.escape("/".join(words)) + r"'\) words=",
            "zsh": re.escape("__" + "__".join(words)) + r"\(\)",
            "fish": r" -a " + re.escape(subcommand) + " ",
        }.items():
            if not re.search(pattern, texts[kind], re.MULTILINE):
                yield f"{kind}: the subcommand {' '.join(words)} is missing"
        yield from missing(program, words, [], texts)


def main():
    program, *more = sys.argv[1:]
    texts = {"man": printed(program, "--help-man")}
    for shell in ("bash", "zsh", "fish"):
        texts[shell] = printed(program, "--completion", shell)
    lines = list(missing(program, [], more, texts))
    # The check itself must notice a name that is missing.
    broken = {**texts, "zsh": texts["zsh"].replace("--version", "--verslon")}
    if not any("--version is missing" in line for line in missing(program, [], more, broken)):
        lines.append("the check did not notice that --version was taken out of the completion for zsh")
    print("\n".join(lines))
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
