"""Records that cost little to define: `NamedTuple`, `dataclass` and what goes with them.

A run loads hundreds of record classes and uses a part of them. The library compiles the functions
of each when it is defined, which takes longer than the analysis of a small mechanism. Here a class
gets its constructor, compiled for its fields, when the first instance is made; all else is shared.
To type checkers, and in what they mean, they are those of the library; its own `replace`, `fields`
and `asdict` take these records, too.
"""

from __future__ import annotations

TYPE_CHECKING = False  # typing is not loaded for its flag alone
if TYPE_CHECKING:
    from dataclasses import (
        asdict as asdict,
        dataclass as dataclass,
        field as field,
        fields as fields,
        is_dataclass as is_dataclass,
        replace as replace,
    )
    from typing import NamedTuple as NamedTuple
else:
    from _collections import _tuplegetter
    from operator import attrgetter

    class _Tuple(tuple):
        """What all named tuples share."""

        __slots__ = ()
        _fields = ()
        _field_defaults = {}  # noqa: RUF012

        def __new__(cls, /, *args, **named):
            """Compiles the constructor of a class and puts it in this one's place."""
            owner = next(base for base in cls.__mro__ if "_fields" in vars(base))
            names = owner._fields
            text = f"lambda _cls, {', '.join(names)}: _new(_cls, ({', '.join(names)},))"
            made = eval(text if names else "lambda _cls: _new(_cls, ())", {"_new": tuple.__new__})
            made.__name__, made.__qualname__ = "__new__", f"{owner.__qualname__}.__new__"
            made.__defaults__ = tuple(owner._field_defaults.values())
            owner.__new__ = made
            return made(cls, *args, **named)

        @classmethod
        def _make(cls, values):
            found = tuple.__new__(cls, values)
            if len(found) != len(cls._fields):
                raise TypeError(f"Expected {len(cls._fields)} arguments, got {len(found)}")
            return found

        def _replace(self, /, **changes):
            found = self._make(map(changes.pop, self._fields, self))
            if changes:
                raise ValueError(f"Got unexpected field names: {list(changes)!r}")
            return found

        def _asdict(self):
            return dict(zip(self._fields, self, strict=True))

        def __repr__(self):
            parts = map("{}={!r}".format, self._fields, self)
            return f"{type(self).__name__}({', '.join(parts)})"

        def __getnewargs__(self):
            return tuple(self)

    class _TupleMaker(type):
        """Makes `class Name(NamedTuple)` a class of tuples with names."""

        def __new__(cls, name, bases, body):
            fields = tuple(body.get("__annotations__", ()))
            defaults = {one: body[one] for one in fields if one in body}
            if tuple(defaults) != fields[len(fields) - len(defaults) :]:
                raise TypeError(f"{name}: a field without a default follows one with a default")
            body.update({one: _tuplegetter(place, None) for place, one in enumerate(fields)})
            body.update(
                __slots__=(), _fields=fields, _field_defaults=defaults, __match_args__=fields
            )
            return type.__new__(type, name, (_Tuple,), body)

    class _NamedTuple:
        def __mro_entries__(self, bases):
            return (_Stand,)

    _Stand = type.__new__(_TupleMaker, "NamedTuple", (), {})
    NamedTuple = _NamedTuple()

    _MISSING = object()

    class _Field:
        """A field of a dataclass."""

        __slots__ = ("compare", "default", "default_factory", "init", "name", "repr")

        def __init__(self, default, default_factory, init, repr, compare):
            self.name = ""
            self.default = default
            self.default_factory = default_factory
            self.init = init
            self.repr = repr
            self.compare = compare

    class _LibraryFields:
        """The fields as the library's own functions want them, made when one of them asks."""

        def __get__(self, record, owner):
            from dataclasses import field as declared, make_dataclass

            names = ("default", "default_factory", "init", "repr", "compare")
            made = []
            for one in owner._record_fields.values():
                given = {name: getattr(one, name) for name in names}
                known = {name: value for name, value in given.items() if value is not _MISSING}
                made.append((one.name, object, declared(**known)))
            shadow = make_dataclass(owner.__name__, made, init=False, repr=False, eq=False)
            owner.__dataclass_fields__ = shadow.__dataclass_fields__
            return owner.__dataclass_fields__

    def field(*, default=_MISSING, default_factory=_MISSING, init=True, repr=True, compare=True):
        """A field with more to it than a default."""
        return _Field(default, default_factory, init, repr, compare)

    def fields(record):
        """The fields of a dataclass or of an instance."""
        return tuple(record._record_fields.values())

    def is_dataclass(value):
        """Whether a value is a dataclass or an instance of one."""
        return hasattr(value, "_record_fields")

    def asdict(value):
        """The record as a dictionary, and those in it."""
        return {one.name: _plain(getattr(value, one.name)) for one in fields(value)}

    def _plain(value):
        if is_dataclass(value):
            return asdict(value)
        if isinstance(value, dict):
            return {key: _plain(one) for key, one in value.items()}
        return type(value)(map(_plain, value)) if type(value) in (list, tuple) else value

    def replace(record, /, **changes):
        """The record with other values in some fields."""
        for one in record._record_fields.values():
            if one.init:
                if one.name not in changes:
                    changes[one.name] = getattr(record, one.name)
            elif one.name in changes:
                raise ValueError(f"field {one.name} is declared with init=False")
        return type(record)(**changes)

    def dataclass(cls=None, /, *, frozen=False, eq=True, repr=True, slots=False):
        """Makes a class a record of its annotated fields."""
        if cls is None:
            return lambda cls: dataclass(cls, frozen=frozen, eq=eq, repr=repr, slots=slots)
        found = dict(getattr(cls, "_record_fields", ()))
        body = cls.__dict__
        own = [
            name
            for name, kind in body.get("__annotations__", {}).items()
            if not str(kind).startswith(("ClassVar", "typing.ClassVar"))
        ]
        for name in own:
            given = body.get(name, _MISSING)
            one = given if isinstance(given, _Field) else _Field(given, _MISSING, True, True, True)
            one.name = name
            found[name] = one
            if given is not one:
                continue
            if one.default is _MISSING:
                delattr(cls, name)
            else:
                setattr(cls, name, one.default)
        if slots:
            cls = _slotted(cls, own, frozen)
        body = cls.__dict__
        cls._record_fields, cls.__dataclass_fields__ = found, _LibraryFields()
        cls.__match_args__ = tuple(one.name for one in found.values() if one.init)
        if "__init__" not in body:
            _add_init(cls, found, frozen)
        if repr and "__repr__" not in body:
            cls.__repr__ = _repr
        if eq and "__eq__" not in body:
            _add_equality(cls, found, frozen)
        if frozen:
            _freeze(cls, frozenset(found))
        return cls

    def _slotted(cls, own, frozen):
        body = {name: value for name, value in vars(cls).items() if name not in own}
        body.pop("__dict__", None)
        body.pop("__weakref__", None)
        body["__slots__"] = tuple(own)
        if frozen:
            body["__getstate__"], body["__setstate__"] = _state, _set_state
        made = type(cls)(cls.__name__, cls.__bases__, body)
        made.__qualname__ = cls.__qualname__
        return made

    def _add_init(cls, found, frozen):
        def first(self, /, *args, **named):
            made = _compiled_init(cls, found, frozen)
            made.__qualname__ = f"{cls.__qualname__}.__init__"
            cls.__init__ = made
            made(self, *args, **named)

        cls.__init__ = first

    def _compiled_init(cls, found, frozen):
        """The constructor as one would write it by hand."""
        known = {"_set": object.__setattr__, "_missing": _MISSING}
        head, lines = ["self"], []
        for name, one in found.items():
            value = name
            if one.default_factory is not _MISSING:
                known[f"_make_{name}"] = one.default_factory
                value = f"_make_{name}()"
                if one.init:
                    head.append(f"{name}=_missing")
                    value = f"{value} if {name} is _missing else {name}"
            elif not one.init:
                continue  # its default stands in the class
            elif one.default is _MISSING:
                head.append(name)
            else:
                known[f"_default_{name}"] = one.default
                head.append(f"{name}=_default_{name}")
            lines.append(f"_set(self, {name!r}, {value})" if frozen else f"self.{name} = {value}")
        if hasattr(cls, "__post_init__"):
            lines.append("self.__post_init__()")
        exec(f"def __init__({', '.join(head)}):\n " + "\n ".join(lines or ["pass"]), known)
        return known["__init__"]

    def _repr(self):
        parts = [f"{one.name}={getattr(self, one.name)!r}" for one in fields(self) if one.repr]
        return f"{type(self).__qualname__}({', '.join(parts)})"

    def _add_equality(cls, found, frozen):
        names = [one.name for one in found.values() if one.compare]
        if len(names) > 1:
            values = attrgetter(*names)
        else:

            def values(self):
                return tuple(getattr(self, name) for name in names)

        def equal(self, other):
            return values(self) == values(other) if type(other) is type(self) else NotImplemented

        def hashed(self):
            return hash(values(self))

        cls.__eq__ = equal
        if "__hash__" not in vars(cls):
            cls.__hash__ = hashed if frozen else None

    def _freeze(cls, names):
        def refuse(self, name):
            if type(self) is cls or name in names:
                from dataclasses import FrozenInstanceError

                raise FrozenInstanceError(f"cannot change field {name!r}")

        def set_field(self, name, value):
            refuse(self, name)
            super(cls, self).__setattr__(name, value)

        def delete_field(self, name):
            refuse(self, name)
            super(cls, self).__delattr__(name)

        cls.__setattr__, cls.__delattr__ = set_field, delete_field

    def _state(self):
        return [getattr(self, name) for name in self._record_fields]

    def _set_state(self, state):
        for name, value in zip(self._record_fields, state, strict=True):
            object.__setattr__(self, name, value)
