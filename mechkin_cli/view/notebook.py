"""The page in a notebook: shown in a cell, or as a widget that Python hears and moves.

The widget is one of anywidget, which Jupyter, JupyterLab, VS Code, Colab and marimo show. It is no
more than a few values that both sides have: parameters and row. What the page computes itself is
not computed here; what it cannot reach is, and sent to it.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from mechkin_cli.arguments import Setting
from mechkin_cli.diagnostics import MechkinError, UsageError
from mechkin_cli.view.following import LiveModel
from mechkin_cli.view.page import waiting_page
from mechkin_cli.view.scene import view_data, write_view
from mechkin_cli.view.server import FRAME_RIGHTS, frames_source

if TYPE_CHECKING:
    from os import PathLike

HEIGHT = 640
"""Pixels of a page in a notebook."""


class Page:
    """A page that shows a mechanism in motion; a notebook shows it in its cell.

    Attributes:
        html: its text, which needs nothing else.
    """

    def __init__(self, content: bytes) -> None:
        self.html = content.decode("utf-8")

    def __repr__(self) -> str:
        return f"Page of {len(self.html) / 1000:.0f} kB: write(path) makes a file of it"

    def write(self, path: str | PathLike[str]) -> Path:
        """Writes the page whole or not at all; its path.

        Raises:
            UsageError: it cannot be written there.
        """
        return write_view(path, self.html.encode("utf-8"))

    def _repr_html_(self) -> str:
        style = f"width: 100%; height: {HEIGHT}px; border: 0"
        return (
            f'<iframe title="The mechanism" sandbox="{FRAME_RIGHTS}" style="{style}" '
            f'srcdoc="{escape(self.html)}"></iframe>'
        )


class WidgetModel(LiveModel, Protocol):
    """What a widget asks of its model."""

    def with_parameters(self, parameters: Mapping[str, Setting]) -> WidgetModel:
        """The model with other values of some parameters."""
        ...


def widget_of(model: WidgetModel, run: str | None, mode: str | None, modes: bool) -> Any:
    """A widget that shows the runs of a model.

    Raises:
        UsageError: anywidget is not installed (extra `notebook`), an unknown run or mode.
        InvalidFile: the mechanism cannot be solved as it is driven.
    """
    return _widget_class()(model, run, mode, modes)


@cache
def _widget_class() -> Any:
    try:
        import anywidget
        import traitlets
    except ImportError:
        raise UsageError("a widget needs anywidget: pip install 'mechkin[notebook]'") from None
    base: Any = anywidget.AnyWidget

    class MechanismWidget(base):  # type: ignore[misc]
        """The page of a model, with the values that both sides have.

        Attributes:
            parameters: values by name, in the file's units; some of them may be set alone, and as
                texts with a unit. Those that are written with others follow these until they are
                set themselves.
            row: that is shown, from 0.
            model: the model with these parameters.
        """

        _esm = frames_source("widget.js")
        _css = f".mechkin {{ position: relative; height: {HEIGHT}px; }}"
        parameters = traitlets.Dict().tag(sync=True)
        row = traitlets.Int(0, min=0).tag(sync=True)
        _page = traitlets.Unicode().tag(sync=True)
        _data = traitlets.Unicode().tag(sync=True)
        # parameters that the page itself computes with; it says so when it is there
        _reach = traitlets.List(traitlets.Unicode()).tag(sync=True)

        def __init__(
            self, own: WidgetModel, run: str | None, mode: str | None, modes: bool
        ) -> None:
            self._own, self._wish = own, (run, mode, modes)
            self._drawn = dict(own.parameters)
            self._given: dict[str, float] = {}
            data = self._data_of(own)
            super().__init__(
                parameters=dict(self._drawn), _page=waiting_page().decode("utf-8"), _data=data
            )

        @property
        def model(self) -> WidgetModel:
            """The model with the widget's parameters.

            Raises:
                InvalidFile: what the file says does not hold for these values.
            """
            return self._own.with_parameters(self._given) if self._given else self._own

        def _data_of(self, model: WidgetModel) -> str:
            run, mode, modes = self._wish
            data, _ = view_data(model.analyses(run, mode), modes)
            return data.decode("ascii")

        @traitlets.validate("parameters")  # type: ignore[untyped-decorator, unused-ignore]
        def _checked(self, proposal: Any) -> dict[str, float]:
            values = proposal["value"]
            new = {
                k: v for k, v in values.items() if v != self.parameters.get(k, self._drawn.get(k))
            }
            if not new:
                return {**self._drawn, **self.parameters}
            try:
                found = self._own.with_parameters({**self._given, **new}).parameters
            except MechkinError as error:
                raise traitlets.TraitError(str(error)) from error
            self._given |= {k: found[k] if isinstance(v, str) else float(v) for k, v in new.items()}
            return {**found, **self._given}

        @traitlets.observe("parameters", "_reach")  # type: ignore[untyped-decorator, unused-ignore]
        def _follow(self, _: Any) -> None:
            """Computes here what the page cannot reach."""
            changed = [k for k, v in self.parameters.items() if v != self._drawn[k]]
            if all(name in self._reach for name in changed):
                return
            data = self._data_of(self.model)
            self._drawn = dict(self.parameters)
            self._data = data

    return MechanismWidget
