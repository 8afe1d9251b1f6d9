"""Reduced bases that certify themselves: from a few full eigensolutions to all the others.

``benchmarks/certificates.py`` measures the limits on certificates, which are to leave no estimate
below a third of the true error; those on costs follow ``benchmarks/reduced.py`` and
``benchmarks/choice.py``. Results depend on the latter within the tolerance only.
"""
