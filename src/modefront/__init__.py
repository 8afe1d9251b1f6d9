"""Structural model updating with all Pareto-optimal models."""

from typing import TYPE_CHECKING

from modefront._lazy import lazy
from modefront._version import __version__ as __version__

if TYPE_CHECKING:
    from modefront import fem as fem
    from modefront.data.csv import read_csv as read_csv
    from modefront.data.modal import ModalData as ModalData
    from modefront.data.modal import modal_data as modal_data
    from modefront.errors import InputError as InputError
    from modefront.errors import ModelError as ModelError
    from modefront.errors import UnfinishedError as UnfinishedError
    from modefront.front.methods import Method as Method
    from modefront.front.options import Pareto as Pareto
    from modefront.front.options import Weighted as Weighted
    from modefront.front.search import Search as Search
    from modefront.identifiability.combinations import Identifiability as Identifiability
    from modefront.identifiability.combinations import combinations as combinations
    from modefront.identification.modal_test import identify as identify
    from modefront.linalg.small import mac as mac
    from modefront.models.chain import chain as chain
    from modefront.models.files import read_matrix as read_matrix
    from modefront.models.function import function_model as function_model
    from modefront.models.matrices import matrices as matrices
    from modefront.models.mesh import mesh_model as mesh_model
    from modefront.models.parameters import Parameter as Parameter
    from modefront.models.parameters import Prior as Prior
    from modefront.models.reduced.options import Reduction as Reduction
    from modefront.pairing.match import Pairing as Pairing
    from modefront.predictions import Passage as Passage
    from modefront.predictions import PeakResponse as PeakResponse
    from modefront.predictions import Prediction as Prediction
    from modefront.predictions import PredictionKind as PredictionKind
    from modefront.predictions import SoilFilter as SoilFilter
    from modefront.reports.page import report as report
    from modefront.residuals.groups import Group as Group
    from modefront.residuals.problem import UpdatingProblem as UpdatingProblem
    from modefront.residuals.problem import updating_problem as updating_problem
    from modefront.results.compare import compare as compare
    from modefront.results.results import ReportedModel as ReportedModel
    from modefront.results.results import Results as Results
    from modefront.results.results import read_results as read_results
    from modefront.study.check import check as check
    from modefront.study.definition import Study as Study
    from modefront.study.export import export as export
    from modefront.study.file import load as load
    from modefront.study.file import register as register
    from modefront.study.importing import import_deck as import_deck
    from modefront.study.importing import import_model as import_model
    from modefront.study.kinds.sensors import ModelKind as ModelKind
    from modefront.study.measured import DataReader as DataReader
    from modefront.study.session import run as run
    from modefront.study.session import solve as solve
    from modefront.uncertainty.noise import Uncertainty as Uncertainty
    from modefront.uncertainty.prior import NoisePrior as NoisePrior

__getattr__, __dir__, __all__ = lazy(__name__, __file__)
