#!/usr/bin/env python3
"""Checks the program's command lines in the pages: exit code 1 and a line for each that the program would not take.

command_lines.py PROGRAM PAGE.md..

Every line of a ```sh block that begins with "orchard" must name a command, and every option in it must be that command's, with
one of its values where it has a list of them.
"""
import re
import shlex
import subprocess
import sys


def options_of(program):
    """For each command its options, each with its choices or nothing, from the page of all options."""
    commands, command = {}, None
    for line in subprocess.run([program, "reference", "markdown"], check=True, capture_output=True,
                               text=True).stdout.splitlines():
        if line.startswith("## orchard "):
            command = commands.setdefault(line.split()[2], {"--help": []})
        elif line.startswith("| `-"):
            names, value = re.match(r"\| (`.*?`) \| (.*?) \| ", line).groups()
            choices = value.strip("`").split("\\|") if "\\|" in value else []
            for name in re.findall(r"`([^`]+)`", names):
                command[name] = choices
    return commands


def lines_of(page):
    inside = False
    with open(page, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            if line.startswith("```"):
                inside = line.strip() == "```sh"
            elif inside and line.startswith("orchard "):
                yield number, line


def faults(words, commands):
    if "--" in words:  # what a batch runs
        at = words.index("--")
        yield from faults(["orchard", *words[at + 1:]], commands)
        words = words[:at]
    if words[1] not in commands:
        yield f"there is no command {words[1]}"
        return
    options = commands[words[1]]
    for word, following in zip(words[2:], words[3:] + [""]):
        if not re.match(r"--?[a-z]", word):
            continue
        name, _, value = word.partition("=")
        if name not in options:
            yield f"orchard {words[1]} has no option {name}"
        elif options[name] and not set((value or following).split(",")) <= set(options[name]):
            yield f"orchard {words[1]} {name} takes {' '.join(options[name])}, not {value or following}"


def main():
    program, *pages = sys.argv[1:]
    commands = options_of(program)
    assert len(commands) > 8, "the program's page of options has no commands"
    count, wrong = 0, 0
    for page in pages:
        for number, line in lines_of(page):
            count += 1
            for fault in faults(shlex.split(line, comments=True), commands):
                wrong += 1
                print(f"{page}:{number}: {fault}")
    print(f"{count} command lines, {wrong} faults")
    assert count > 0, "there is no command line in these pages"
    sys.exit(1 if wrong else 0)


main()
