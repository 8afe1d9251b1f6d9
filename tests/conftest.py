"""Settings of all tests."""

from hypothesis import settings

settings.register_profile("modefront", deadline=None, derandomize=True, print_blob=False)
settings.load_profile("modefront")
