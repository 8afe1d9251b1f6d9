"""Files of which a row is lost, doubled or moved are refused, or give the same data.

``MODEFRONT_EXAMPLES`` is the number of examples of each format; `tasks.py spoil` takes 5,000.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from rows import FORMATS, Change, cannot_be_noticed, spoilt

from modefront.errors import InputError, ModelError

pytestmark = pytest.mark.slow(2)

EXAMPLES = int(os.environ.get("MODEFRONT_EXAMPLES", "25"))


@pytest.mark.parametrize("name", FORMATS)
def test_a_spoilt_row_is_an_error_or_leaves_the_same_data(name: str) -> None:
    form = FORMATS[name]
    with tempfile.TemporaryDirectory() as given_folder:
        folder = Path(given_folder)
        form.write(folder)
        path = folder / form.file
        content = path.read_bytes()
        right = form.read(folder)

        places = st.integers(0, 10**5), st.integers(0, 10**5)
        changes = st.builds(Change, st.sampled_from(form.kinds), *places)

        @settings(max_examples=EXAMPLES, suppress_health_check=list(HealthCheck), database=None)
        @given(changes)
        def holds(change: Change) -> None:
            other = spoilt(form, content, change)
            path.write_bytes(other)
            try:
                found = form.read(folder)
            except (InputError, ModelError):
                return
            assert found == right or cannot_be_noticed(form, content, change)

        holds()
