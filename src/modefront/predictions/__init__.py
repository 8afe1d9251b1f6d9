"""Predictions of updated models, one class a file; others are registered as these are."""

from modefront.predictions.base import (
    NumericalCheck,
    Prediction,
    PredictionKind,
    ResultVariable,
    Setting,
)
from modefront.predictions.first_passage import Passage, SoilFilter
from modefront.predictions.peak_response import PeakResponse
from modefront.predictions.registry import known, register

register(PeakResponse)
register(Passage)

__all__ = [
    "NumericalCheck",
    "Passage",
    "PeakResponse",
    "Prediction",
    "PredictionKind",
    "ResultVariable",
    "Setting",
    "SoilFilter",
    "known",
    "register",
]
