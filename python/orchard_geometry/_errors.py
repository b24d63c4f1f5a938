"""The errors of orchard_geometry. Nothing else is needed to import them."""


class OrchardError(RuntimeError):
    """What could not be done, although the input allows it: a file that cannot be written, say."""


class Cancelled(OrchardError):
    """A progress callback returned False."""


class MeshError(ValueError):
    """A mesh, a file or an option that cannot be used. The message is the command line's: place, fault and remedy."""


class RepairWarning(UserWarning):
    """A mesh was repaired where that is safe, as the commands do; the message says what was done."""
