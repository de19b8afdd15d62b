"""The one table of units, by another's: pint's, which keeps them to 28 digits."""

from decimal import Decimal

import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from omegadot.commands.units import UNITS, quantity, unit_named
from omegadot.harness.usage import UsageError

EVERY = [(kind, unit) for kind, units in UNITS.items() for unit in units]
BASES = {"time": "s", "angle": "rad", "rate": "rad/s", "length": "m"}
# As pint spells them.
THEIRS = {"rev": "revolution", "rev/s": "revolution/s", "x": "", "1": ""}
EPS = 2.0**-52
SIZES = st.floats(1e-300, 1e300)


@pytest.fixture(scope="module")
def registry() -> pint.UnitRegistry:
    return pint.UnitRegistry(non_int_type=Decimal)


@pytest.mark.parametrize(("kind", "unit"), [pair for pair in EVERY if pair[1] != "ppb"])
def test_every_unit_is_what_pint_takes_it_for(registry, kind, unit):
    """To a rounding of pi and one of the product with it; it has no ppb."""
    theirs = registry.Quantity(Decimal(1), THEIRS.get(unit, unit)).to(BASES.get(kind, ""))
    assert UNITS[kind][unit] == pytest.approx(float(theirs.magnitude), rel=EPS, abs=0.0)


@given(SIZES, st.sampled_from(EVERY), st.sampled_from(["", " ", "  "]))
def test_what_is_written_is_read_back(size, named, blank):
    kind, unit = named
    value = size * UNITS[kind][unit]
    text = f"{size!r}{blank}{unit}" if blank or unit != "1" else repr(size)
    assert quantity(text, kind, "--it") == value
    assert quantity(f" {text} ", kind, "--it", needs_unit=True) == value


@given(SIZES, st.sampled_from(list(UNITS)))
def test_a_bare_number_is_in_si_where_it_may_be(size, kind):
    assert quantity(size, kind, "--it") == quantity(repr(size), kind, "--it") == size
    if "1" in UNITS[kind]:
        assert quantity(size, kind, "--it", needs_unit=True) == size
    else:
        with pytest.raises(UsageError, match="has no unit; write it as"):
            quantity(size, kind, "--it", needs_unit=True)


@pytest.mark.parametrize(
    ("text", "kind", "unit"),
    [
        ("µs", "time", "us"),
        ("μs", "time", "us"),
        ("µrad", "angle", "urad"),
        ("°", "angle", "deg"),
        ("turn", "angle", "rev"),
        ("°/s", "rate", "deg/s"),
        ("×", "factor", "x"),
    ],
)
def test_other_spellings(text, kind, unit):
    assert unit_named(text, kind, "--it") == unit


@given(st.sampled_from(EVERY), st.sampled_from(list(UNITS)))
def test_a_unit_of_something_else_is_refused_in_a_sentence(named, kind):
    _, unit = named
    if unit in UNITS[kind]:
        assert unit_named(unit, kind, "--it") == unit
        return
    with pytest.raises(
        UsageError, match=r"^--it: .* is no unit of an? [a-z ]+; (write|choose) "
    ) as caught:
        unit_named(unit, kind, "--it")
    assert str(caught.value).count(". ") == 0


@pytest.mark.parametrize("text", ["kdeg", "Mrad", "megadegree", "deg*s", "deg s", "rad/s", "DEG"])
def test_what_only_a_registry_would_take_is_refused(text):
    with pytest.raises(UsageError):
        unit_named(text, "angle", "--it")
