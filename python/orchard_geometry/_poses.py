"""Poses, budgets and answers that all questions share."""
from __future__ import annotations

import enum
import math
import typing

import numpy

from . import _runtime
from ._arrays import Anything, Floats, choice, number, whole
from ._trees import Bools, Ints, Tree

_NONE = 0xFFFFFFFF
IDENTITY = (0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)


class Answer(enum.IntEnum):
    """What is certain about a pair of surfaces."""

    NO = 0  #: they do not touch
    MAYBE = 1  #: nothing excludes it so far; bounds say how far apart they may be
    YES = 2  #: a triangle of one meets a triangle of the other


def flags(mask: typing.Any) -> Bools:
    return numpy.asarray(mask, dtype=numpy.bool_)


def poses_of(name: str, value: Anything) -> Floats:
    """(k, 7), (7,), (k, 4, 4) or (4, 4) as (k, 7) or (k, 16)."""
    array = numpy.asarray(value)
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name}: expected numbers, not {array.dtype}")
    if array.shape == (4, 4) or array.shape == (7,):
        array = array[numpy.newaxis]
    if array.ndim == 3 and array.shape[1:] == (4, 4):
        array = array.reshape(len(array), 16)
    elif array.ndim != 2 or array.shape[1] != 7:
        raise ValueError(f"{name}: expected the shape (k, 7) or (k, 4, 4), not {numpy.asarray(value).shape}")
    return numpy.ascontiguousarray(array, dtype=numpy.float64)


def wxyz_of(quaternion: str) -> bool:
    return choice("quaternion", quaternion, ("wxyz", "xyzw")) == "wxyz"


def triangles_of(a: typing.Any, b: typing.Any) -> Ints:
    both: Ints = numpy.stack([a, b], axis=1).astype(numpy.int64)
    both[both == _NONE] = -1
    return both


def tree_of(tree: object, name: str) -> _runtime.Tree:
    if not isinstance(tree, Tree):
        raise TypeError(f"{name}: expected a Tree, not {type(tree).__name__}")
    return tree._tree


def limits_of(work: int | None, seconds: float | None) -> tuple[int, float]:
    return (0 if work is None else whole("work", work, 1, 2**63 - 1),
            math.inf if seconds is None else number("seconds", seconds, 0, 1e9))
