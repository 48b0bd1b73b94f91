"""Methods of plain values that an expression may call, by the value's type and the method's name.

Each leaves its value as it is, and gives back nothing much larger than what went in: what could grow without bounds
(``join``, ``replace``) is measured before it is done. A type's other methods stay out of reach, ``format`` above all,
since a format such as ``'{0.__class__}'`` reaches attributes on its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import islice
from typing import Any, Final

__all__ = ["LONGEST_TEXT", "TooLongError", "method"]

LONGEST_TEXT: Final = 100_000
"""Characters that `join` and `replace` may make, and pieces that `join` may put together."""


class TooLongError(Exception):
    """A method would make a text that is too long."""


def _join(separator: str, pieces: Iterable[str]) -> str:
    listed = list(islice(pieces, LONGEST_TEXT + 1))
    length = sum(len(piece) for piece in listed) + len(separator) * len(listed)
    if len(listed) > LONGEST_TEXT or length > LONGEST_TEXT:
        raise TooLongError(f"a join of more than {LONGEST_TEXT} characters")
    return separator.join(listed)


def _replace(text: str, old: str, new: str, count: int = -1) -> str:
    times = text.count(old)
    if count >= 0:
        times = min(times, count)
    if len(text) + times * (len(new) - len(old)) > LONGEST_TEXT:
        raise TooLongError(f"a replace to more than {LONGEST_TEXT} characters")
    return text.replace(old, new, count)


_TEXT: Final[Mapping[str, Callable[..., Any]]] = {
    **{
        function.__name__: function
        for function in (
            *(str.split, str.rsplit, str.splitlines, str.partition, str.rpartition),
            *(str.lower, str.upper, str.title, str.capitalize, str.strip, str.lstrip, str.rstrip),
            *(str.startswith, str.endswith, str.find, str.rfind, str.index, str.rindex, str.count),
            *(str.isdigit, str.isdecimal, str.isnumeric, str.isalpha, str.isalnum, str.islower, str.isupper),
            str.isspace,
        )
    },
    "join": _join,
    "replace": _replace,
}
_LIST: Final[Mapping[str, Callable[..., Any]]] = {"index": list.index, "count": list.count}
_TUPLE: Final[Mapping[str, Callable[..., Any]]] = {"index": tuple.index, "count": tuple.count}
_DICT: Final[Mapping[str, Callable[..., Any]]] = {
    "get": dict.get,
    "keys": dict.keys,
    "values": dict.values,
    "items": dict.items,
}


def method(value: Any, name: str, lists: type[list[Any]], dicts: type[dict[Any, Any]]) -> Callable[..., Any] | None:
    """The method of this name, bound to the value; None where the value's type has none that may be called.

    Types are compared, not asked for their base classes: a value of any other class has methods of its own.

    Args:
        value: of any type.
        name: of the method.
        lists: a further class that counts as a list: what a YAML file's lists become.
        dicts: a further class that counts as a dictionary.
    """
    tables = {str: _TEXT, list: _LIST, lists: _LIST, tuple: _TUPLE, dict: _DICT, dicts: _DICT}
    function = tables.get(type(value), {}).get(name)
    if function is None:
        return None

    def bound(*arguments: Any, **options: Any) -> Any:
        return function(value, *arguments, **options)

    return bound
