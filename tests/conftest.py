"""Property tests give the same examples on every run and machine."""

from hypothesis import settings

settings.register_profile("pinscrew", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("pinscrew")
