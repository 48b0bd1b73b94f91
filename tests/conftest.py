"""Property tests give the same examples on every run and machine; `pytester` tests the pytest plugin."""

from hypothesis import settings

pytest_plugins = ["pytester"]

settings.register_profile("pinscrew", derandomize=True, deadline=None, print_blob=True)
settings.load_profile("pinscrew")
