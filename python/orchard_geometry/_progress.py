"""What long calls report."""
from __future__ import annotations

import typing

#: Called with the stage and the fraction of it that is done, about 20 times a second; returning False stops the call,
#: which then raises Cancelled. Exceptions end the call as well.
Progress = typing.Optional[typing.Callable[[str, float], object]]
