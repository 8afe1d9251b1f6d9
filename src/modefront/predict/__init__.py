"""What an updated model predicts: peaks of frequency response, first-passage probabilities."""

from modefront.predict.passage import Passage
from modefront.predict.peak import PeakResponse
from modefront.predict.structure import Structure

Prediction = PeakResponse | Passage

__all__ = ["Passage", "PeakResponse", "Prediction", "Structure"]
