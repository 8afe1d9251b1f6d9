"""Frequency response of linear structures, and its peaks."""

from modefront.response.function import ResponseQuantity, frequency_response
from modefront.response.peaks import Peak, peaks
from modefront.response.system import ModalSystem

__all__ = ["ModalSystem", "Peak", "ResponseQuantity", "frequency_response", "peaks"]
