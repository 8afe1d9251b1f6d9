"""Frequency response of linear structures, and its peaks."""

from modefront.response.function import Quantity, frequency_response
from modefront.response.peaks import Peak, peaks
from modefront.response.system import ModalSystem

__all__ = ["ModalSystem", "Peak", "Quantity", "frequency_response", "peaks"]
