"""The arguments of ``omegadot engines``."""

from __future__ import annotations

from omegadot.commands.options import Adapters, Format, Output


def engines(
    output: Output = Format.text,
    adapters: Adapters = None,
) -> None:
    """List the engines: installed or not, versions, integrators, conventions, what is off."""
    from omegadot.commands.engines.engines import engines as installed_engines
    from omegadot.commands.engines.print_engines import print_json, print_text

    entries = installed_engines(adapters or ())
    if output is Format.json:
        print_json(entries)
    else:
        print_text(entries)
