"""Parameters of a run as a tree: sections hold keys and further sections."""

from __future__ import annotations

import os
from typing import Any, Dict, Iterator, List, Mapping, Tuple, Union

from . import _core

Value = Union[float, int, bool, str]


def presets() -> Dict[str, str]:
    """Built-in configurations and what each is for; the default stands first."""
    return dict(_core.presets())


class Section:
    """One section of the parameters, such as ``parameters.plates.sphere``.

    Keys are attributes: reading gives the value, writing checks type and range. ``dir`` lists them, ``help`` of a
    value is at ``describe``.
    """

    _configuration: _core.Configuration

    def __init__(self, configuration: _core.Configuration, name: str, names: List[str]):
        prefix = f"{name}." if name else ""
        inside = [full[len(prefix):] for full in names if full.startswith(prefix)]
        object.__setattr__(self, "_configuration", configuration)
        object.__setattr__(self, "_prefix", prefix)
        object.__setattr__(self, "_names", names)
        object.__setattr__(self, "_keys", [word for word in inside if "." not in word])
        object.__setattr__(self, "_sections", list(dict.fromkeys(w.split(".")[0] for w in inside if "." in w)))

    def __getattr__(self, key: str) -> Any:
        if key.startswith("__"):
            raise AttributeError(key)
        if key in self._sections:
            return Section(self._configuration, self._prefix + key, self._names)
        if key in self._keys:
            return self._configuration.get(self._prefix + key)
        raise AttributeError(self._unknown(key))

    def __setattr__(self, key: str, value: Any) -> None:
        if key not in self._keys:
            raise AttributeError(self._unknown(key))
        self._configuration.set(self._prefix + key, value)

    def __dir__(self) -> List[str]:
        return [*self._sections, *self._keys, "describe"]

    def _unknown(self, key: str) -> str:
        if key in self._sections:
            return f"{self._prefix}{key} is a section: set one of its keys"
        try:
            self._configuration.info(self._prefix + key)
        except _core.ConfigurationError as error:
            return str(error)
        return f"{self._prefix}{key}: no such key"

    def __iter__(self) -> Iterator[str]:
        return iter(self._keys)

    def describe(self, key: str) -> _core.ParameterInfo:
        """Unit, range, meaning and source of a key."""
        return self._configuration.info(self._prefix + key)

    def _repr_rows(self) -> List[Tuple[str, Value, str]]:
        rows = []
        for full in self._names:
            if full.startswith(self._prefix):
                info = self._configuration.info(full)
                rows.append((full, self._configuration.get(full), info.units))
        return rows

    def __repr__(self) -> str:
        return "\n".join(f"{name} = {value!r}{'  # ' + units if units not in ('', '1') else ''}"
                         for name, value, units in self._repr_rows())


class Parameters(Section):
    """Every parameter of a run with its value: defaults, then a preset, then a file, then ``values``.

    >>> parameters = terrane.Parameters("earth")
    >>> parameters.erosion.duration_myr = 40
    >>> parameters["plates.sphere.samples"]
    >>> parameters.describe("erosion.duration_myr").units

    A value of the wrong type or out of range raises ``ConfigurationError`` that says what is allowed.
    """

    def __init__(self, preset: str = "", config: Union[str, os.PathLike] = "", dem: Union[str, os.PathLike] = "",
                 values: Mapping[str, Value] = {}):
        configuration = _core.Configuration(preset, os.fspath(config), os.fspath(dem))
        for name, value in values.items():
            configuration.set(name, value)
        super().__init__(configuration, "", configuration.names())

    @classmethod
    def _of(cls, configuration: _core.Configuration) -> "Parameters":
        made = cls.__new__(cls)
        Section.__init__(made, configuration, "", configuration.names())
        return made

    def copy(self) -> "Parameters":
        """The same values, to be changed apart."""
        return Parameters._of(self._configuration.copy())

    def __getitem__(self, name: str) -> Value:
        return self._configuration.get(name)

    def __setitem__(self, name: str, value: Value) -> None:
        self._configuration.set(name, value)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __dir__(self) -> List[str]:
        return [*self._sections, "copy", "describe", "search", "to_toml", "apply_toml"]

    def search(self, *words: str) -> List[_core.ParameterInfo]:
        """Parameters whose name or meaning has all the words."""
        found = []
        for name in self._names:
            info = self._configuration.info(name)
            text = f"{name} {info.doc}".lower()
            if all(word.lower() in text for word in words):
                found.append(info)
        return found

    def to_toml(self) -> str:
        """All values as a configuration file; ``apply_toml`` and the program read it back bit for bit."""
        return self._configuration.to_toml()

    def apply_toml(self, text: str, name: str = "configuration") -> None:
        """Takes values from the text of a configuration file; errors name ``name`` and the line."""
        self._configuration.apply_toml(text, name)
