"""Predictions of updated models, one class a file; others are registered as these are."""

from modefront.predictions.base import CLASSES as CLASSES
from modefront.predictions.base import NumericalCheck as NumericalCheck
from modefront.predictions.base import Prediction as Prediction
from modefront.predictions.base import PredictionKind as PredictionKind
from modefront.predictions.base import ResultVariable as ResultVariable
from modefront.predictions.base import Setting as Setting
from modefront.predictions.first_passage import Passage as Passage
from modefront.predictions.first_passage import SoilFilter as SoilFilter
from modefront.predictions.peak_response import PeakResponse as PeakResponse

CLASSES.add(PeakResponse)
CLASSES.add(Passage)
