"""Tuning options: keywords on their way to the command line's own table, which has their ranges and sets them."""
from __future__ import annotations

import typing

import numpy


def as_text(name: str, value: typing.Any) -> str:
    """A value as the command line writes it, to the last digit."""
    if isinstance(value, (bool, numpy.bool_)):
        return "yes" if value else "no"
    if isinstance(value, (int, numpy.integer)):
        return str(int(value))
    if isinstance(value, (float, numpy.floating)):
        return repr(float(value))
    if isinstance(value, str):
        return value
    raise ValueError(f"{name}: {value!r} is neither a number nor a word")


def command_name(name: str) -> str:
    """The name of an option in the command line's table; prune_angle is --prune angle=.."""
    if name.startswith("prune_"):
        return "prune " + name.removeprefix("prune_").replace("_", "-")
    return name.replace("_", "-")


def keyword(name: str) -> str:
    """The keyword of an option, by its name in the command line's table."""
    return name.replace("-", "_").replace(" ", "_")


def tuning_of(**options: typing.Any) -> dict[str, str]:
    """The options that are given, by the command line's names."""
    return {command_name(name): as_text(name, value) for name, value in options.items() if value is not None}
