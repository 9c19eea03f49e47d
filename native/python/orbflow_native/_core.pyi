__version__: str

class OrbflowError(Exception):
    """What every error of Orbflow derives from."""

class InputError(OrbflowError):
    """This input or this setting cannot be done; the text says why, with numbers."""

class Cancelled(OrbflowError):
    """The job was stopped by its cancel token; nothing was changed."""

class CancelToken:
    """A flag that another thread raises to stop a running job."""

    def __new__(cls) -> CancelToken: ...
    def cancel(self) -> None:
        """Raise the flag; the job stops within a fraction of a second and raises `Cancelled`."""

    @property
    def is_cancelled(self) -> bool:
        """Whether the flag is up."""
