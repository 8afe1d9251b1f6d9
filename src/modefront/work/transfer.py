"""Tasks as bytes for other processes, and large objects that they share sent once.

An object of a class that is registered by `shared` is replaced by a name. A process that does not
know the name says so; the tasks are sent again with all that any process has lacked.
"""

import io
import pickle
import threading
import uuid
from collections import OrderedDict
from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar
from weakref import ref

from modefront.work.task import Costs, Done, Task, computed

KNOWN = 3  # shared objects that a process keeps at most: those used last

S = TypeVar("S", bound=type)

_REGISTERED: set[type] = set()


def shared(kind: S) -> S:
    """Register a class of objects that many tasks have, and that are sent to a process once.

    Attributes of such classes are sent on their own. An object that changes has a number
    ``version``, which changes with it. One with which a process takes much memory to work has a
    ``footprint``, these bytes, estimated.
    """
    _REGISTERED.add(kind)
    return kind


@dataclass(frozen=True)
class Message:
    """Tasks as bytes, with the names of the shared objects among their arguments."""

    content: bytes
    names: tuple[str, ...]
    memory: float


@dataclass
class Sender:
    """Makes bytes of tasks."""

    _objects: dict[tuple[int, Hashable], tuple[str, ref[object]]] = field(default_factory=dict)

    def message(self, tasks: Sequence[Task[Any]]) -> Message:
        """Return tasks as bytes. Raises what `pickle` raises for what cannot be pickled."""
        pickled = _Pickler(self, list(tasks))
        memory = pickled.memory + max((task.memory for task in tasks), default=0.0)
        return Message(pickled.content, tuple(pickled.met), memory)

    def objects(self, names: Sequence[str]) -> dict[str, bytes]:
        """Return shared objects by their names, in this order."""
        values = {name: found() for name, found in self._objects.values()}
        return {name: _Pickler(self, values[name]).content for name in names}

    def name(self, value: object) -> str:
        """Return the name of a shared object; another version of it has another name."""
        key = id(value), getattr(value, "version", 0)
        name, known = self._objects.get(key, ("", None))
        if known is None or known() is not value:
            # Of an object that changes, no task asks for an earlier version again, and of one that
            # nobody holds, for none.
            kept = {x: y for x, y in self._objects.items() if x[0] != key[0] and y[1]() is not None}
            name = uuid.uuid4().hex
            self._objects = kept | {key: (name, ref(value))}
        return name


class _Pickler(pickle.Pickler):
    """Pickles tasks, or a shared object; shared objects are ``met``, and take some ``memory``."""

    def __init__(self, sender: Sender, root: object) -> None:
        super().__init__(stream := io.BytesIO(), pickle.HIGHEST_PROTOCOL)
        self.sender, self.root = sender, root
        self.met: dict[str, None] = {}  # in order
        self.memory = 0.0
        self.dump(root)
        self.content = stream.getvalue()

    def persistent_id(self, value: Any) -> str | None:
        if type(value) not in _REGISTERED or value is self.root:
            return None
        self.memory = max(self.memory, getattr(value, "footprint", 0.0))
        return self._meet(value)

    def _meet(self, value: Any) -> str:
        """Return the name of a shared object, after those of its attributes."""
        for part in value.__getstate__().values():
            if type(part) in _REGISTERED:
                self._meet(part)
        name = self.sender.name(value)
        self.met[name] = None
        return name


class _Unpickler(pickle.Unpickler):
    """Unpickles tasks, with shared objects in the place of their names."""

    def persistent_load(self, name: Any) -> Any:
        return _OBJECTS[name]


_OBJECTS: OrderedDict[str, Any] = OrderedDict()
_LOCK = threading.Lock()

Reply = list[Done] | tuple[str, ...]
"""What a process sends back: results, or names of shared objects that it does not know."""


def work(message: Message, objects: dict[str, bytes]) -> Reply:
    """Compute the tasks of a message; with it come shared objects or none, after their parts."""
    with _LOCK:  # workers of a cluster may have several threads
        lacking = tuple(x for x in message.names if x not in _OBJECTS and x not in objects)
        if lacking:  # they may be parts of those that came
            return lacking
        for name, content in objects.items():
            if name not in _OBJECTS:
                _OBJECTS[name] = _Unpickler(io.BytesIO(content)).load()
        for name in message.names:
            _OBJECTS.move_to_end(name)
        while len(_OBJECTS) > max(KNOWN, len(message.names)):
            _OBJECTS.popitem(last=False)
        tasks: list[Task[Any]] = _Unpickler(io.BytesIO(message.content)).load()
    out: list[Done] = []
    for task in tasks:
        try:
            out.append(computed(task))
        except Exception as error:  # it belongs to the caller
            out.append(Done(None, Costs(), 0.0, error))
    return out
