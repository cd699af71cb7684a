"""Makes a call of the maker's library on our client."""

from __future__ import annotations

from typing import Any

from cobotwire.protocol.errors import UsageError
from cobotwire.pymycobot.layer import results
from cobotwire.pymycobot.layer.ranges import check_range

# The parameter with which a caller does not wait for an acknowledgement or the end of a motion.
QUIET = "_async"


class Method:
    """A method of the library, which calls one of ours.

    Attributes:
        name: its name.
        title: what it does, without a full stop.
        by: the method of ``CompatibleClient`` that makes the call, without its underscore.
        parameters: each parameter, its annotation, and its default if it has one.
        arguments: for each argument of our method: its name, the library's parameter or the number
            that is passed for it (empty: nothing is passed), and its default if it has one.
        calls: our method.
        address: the parameter that selects the device; empty if no parameter does.
        only_here: whether only the client of the edition of ``PORTS`` has our method.
        lacks: parameters that cannot be sent.
        ranges: parameters, each with its least and greatest number.
        result: the function of ``layer/results.py`` that gives the result.
        gives: how ``migrate`` converts our result to the library's.
        keywords: our arguments that are passed only by keyword.
    """

    address = ""
    only_here = False
    lacks: tuple[str, ...] = ()
    ranges: tuple[tuple[str, int, int], ...] = ()
    result = "plain"
    gives = "nothing"
    keywords: tuple[str, ...] = ()

    def __init__(
        self,
        name: str,
        title: str,
        by: str,
        parameters: tuple[tuple[Any, ...], ...],
        arguments: tuple[tuple[str, ...], ...],
        further: tuple[tuple[str, Any], ...],
    ) -> None:
        self.name = self.calls = name
        self.title = title
        self.by = by
        self.parameters = parameters
        self.arguments = arguments
        # The attributes that few methods state.
        self.__dict__.update(further)
        self._is_prepared = False

    @property
    def doc(self) -> str:
        """The docstring: what it does, and how our client is called for it."""
        title = f"{self.title}."
        theirs = [name for name, *_ in self.parameters]
        if theirs == [name for name, *_ in self.arguments]:
            return title
        given = [ours if each in ("", *theirs) else each for ours, each, *_ in self.arguments]
        device = f"at({self.address})." if self.address else ""
        return f"{title}\n\nCalls ``{device}{self.calls}({', '.join(given)})``."

    def _prepare(self) -> None:
        """Compute what calls need at the first call: a program calls few methods of a class."""
        places = {name: place for place, (name, *_) in enumerate(self.parameters)}
        self._by = f"_{self.by}"
        self._address = places.get(self.address)
        self._lacks = [(name, places[name]) for name in self.lacks]
        self._ranges = [(name, places[name], low, high) for name, low, high in self.ranges]
        passed = [theirs for _, theirs, *_ in self.arguments if theirs]
        # For each argument of our method, an index into the arguments that the caller gives,
        # followed by the numbers.
        self._numbers = tuple(int(each) for each in passed if each not in places)
        after = iter(range(len(places), len(places) + len(self._numbers)))
        self._passes = [places[each] if each in places else next(after) for each in passed]
        # A flag that is False is left out if False is the library's default, and None is ours.
        no = {name for name, _, *default in self.parameters if default in ([False], [0])}
        self._left_out = [
            place
            for place, (_, theirs, *default) in enumerate(self.arguments)
            if theirs in no and default == ["None"]
        ]
        self._quiet = places.get(QUIET) if self.by in ("send_acked", "move") else None
        result = getattr(results, self.result, None)
        self._first = [result] if self.by == "query" else []
        self._options = {"gives": result} if self.by == "send_acked" else {}
        names = {ours: theirs for ours, theirs, *_ in self.arguments if theirs in places}
        self._names = {ours: theirs for ours, theirs in names.items() if ours != theirs}
        if self.address:
            self._names["address"] = self.address
        self._is_prepared = True

    def __call__(self, client: Any, *given: Any) -> Any:
        """Make the call. An error about an argument names the library's parameter."""
        if not self._is_prepared:
            self._prepare()
        try:
            if self._lacks or self._ranges:
                self._check(client, given)
            ours = self._ours(client, given)
            every = given + self._numbers
            passed = [every[place] for place in self._passes]
            for place in self._left_out:
                passed[place] = passed[place] or None
            options = self._options
            if self._quiet is not None:
                options = {**options, "quiet": given[self._quiet]}
            return getattr(client, self._by)(*self._first, ours, *passed, **options)
        except UsageError as error:
            if not self._names:
                raise
            raise error.renamed(self._names) from None

    def _check(self, client: Any, given: tuple[Any, ...]) -> None:
        client._lacks(**{name: given[place] for name, place in self._lacks})
        for name, place, lowest, highest in self._ranges:
            check_range(name, given[place], lowest, highest)

    def _ours(self, client: Any, given: tuple[Any, ...]) -> Any:
        """Return the method of our client."""
        if self.only_here:
            return client._only_here(self.calls)
        arm = client.arm if self._address is None else client.arm.at(given[self._address])
        return getattr(arm, self.calls)
