"""Files of medial axes that are lists of balls or cells and no more; the others are written by C++."""
from __future__ import annotations

import typing

if typing.TYPE_CHECKING:
    from ._medial import MedialAxis


def _rows(*arrays: typing.Any) -> typing.Iterator[str]:
    """The numbers of each row, in the fewest digits that read back as the same."""
    for row in zip(*(array.tolist() for array in arrays)):
        flat = [number for part in row for number in (part if isinstance(part, list) else [part])]
        yield " ".join(repr(number) for number in flat)


def _balls(axis: MedialAxis) -> list[str]:
    return list(_rows(axis.vertices, axis.radii))


def _off(axis: MedialAxis) -> list[str]:
    return ["OFF", f"{len(axis)} {len(axis.faces)} 0", *_rows(axis.vertices), *(f"3 {row}" for row in _rows(axis.faces))]


def _cg(axis: MedialAxis) -> list[str]:
    return [f"# D:3 NV:{len(axis)} NE:{len(axis.edges)}", *(f"v {row}" for row in _rows(axis.vertices)),
            *(f"e {row}" for row in _rows(axis.edges + 1))]


def write_axis(axis: MedialAxis, path: str, ending: str) -> None:
    """By the ending, in lower case and with its dot. ValueError for those that an axis cannot be written to."""
    if ending in (".txt", ".xyz", ".xyzr", ".balls"):
        lines = _balls(axis)
    elif ending == ".sph":
        lines = [f"4 {len(axis)}", *_balls(axis)]
    elif ending == ".off":
        lines = _off(axis)
    elif ending == ".cg":
        lines = _cg(axis)
    else:
        raise ValueError(f"{path}: an axis is saved as .ma, .ply, .obj, .graphml, .off, .sph, .cg, .txt, .xyz, .xyzr or "
                         ".balls")
    from ._trees import _write

    _write(path, ("\n".join(lines) + "\n").encode())
