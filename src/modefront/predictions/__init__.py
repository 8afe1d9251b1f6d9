"""Predictions of updated models, one class a file; others are registered as these are."""

from modefront.predictions.base import (
    CLASSES,
    NumericalCheck,
    Prediction,
    PredictionKind,
    ResultVariable,
    Setting,
)
from modefront.predictions.first_passage import Passage, SoilFilter
from modefront.predictions.peak_response import PeakResponse

CLASSES.add(PeakResponse)
CLASSES.add(Passage)

__all__ = [
    "CLASSES",
    "NumericalCheck",
    "Passage",
    "PeakResponse",
    "Prediction",
    "PredictionKind",
    "ResultVariable",
    "Setting",
    "SoilFilter",
]
