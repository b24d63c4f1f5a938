"""Arrays on their way to C++ and back. What is wrong with one is said here, with the name of the argument."""
from __future__ import annotations

import typing

import numpy
import numpy.typing

Floats = numpy.typing.NDArray[numpy.float64]
Indices = numpy.typing.NDArray[numpy.uint32]
Anything = typing.Any  # what numpy.asarray() takes: arrays, nested lists, objects of other libraries

MAX_INDEX = 0xFFFFFFFE


def view(array: object) -> typing.Any:
    """What C++ owns as an array of NumPy: no copy, read-only."""
    return numpy.asarray(array)


def _as_array(name: str, value: Anything) -> numpy.typing.NDArray[typing.Any]:
    try:
        array = numpy.asarray(value)
    except Exception as error:
        raise ValueError(f"{name}: not an array of numbers: {error}") from None
    if array.dtype.kind not in "fiu":
        raise ValueError(f"{name}: expected numbers, not {array.dtype}")
    return array


def _shape(columns: int) -> str:
    return f"(n, {columns})" if columns else "(n,)"


def floats(name: str, value: Anything, columns: int, *, finite: bool = True, single: bool = False) -> Floats:
    """A C-contiguous (n, columns) array of float64, or (n,) for 0 columns. A copy only where the type or the order of
    the numbers asks for it. `single`: one row may come as (columns,)."""
    array = _as_array(name, value)
    if array.size == 0 and array.ndim <= 1:
        array = array.reshape((0, columns) if columns else (0,))
    if single and columns and array.shape == (columns,):
        array = array.reshape(1, columns)
    if array.ndim != (2 if columns else 1) or (columns and array.shape[1] != columns):
        raise ValueError(f"{name}: expected the shape {_shape(columns)}, not {array.shape}")
    result = numpy.ascontiguousarray(array, dtype=numpy.float64)
    if finite and not numpy.isfinite(result).all():
        row = int(numpy.argwhere(~numpy.isfinite(result))[0][0])
        raise ValueError(f"{name}[{row}]: not a finite number")
    return result


def indices(name: str, value: Anything, columns: int, count: int | None = None) -> Indices:
    """A C-contiguous (n, columns) array of uint32, or (n,) for 0 columns, each below `count` if that is given."""
    array = _as_array(name, value)
    if array.size == 0 and array.ndim <= 1:
        array = numpy.zeros((0, columns) if columns else (0,), numpy.uint32)
    if array.dtype.kind == "f":
        raise ValueError(f"{name}: expected whole numbers, not {array.dtype}")
    if array.ndim != (2 if columns else 1) or (columns and array.shape[1] != columns):
        raise ValueError(f"{name}: expected the shape {_shape(columns)}, not {array.shape}")
    if array.size:
        low, high = int(array.min()), int(array.max())
        limit = MAX_INDEX if count is None else count - 1
        if low < 0 or high > limit:
            wrong = low if low < 0 else high
            row = int(numpy.argwhere(array == wrong)[0][0])
            known = "" if count is None else f"; there are {count}, and numbers count from 0"
            raise ValueError(f"{name}[{row}]: {wrong} is out of range{known}")
    return numpy.ascontiguousarray(array, dtype=numpy.uint32)


def number(name: str, value: typing.Any, low: float, high: float) -> float:
    """A number in [low, high]."""
    try:
        result = float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{name}: {value!r} is not a number") from None
    if not low <= result <= high:
        raise ValueError(f"{name}: {result:g} is not between {low:g} and {high:g}")
    return result


def whole(name: str, value: typing.Any, low: int, high: int) -> int:
    """A whole number in [low, high]."""
    if isinstance(value, bool) or not isinstance(value, (int, numpy.integer)):
        raise ValueError(f"{name}: {value!r} is not a whole number")
    if not low <= int(value) <= high:
        raise ValueError(f"{name}: {int(value)} is not between {low} and {high}")
    return int(value)


def choice(name: str, value: typing.Any, choices: typing.Sequence[str]) -> str:
    """One of some words."""
    if value not in choices:
        raise ValueError(f"{name}: {value!r} is not one of {', '.join(choices)}")
    return str(value)
