"""Reduced bases that are certified in the full model: a few full eigensolutions for all the others.

``benchmarks/certificates.py`` shows how sharp certificates are, none of which may be below a true
error; limits on costs follow ``benchmarks/reduced.py`` and ``benchmarks/choice.py``. Results depend
on the latter within the tolerance only.
"""
