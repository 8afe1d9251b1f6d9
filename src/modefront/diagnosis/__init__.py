r"""Mistakes of models and data, found as the hypotheses that explain the measured modes best.

A mistake is a record (`modefront.diagnosis.mistakes`): the edits of data or model that undo it, its
price, its sentence and what mends it. One search (`modefront.diagnosis.search`) tries all of them,
alone and together, and one cost decides (`modefront.diagnosis.evidence`):

.. math:: C = -\ln p(\text{data} \mid \hat\theta, \text{changes}) - \ln p(\hat\theta)
   - \ln p(\text{changes}),

natural logarithms of probabilities, at the parameters of a short fit within the bounds. A mistake
is named where C is less than without it, and than with any other one in its place, by a clear
margin. ``benchmarks/check.py`` measures how reliable that is.
"""
