"""The table of engines as shipped."""

from __future__ import annotations

import json

from omegadot.adapters.protocol import mends
from omegadot.reports.shipped.figures import Figures, restored, stored
from omegadot.reports.shipped.rows import ShippedRow, middle, scenario_of
from omegadot.reports.shipped.sentence import in_one_sentence
from omegadot.reports.shipped.table import cells, heads
from omegadot.reports.shipped.table import mends as mending
from omegadot.reports.summary.flips import Flip, Flips

EXACT = (1.0, 3.0, 5.0)


def row(**more: object) -> ShippedRow:
    """An engine of which one setting mends, and another does next to nothing."""
    known = {
        "physics": Figures("ok", EXACT, 8.0, 1e-4, 0.1, 0.05),
        "as_shipped": Figures("ok", (), 8.0, 0.55, 3.1, 2.0),
        "settings": {
            "sleep": Figures("ok", (), 8.0, 0.55, 3.1, 1.999),
            "gyroscopic": Figures("ok", (1.0, 4.5), 8.0, 0.55, 3.12, 1.5),
        },
        "exact_flips": Flips(tuple(Flip(time - 0.3, time, time + 0.3) for time in EXACT), 8.0),
    }
    base = ("t-handle", "jolt", "step", 0.01, None)
    return ShippedRow(*base, **{**known, **more})  # type: ignore[arg-type]


def test_what_mends_most_is_by_the_mean_and_not_by_the_end() -> None:
    assert row().mends_most == ("gyroscopic", 0.75)
    assert mending(row()) == "gyroscopic: error × 0.75, flips late"
    without = row(settings={"sleep": Figures("ok", (), 8.0, 0.55, 3.0, 1.999)})
    assert without.mends_most is None
    assert mending(without) == "none of 1"
    assert mending(row(settings={})) == "–"
    assert mending(row(settings={"sleep": Figures("crashed")})) == "none of 1"
    assert mending(row(physics=row().as_shipped, settings={})) == "nothing: both are alike"


def test_the_table_has_a_row_that_never_flips() -> None:
    both = row()
    assert heads([both])[2:4] == ("flips, as shipped", "flips, physics")
    (found,) = cells([both])
    assert found[:4] == ("jolt", "step", "never flips", "flips in time: 1, 3, 5 s")
    assert found[4:6] == ("55 %", "0.01 %")
    assert ", 1 never flips; set up for physics 1 flips in time." in in_one_sentence((both,))
    elsewhere = row(exact_flips=None)
    assert not any("flips" in head for head in heads([elsewhere]))
    assert len(cells([elsewhere])[0]) == len(heads([elsewhere]))
    assert cells([row(as_shipped=Figures("timeout"))])[0][2] == "timeout"
    assert cells([row(as_shipped=Figures("ok", until=0.5))])[0][2] == "–"


def test_an_engine_counts_by_its_worst_integrator() -> None:
    late = Figures("ok", (1.0, 4.5), 8.0, 0.55, 3.1, 2.0)
    changes = ({}, {"as_shipped": late}, {"as_shipped": late}, {"as_shipped": Figures("timeout")})
    names = ("a", "a", "b", "c")
    rows = tuple(
        ShippedRow(**{**vars(row(**more)), "engine": name})
        for name, more in zip(names, changes, strict=True)
    )
    counted = (
        "1 never flips, 1 flips late and 1 without an answer; set up for physics 3 flip in time"
    )
    assert f": of 3 engines, by the worst integrator, {counted}." in in_one_sentence(rows)


def test_what_is_stored_tells_late_from_never_again() -> None:
    for flips, expected in (((), "never"), ((1.0, 4.5), "late"), (EXACT, "yes")):
        figures = Figures("ok", flips, 8.0, 0.5, 3.1, 2.0)
        again = restored(json.loads(json.dumps(stored(figures))))
        assert again == figures
        assert row().flipping(again) == expected


def test_integrators_that_do_the_same_share_a_row() -> None:
    other = ShippedRow(**{**vars(row()), "integrator": "other"})
    assert [found[1] for found in cells([row(), other])] == ["step, other"]
    assert in_one_sentence(()) == ""


def test_rows_that_flip_otherwise_or_never_come_first() -> None:
    same = row(physics=row().as_shipped, settings={})
    less, more = (
        row(as_shipped=Figures("ok", EXACT, 8.0, 0.5, 0.2, mean), settings={})
        for mean in (0.1, 0.2)
    )
    flips = Figures("ok", EXACT, 8.0, 0.5, 0.2, 0.1)
    alike = row(as_shipped=flips, physics=flips, settings={})
    named = {"alike": alike, "same": same, "less": less, "more": more, "otherwise": row()}
    rows = tuple(ShippedRow(**{**vars(one), "engine": name}) for name, one in named.items())
    assert [found[0] for found in cells(rows)] == ["otherwise", "same", "more", "less", "alike"]
    assert in_one_sentence(rows).endswith("What mends most: otherwise gyroscopic, error × 0.75.")


def test_the_middle_and_the_scenario_of_the_table() -> None:
    assert middle([0.02, 0.005, 0.01]) == 0.01
    assert middle([0.02, 0.01]) == 0.02
    assert scenario_of(["sphere", "t-handle"]) == "t-handle"
    assert scenario_of(["sphere", "brick"]) == "sphere"


def test_a_default_is_mended_for_physics_and_by_its_own_name() -> None:
    assert mends("physics", "damping")
    assert mends("as-shipped+damping", "damping")
    assert not mends("as-shipped", "damping")
    assert not mends("as-shipped+angular-damping", "damping")
