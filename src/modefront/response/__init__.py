"""Frequency response of linear structures, and its peaks."""

from modefront.response.function import Peak, ResponseQuantity, frequency_response, peaks
from modefront.response.system import ModalSystem

__all__ = ["ModalSystem", "Peak", "ResponseQuantity", "frequency_response", "peaks"]
