"""Bodies through an engine's own reader of files: sound ones are held, misread ones are caught."""

from __future__ import annotations

import re
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from mujoco_cases import INERTIAS, LOADS, OFFSET, system

from omegadot.adapters import body_files
from omegadot.adapters.dart import model as dart_model
from omegadot.adapters.mujoco import importer as mujoco_importer
from omegadot.adapters.pinocchio import model as pinocchio_model
from omegadot.adapters.protocol import Adapter, Format, UnsupportedError
from omegadot.adapters.registry import BUILT_IN, build_adapter
from omegadot.gates.bounds.scales import EPS, ROUNDINGS_OF_A_READER, ROUNDINGS_PER_EVALUATION
from omegadot.gates.rows import Row
from omegadot.gates.states.equation import forward_rows, random_states
from omegadot.gates.states.model import body_rows, of_read_body
from omegadot.reference_impl.system import State, System

Misread = Callable[[str], str]
READERS: list[tuple[str, Format]] = [
    *(("mujoco", "urdf"), ("mujoco", "mjcf")),
    *(("pinocchio", "urdf"), ("pinocchio", "mjcf")),
    ("dart", "urdf"),
]
WRITERS = {"mujoco": mujoco_importer, "pinocchio": pinocchio_model, "dart": dart_model}
T_HANDLE = System((system("flat", center=np.zeros(3)).body,))
BODIES = {
    "t-handle": T_HANDLE,
    "full tensor": system("full", center=np.zeros(3)),
    "offset": system("diagonal"),
    "full and offset": system("full"),
    "top": system("diagonal", "pivot_gravity"),
    "full on a pivot": system("full", "pivot_all"),
}
# The tensors differ by a reader's roundings; the condition number is below 10, and a body turns by
# less than 100 rad.
SAME = (ROUNDINGS_OF_A_READER + ROUNDINGS_PER_EVALUATION) * EPS * 10 * 100
NUMBER = r"-?\d+(?:\.\d+)?(?:e[-+]\d+)?"


def adapter(engine: str, via: Format) -> Adapter:
    return build_adapter(BUILT_IN[engine], "physics", via)


def case(of: System) -> Any:
    q, some = np.array([1.0, 0.0, 0.0, 0.0]), np.array([1.0, 2.0, -0.5])
    return SimpleNamespace(system=of, initial=State(q, some, some, some))


def rows_of(loaded: Adapter, of: System) -> list[Row]:
    """The model gate, and the equation gate at random states."""
    many = random_states(case(of), 20, (1,))
    found = body_rows(case(of), loaded.model()[0])
    found += forward_rows(of, many, loaded.forward_dynamics(many), "residual")
    return [of_read_body(row) for row in found]


@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize(("engine", "via"), READERS)
def test_every_reader_holds_the_body_that_was_written(engine: str, via: Format, name: str) -> None:
    of, loaded = BODIES[name], adapter(engine, via)
    loaded.load(of)
    for row in rows_of(loaded, of):
        assert row.verdict == "pass", row


@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize(("engine", "via"), READERS)
def test_the_loads_act_on_a_body_that_was_read(engine: str, via: Format, load: str) -> None:
    of, loaded, plain = system(load=load), adapter(engine, via), build_adapter(BUILT_IN[engine])
    loaded.load(of)
    plain.load(of)
    assert all(row.verdict == "pass" for row in rows_of(loaded, of))
    start = random_states(case(of), 1, (2,))[0]
    for integrator in plain.description.integrators:
        one = loaded.run(start, integrator.name, 0.01, 20, 20).state
        other = plain.run(start, integrator.name, 0.01, 20, 20).state
        for ours, theirs in zip(vars(one).values(), vars(other).values(), strict=True):
            assert np.max(np.abs(ours - theirs)) <= SAME * np.max(np.abs(theirs))


def _products(change: Callable[[dict[str, str]], dict[str, str]]) -> Misread:
    """A reader that takes the products of inertia wrongly, of a URDF or of a full tensor."""

    def misread(text: str) -> str:
        def of_urdf(found: re.Match[str]) -> str:
            xy, xz, yz = (found[name] for name in ("xy", "xz", "yz"))
            new = change({"xy": xy, "xz": xz, "yz": yz})
            return found[0].replace(f'"{xy}"', f'"{new["xy"]}"', 1).replace(
                f'ixz="{xz}"', f'ixz="{new["xz"]}"'
            ).replace(f'iyz="{yz}"', f'iyz="{new["yz"]}"')  # fmt: skip

        def of_mjcf(found: re.Match[str]) -> str:
            *moments, xy, xz, yz = found[1].split()
            new = change({"xy": xy, "xz": xz, "yz": yz})
            return f'fullinertia="{" ".join([*moments, new["xy"], new["xz"], new["yz"]])}"'

        pattern = r'<inertia .*ixy="(?P<xy>\S+)" ixz="(?P<xz>\S+)".*iyz="(?P<yz>\S+)".*/>'
        return re.sub(r'fullinertia="([^"]*)"', of_mjcf, re.sub(pattern, of_urdf, text))

    return misread


def _numbers(change: Callable[[float], float], attribute: str = r"\w+") -> Misread:
    """A reader that changes every number of some attributes."""
    names = rf'\b({attribute})="((?:{NUMBER} ?)+)"'

    def changed(found: re.Match[str]) -> str:
        values = " ".join(repr(float(change(float(x)))) for x in found[2].split())
        return f'{found[1]}="{values}"'

    return lambda text: re.sub(names, changed, text)


def _order(attribute: str, order: tuple[int, ...]) -> Misread:
    """A reader that takes the numbers of an attribute in another order."""

    def changed(found: re.Match[str]) -> str:
        values = found[1].split()
        return f'{attribute}="{" ".join(values[n] for n in order)}"'

    return lambda text: re.sub(rf'\b{attribute}="([^"]*)"', changed, text)


BY_URDF: dict[str, Misread] = {
    "the inertial frame's rotation is ignored": _numbers(lambda _: 0.0, "rpy"),
    "its rotation is inverted": _numbers(lambda x: -x, "rpy"),
    "its angles are taken in degrees": _numbers(np.deg2rad, "rpy"),
    "roll and yaw are exchanged": _order("rpy", (2, 1, 0)),
    "products of inertia are dropped": _products(lambda p: dict.fromkeys(p, "0.0")),
    "products of inertia are negated": _products(
        lambda p: {name: repr(-float(value)) for name, value in p.items()}
    ),
    "xy and yz are exchanged": _products(lambda p: {**p, "xy": p["yz"], "yz": p["xy"]}),
    "the mass is rounded to six digits": _numbers(lambda x: float(f"{x:.6g}"), "value"),
    "the centre of mass is ignored": _numbers(lambda _: 0.0, "xyz"),
    "the centre of mass is mirrored": _numbers(lambda x: -x, "xyz"),
    "numbers are kept in single precision": _numbers(lambda x: float(np.float32(x))),
}
BY_MJCF: dict[str, Misread] = {
    "products of inertia are dropped": BY_URDF["products of inertia are dropped"],
    "products of inertia are negated": BY_URDF["products of inertia are negated"],
    "xy and yz are exchanged": BY_URDF["xy and yz are exchanged"],
    "the mass is rounded to six digits": _numbers(lambda x: float(f"{x:.6g}"), "mass"),
    "numbers are kept in single precision": BY_URDF["numbers are kept in single precision"],
}
BY_AXES: dict[str, Misread] = {
    "the inertial frame's rotation is ignored": lambda text: re.sub(r'quat="[^"]*" ', "", text),
    "its quaternion is taken for x, y, z, w": _order("quat", (3, 0, 1, 2)),
    "its moments are sorted": _order("diaginertia", (2, 1, 0)),
}
AWKWARD = 1.0 + 1.0 / 3.0  # kg, a mass of many digits


def caught(
    engine: str, via: Format, of: System, misread: Misread, monkeypatch: pytest.MonkeyPatch
) -> bool:
    """Whether the engine refuses the body that it misreads, or the model gate fails."""
    writer = getattr(body_files, f"{via}_of")
    module = WRITERS[engine]
    monkeypatch.setattr(module, f"{via}_of", lambda *given: misread(writer(*given)))
    loaded = adapter(engine, via)
    try:
        loaded.load(of)
    except UnsupportedError:
        return True
    rows = [of_read_body(row) for row in body_rows(case(of), loaded.model()[0])]
    return any(row.verdict == "fail" for row in rows)


@pytest.mark.parametrize("fault", BY_URDF)
@pytest.mark.parametrize("engine", WRITERS)
@pytest.mark.parametrize("load", ["none", "pivot"])
def test_a_faulty_reader_of_urdf_is_caught(
    monkeypatch: pytest.MonkeyPatch, engine: str, load: str, fault: str
) -> None:
    of = system("full", load, mass=AWKWARD)
    assert caught(engine, "urdf", of, BY_URDF[fault], monkeypatch)


@pytest.mark.parametrize("fault", BY_MJCF)
@pytest.mark.parametrize("engine", ["mujoco", "pinocchio"])
def test_a_faulty_reader_of_mjcf_is_caught(
    monkeypatch: pytest.MonkeyPatch, engine: str, fault: str
) -> None:
    of = system("full", mass=AWKWARD)
    assert caught(engine, "mjcf", of, BY_MJCF[fault], monkeypatch)


@pytest.mark.parametrize("fault", BY_AXES)
@pytest.mark.parametrize("engine", ["mujoco", "pinocchio"])
def test_a_faulty_reader_of_principal_axes_is_caught(
    monkeypatch: pytest.MonkeyPatch, engine: str, fault: str
) -> None:
    assert caught(engine, "mjcf", system("full", "pivot"), BY_AXES[fault], monkeypatch)


@pytest.mark.parametrize(("engine", "via"), READERS)
def test_a_rotation_that_is_ignored_shows_on_a_diagonal_tensor(
    monkeypatch: pytest.MonkeyPatch, engine: str, via: Format
) -> None:
    faults = BY_URDF if via == "urdf" else BY_AXES
    fault = faults["the inertial frame's rotation is ignored"]
    assert caught(engine, via, T_HANDLE, fault, monkeypatch)


@pytest.mark.parametrize(("engine", "via"), READERS)
def test_nothing_is_caught_where_nothing_is_misread(
    monkeypatch: pytest.MonkeyPatch, engine: str, via: Format
) -> None:
    assert not caught(engine, via, system("full", mass=AWKWARD), lambda text: text, monkeypatch)


@pytest.mark.parametrize("inertia", INERTIAS)
def test_numbers_are_written_in_full(inertia: str) -> None:
    of = system(inertia, mass=AWKWARD)
    for text in (body_files.urdf_of(of, np.zeros(3)), body_files.mjcf_of(of)):
        assert repr(AWKWARD) in text
        assert " ".join(map(repr, OFFSET.tolist())) in text


def test_a_format_without_a_reader_is_refused() -> None:
    with pytest.raises(UnsupportedError, match=r"dart .* has no reader of mjcf; it reads urdf"):
        adapter("dart", "mjcf")
    with pytest.raises(UnsupportedError, match=r"reference .* reads no such files"):
        adapter("reference", "urdf")


def test_mujoco_s_refusal_of_a_file_is_its_reason() -> None:
    """A flat body in turned axes breaks MuJoCo's triangle inequality by one rounding."""
    with pytest.raises(UnsupportedError, match=r"MuJoCo refuses the mjcf .* A \+ B >= C"):
        adapter("mujoco", "mjcf").load(system("flat_turned"))
