"""Templates, style and script of the page, and the chart library that goes into it."""

from __future__ import annotations

import re
from functools import cache
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader
from markupsafe import Markup

from omegadot.reports.numbers import knob, short
from omegadot.reports.packing import pack
from omegadot.reports.tables import unit_text


def without_scheme(value: Any) -> Any:
    """A text without the ``https`` of its addresses: they are named, and nothing is fetched."""
    if isinstance(value, str) and "://" in value and not isinstance(value, Markup):
        return re.sub(r"https?://", "", value, flags=re.IGNORECASE)
    return value


def unbroken(text: str) -> str:
    """The text with its exponents kept on one line: ``1e-10`` may else part at the hyphen."""
    return re.sub(r"(?<=\de)-(?=\d)", "-\u2060", text)


@cache
def environment() -> Environment:
    """The page's templates: everything escaped, no address active."""
    found = Environment(
        loader=PackageLoader("omegadot.reports"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=without_scheme,
    )
    found.filters["short"] = short
    found.filters["knob"] = lambda row: knob(row["timestep"], row["accuracy"])
    found.filters["unit"] = unit_text
    found.filters["unbroken"] = unbroken
    return found


def asset(name: str) -> Markup:
    """The page's own style or script."""
    path = files("omegadot.reports").joinpath("templates", name)
    return Markup(path.read_text(encoding="utf-8"))


@cache
def plotly() -> str:
    """Plotly's own script, out of the installed package, packed."""
    return pack(files("plotly").joinpath("package_data", "plotly.min.js").read_bytes())
