"""What is named on one scenario, beside what is named on the others that fail."""

from types import SimpleNamespace
from typing import Any

from omegadot.diagnosis.diagnose import Causes
from omegadot.diagnosis.reported.requests import AGAIN
from omegadot.diagnosis.wording.among_others import beside_others, of_few

LATE = "each interval between samples is one step shorter than requested"
STILL = "none is known; omega is off"


def test_a_cause_that_few_of_the_failing_scenarios_show_is_what_is_seen_there() -> None:
    # An engine whose slow bodies sleep looks on some scenarios as if a step were missing.
    seen = f"none is known; on 2 of the 5 scenarios that fail it is as if {LATE}"
    assert of_few(LATE, [LATE, STILL, STILL, ""]) == seen
    assert of_few(LATE, [LATE, STILL, ""]) == LATE  # half of them
    assert of_few(LATE, []) == LATE
    assert of_few(STILL, [LATE, LATE]) == STILL


def test_that_something_is_left_over_contradicts_nothing_that_says_what() -> None:
    taken = "the first step of a run takes the omega-dot at the end of the run before"
    general = [*AGAIN.values()]
    assert of_few(taken, general) == taken
    assert [of_few(one, [taken, taken, taken]) for one in general] == general
    assert of_few(taken, [f"{AGAIN['reloaded']}: the mass", f"{AGAIN['reloaded']}: the mass"]) != (
        taken
    )


def test_one_cause_with_other_numbers_and_conditions_is_the_same() -> None:
    limited = "the damping is limited to 10 N m s/rad"
    others = (
        "in the steps, the damping is limited to 9.9 N m s/rad, but not always",
        "the damping is limited to 9 N m s/rad (heavy-top; other numbers on 3 more)",
        f"either {limited}, or the torque is",
        f"{limited}, but only where the body is pivoted",
    )
    assert of_few(limited, ["", *others, "", "", ""]) == limited
    assert of_few(limited, ["", *others, "", "", "", "", ""]) != limited


def test_one_convention_at_the_start_and_of_states_that_are_read_back_is_one_cause() -> None:
    """Caught: a convention that all scenarios show, called one of few by how it shows."""
    read = "attitudes are read out of a rotation matrix"
    begins = f"a run begins at another attitude: {read}, and is sound from there"
    assert of_few(f"{read}, as a state is set or read back", [begins] * 3).startswith(read)
    assert of_few(begins, [f"{read}, as a state is set or read back"] * 3) == begins


def test_the_cause_of_most_other_scenarios_stands_before_what_is_only_seen() -> None:
    named, seen = "gravity is scaled by 2", "none is known; omega-dot is off"
    assert (
        beside_others(seen, [named, named, seen]) == f"on 2 other scenarios: {named}; here: {seen}"
    )
    assert beside_others("", [named]) == f"on 1 other scenario: {named}"
    assert beside_others(seen, [named, seen]) == seen  # as many name nothing
    assert beside_others(seen, [named, "damping is ignored", seen]) == seen
    assert beside_others("", []) == ""


def shown(text: str, made: bool) -> Any:
    """A scenario that fails. made: whether the cause of others makes what fails here."""
    return SimpleNamespace(
        fails=lambda integrator: True,
        sentences=lambda integrator: [text] * bool(text),
        siblings_follow=lambda name: made,
        of_forward_dynamics=False,
    )


def test_scenarios_that_fail_with_something_changed_alone_show_the_cause_that_makes_them() -> None:
    """Caught: gravity along -z, called what few show where most scenarios have it along -z."""
    for made in (True, False):
        causes, down = Causes(), "gravity points along -z"
        causes._cases["toy"] = {f"s{k}": shown("", made) for k in range(3)}
        causes._cases["toy"]["tilted"] = shown(down, made)
        found = [causes.text("toy", name, None) for name in causes._cases["toy"]]
        assert (found == [down] * 4) is made
        assert ("on 1 of the 4" in found[-1]) is not made
