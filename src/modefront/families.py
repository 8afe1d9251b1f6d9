"""Families that users extend: kinds of models, residuals and predictions, methods, readers."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from operator import attrgetter
from typing import Any, Generic, TypeVar

from modefront.errors import Fault, refuse, refusing, wrong
from modefront.text import NAME, clean

T = TypeVar("T")


@dataclass(eq=False)
class Family(Mapping[str, T], Generic[T]):
    """The members of a family by their names, in the order in which they came.

    They are the package's ``own``, those added by `modefront.register`, and those brought by entry
    points of a ``group``; ``what`` describes one in messages. Members are instances of a class or
    protocol; ``faults`` says what else keeps an object from being one.
    """

    group: str
    what: str
    member: type
    own: Sequence[T] = ()
    name: Callable[[T], str] = attrgetter("name")
    faults: Callable[[T], Iterable[Fault]] = lambda _: ()
    added: dict[str, T] = field(default_factory=dict)
    _is_loaded: bool = False

    def add(self, member: T) -> T:
        """Add a member, in place of one that was added under its name, and return it.

        Raises InputError where it is none of the family, or the package has one of its name.
        """
        if not isinstance(member, self.member):
            raise wrong("register", self.what, clean(repr(member), NAME))
        refuse(self.faults(member))
        name = self.name(member)
        if name in map(self.name, self.own):
            raise wrong("register", f"{self.what} with a name of its own", repr(name))
        self.added[name] = member
        return member

    def __getitem__(self, name: str) -> T:
        return self._all()[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._all())

    def __len__(self) -> int:
        return len(self._all())

    def _all(self) -> dict[str, T]:
        """Return all members; raises InputError for an entry point that brings none."""
        if not self._is_loaded:
            for each in _entry_points().select(group=self.group):
                place = f"entry point '{each.name}' = {each.value} of {self.group}"
                with refusing("", self.what, place=place):  # another's package may raise anything
                    self.add(each.load())
            self._is_loaded = True
        return {self.name(member): member for member in self.own} | self.added


@cache
def _entry_points() -> Any:
    from importlib.metadata import entry_points  # takes time, as does finding them

    return entry_points()
