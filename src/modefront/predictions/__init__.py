"""Predictions of updated models: one kind a file, all of them named here."""

from modefront.predictions.base import (
    Kind,
    NumericalCheck,
    Prediction,
    ResultVariable,
    Setting,
)
from modefront.predictions.first_passage import Passage, SoilFilter
from modefront.predictions.peak_response import PeakResponse

KINDS: tuple[type[Prediction], ...] = (PeakResponse, Passage)
"""All kinds of predictions, in the order of their results."""

__all__ = [
    "KINDS",
    "Kind",
    "NumericalCheck",
    "Passage",
    "PeakResponse",
    "Prediction",
    "ResultVariable",
    "Setting",
    "SoilFilter",
]
