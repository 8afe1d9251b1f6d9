"""Groups of measured properties: which residuals each objective sums."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Literal, get_args

from modefront.data.modal import ModalData
from modefront.errors import suggestion
from modefront.families import Family
from modefront.options import WHOLE, Requirement, any_of, array, plain, whole
from modefront.residuals.base import Member, ResidualKind, Scale, Stack
from modefront.residuals.frequency import FrequencyKind
from modefront.residuals.shape import ShapeKind
from modefront.text import Shown

KINDS: Family[ResidualKind] = Family(
    "modefront.residuals",
    "a kind of residual, with what modefront.residuals.base.ResidualKind has",
    ResidualKind,
    (
        FrequencyKind(),
        ShapeKind("shape", "shapes", joint=False),
        ShapeKind("subspace", "subspaces", joint=True),
    ),
)
"""All kinds, in the order in which their residuals are stacked."""

ModeNumbers = Sequence[int] | Literal["all"]
"""Numbers of measured modes, counted from 1, or all that were measured."""

MODE_NUMBERS = Requirement(
    "'all' or a list of measured modes, counted from 1, each once",
    any_of({"enum": ["all"]}, array(whole(1, WHOLE).schema, once=True)),
)


@dataclass(frozen=True, init=False)
class Group(Shown):
    """An objective J_i: the sum of the squares of the residuals of its members.

    Each kind of residual (`KINDS`) is a keyword that names its measured modes:
    numbers, counted from 1, or ``"all"``. Kinds may be given by position too, in the order of their
    registration: frequencies, then shapes.

    Raises
    ------
    ValueError
        For a kind that there is not, anything but mode numbers, and another scale.

    Attributes
    ----------
    name : name of the objective in results
    scale : unit of the residuals: ``"measured"`` values, as in equation (1), or their standard
        deviations, ``"std"``
    chosen : measured modes by the name of the kind, of the kinds that the group has

    >>> Group("low modes", frequency=[1, 2], shape="all").chosen
    (('frequency', (1, 2)), ('shape', 'all'))
    """

    name: str
    scale: Scale
    chosen: tuple[tuple[str, tuple[int, ...] | Literal["all"]], ...]

    def __init__(
        self, name: str, *by_position: ModeNumbers, scale: Scale = "measured", **modes: ModeNumbers
    ) -> None:
        known = list(KINDS)
        if len(by_position) > len(known) or set(known[: len(by_position)]) & set(modes):
            expected = f"each of {', '.join(known)} once at most"
            raise ValueError(f"group '{name}': expected {expected}, found one more")
        modes = dict(zip(known, by_position, strict=False)) | modes
        for kind in modes:
            if kind not in known:
                expected = ", ".join(known)
                found = suggestion(kind, known)
                raise ValueError(f"group '{name}': expected one of {expected}, found {found}")
            if not MODE_NUMBERS.holds(plain(modes[kind])):
                expected, found = MODE_NUMBERS.expected, repr(modes[kind])
                raise ValueError(f"group '{name}': {kind}: expected {expected}, found {found}")
        if scale not in get_args(Scale):
            expected = " or ".join(map(repr, get_args(Scale)))
            raise ValueError(f"group '{name}': scale: expected {expected}, found {scale!r}")
        ordered = [(kind, modes[kind]) for kind in sorted(modes, key=known.index)]
        chosen = tuple((k, x if isinstance(x, str) else tuple(x)) for k, x in ordered if x)
        for key, value in (("name", name), ("scale", scale), ("chosen", chosen)):
            object.__setattr__(self, key, value)

    def modes_of(self, kind: str) -> ModeNumbers:
        """Return the chosen modes of a kind; empty where the group has none."""
        return dict(self.chosen).get(kind, ())

    def positions(self, data: ModalData) -> list[tuple[ResidualKind, tuple[int, ...]]]:
        """Return the positions of the chosen modes in the data, for each kind that has any."""
        places, out = {mode: r for r, mode in enumerate(data.modes)}, []
        for name, modes in self.chosen:
            numbers = _measured_modes(name, data) if modes == "all" else modes
            if numbers:
                out.append((KINDS[name], tuple(places[int(mode)] for mode in numbers)))
        return out

    def members(self, data: ModalData) -> list[Member]:
        """Return the members of the group; ValueError where the data lack some, see `faults`."""
        for key, expected, found in faults(self, data):
            place = f"group '{self.name}'" + (f": {key}" if key else "")
            raise ValueError(f"{place}: expected {expected}, found {found}")
        kinds = (kind.members(data, some, self.scale) for kind, some in self.positions(data))
        return list(chain.from_iterable(kinds))

    def stacks(self, data: ModalData) -> list[Stack]:
        """Return the members of the group, those of each kind together, in the same order."""
        return [kind.stack(data, some, self.scale) for kind, some in self.positions(data)]


def faults(group: Group, data: ModalData | None) -> Iterator[tuple[str, str, str]]:
    """Yield the faults of a group: the keyword, the expected and the found value.

    Without data, only what is wrong whatever they are.
    """
    if not group.chosen:
        kinds = " or ".join(KINDS)
        yield "", f"{kinds} with at least one measured mode", "nothing"
    elif data is not None:
        wrong = []
        for name, modes in group.chosen:
            measured = _measured_modes(name, data)
            for mode in [m for m in modes if m not in measured][:1] if modes != "all" else []:
                wrong.append((name, f"one of the measured modes {measured}", str(mode)))
        yield from wrong
        chosen = [] if wrong else group.positions(data)
        if not (wrong or chosen):
            yield "", "at least one measured property", "none in the data"
        for kind, r in [(kind, r) for kind, positions in chosen for r in positions]:
            if group.scale == "std" and not kind.has_usable_std(data, r):
                found = f"others for the {kind.name} of mode {data.modes[r]}"
                yield "scale", f"'std' with {kind.usable_std}", found


def _measured_modes(name: str, data: ModalData) -> list[int]:
    measured = KINDS[name].measured(data)
    return [mode for mode, known in zip(data.modes, measured, strict=True) if known]
