"""Templates, style and script of the page."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from functools import cache, lru_cache
from importlib.resources import files
from typing import Any

from jinja2 import Environment, PackageLoader
from markupsafe import Markup, escape

from omegadot.reports.page.glossary import linked
from omegadot.reports.page.tables import Table, unit_text
from omegadot.reports.text.engine_version import version_text
from omegadot.reports.text.numbers import knob, short
from omegadot.written import written

# One idea a file; later files use what earlier ones define.
SCRIPTS = (
    *("unpack", "written", "copying", "cards", "tables"),
    *("looks", "lines", "deviations", "sweeps", "equation", "linked", "report", "scenarios"),
)


def shown(value: Any) -> Any:
    """A text without the ``https`` of its addresses: they are named, and nothing is fetched.

    Units are written as the page writes them: rad/s² for rad/s^2.
    """
    if not isinstance(value, str) or isinstance(value, Markup):
        return value
    if "://" in value:
        value = re.sub(r"https?://", "", value, flags=re.IGNORECASE)
    return re.sub(r"(?<=/s)\^2(?!\w)", "²", value) if "/s^2" in value else value


@lru_cache(maxsize=65536)
def _cell(text: str) -> str:
    return str(escape(shown(text)))


@lru_cache(maxsize=65536)
def _figure(text: str) -> str:
    return _cell(kept(text))


def table_body(table: Table, named: bool = False) -> Markup:
    """The rows of a table of many cells, escaped as the templates do it, in a tenth of the time.

    named: each cell bears the head of its column, for a narrow screen without a row of heads.
    """
    names = [f' data-head="{_cell(title)}"' if named else "" for title in table.columns]
    lines = []
    for row in table.rows:
        source = "" if row.source is None else f' data-source="{row.source}"'
        heads = [f'<th scope="row">{_cell(head)}' for head in row.heads]
        cells = [
            f'<td{name} class="v-{_cell(value.mark)}">{_figure(value.text)}'
            if value.mark
            else f"<td{name}>{_figure(value.text)}"
            for name, value in zip(names, row.values, strict=True)
        ]
        lines.append(f"<tr{source}>{''.join(heads)}{''.join(cells)}\n")
    return Markup("".join(lines))


def unbroken(text: str) -> str:
    """The text with its exponents kept on one line: ``1e-10`` could break at the hyphen."""
    return re.sub(r"(?<=\de)-(?=\d)", "-\u2060", text)


def kept(text: str) -> str:
    """The text with each number on one line, its exponent and its unit included."""
    return re.sub(r"(?<=\d) (?=(?:s|rad|m|µs|×)(?![\w-]))", "\u00a0", unbroken(text))


def arguments(command: str) -> Markup:
    """A command that breaks between its arguments and not within, at the hyphens of an option."""
    whole = Markup('<span class="argument">{}</span>')
    parts = (whole.format(part) if "-" in part else escape(part) for part in command.split(" "))
    return Markup(" ").join(parts)


def coded(text: str) -> Markup:
    """A text in which names stand in backticks, as code."""
    parts = text.split("`")
    code = Markup("<code>{}</code>")
    return Markup("").join(code.format(p) if k % 2 else escape(p) for k, p in enumerate(parts))


def _knob_of(row: Mapping[str, Any]) -> str:
    return knob(row["timestep"], row["accuracy"])


@cache
def environment() -> Environment:
    """The page's templates: everything escaped, no address active."""
    found = Environment(
        loader=PackageLoader("omegadot.reports.page"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=shown,
    )
    found.filters |= {"short": short, "unit": unit_text, "unbroken": unbroken, "kept": kept}
    found.filters |= {"arguments": arguments, "coded": coded, "version": version_text}
    found.filters |= {"written": written, "body": table_body, "linked": linked, "knob": _knob_of}
    return found


def asset(name: str) -> Markup:
    """The page's own style or script."""
    path = files("omegadot.reports.page").joinpath("templates", name)
    return Markup(path.read_text(encoding="utf-8"))


def script(names: Iterable[str] = SCRIPTS) -> Markup:
    """The page's own script: its files in their order, in one scope of their own."""
    parts = (asset(f"{name}.js") for name in names)
    return Markup('"use strict";\n(() => {{\n{}}})();\n').format(Markup("").join(parts))
