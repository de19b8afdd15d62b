"""axe-core on an open page, out of an installed package whose own module is not loaded."""

from importlib.util import find_spec
from pathlib import Path

import pytest

VIOLATIONS = """axe.run(document, {resultTypes: ["violations"]}).then(({violations}) =>
    violations.map(({id, nodes}) => [id, nodes.length, nodes[0].target, nodes[0].failureSummary]))
"""
LOOKS = pytest.mark.parametrize(
    "look",
    [{}, {"dark": True}, {"width": 360, "height": 20000}],
    ids=["light", "dark", "phone"],
)


def axe():
    """The checker's script."""
    package = find_spec("axe_playwright_python")
    if package is None:
        pytest.fail("axe-core is not installed: pip install -e '.[test]' brings it.")
    return (Path(package.origin).parent / "axe.min.js").read_text(encoding="utf-8")


def violations(browser, path, **look):
    """What axe finds on a page without charts, every fold of it open."""
    browser.open(path, **look)
    browser.evaluate("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    browser.evaluate(axe() + "; 0")
    return browser.evaluate(VIOLATIONS)
