"""Which column holds what: from texts like ``wx=omega_x`` or ``q=q1,q2,q3,q0``."""

from __future__ import annotations

from collections.abc import Sequence

from omegadot.commands.score.table import Table, TraceError, bare, check_alone, find_column
from omegadot.harness.usage import UsageError, nearest

_TABLE = {
    "t": ("t", "time"),
    "w": ("wx wy wz", "angular velocity"),
    "q": ("qw qx qy qz", "quaternion"),
    "e": ("e1 e2 e3", "Euler angles, in the order of their sequence"),
    "r": ("r11 r12 r13 r21 r22 r23 r31 r32 r33", "rotation matrix, row by row"),
    "p": ("px py pz", "position"),
    "v": ("vx vy vz", "velocity"),
    "a": ("ax ay az", "omega-dot"),
}
GROUPS = {group: tuple(roles.split()) for group, (roles, _) in _TABLE.items()}
MEANING = {group: meaning for group, (_, meaning) in _TABLE.items()}
WHOLE = ("q", "e", "r")
TURNS = {"yaw": "z", "pitch": "y", "roll": "x"}
QUATERNIONS = ("wxyz", "xyzw")
# Found without being named. Not ax, ay, az: in most logs these are a linear acceleration.
KNOWN = {r: r for group in ("t", "w", "q", "e", "r", "p", "v") for r in GROUPS[group]}
KNOWN |= {"time": "t", **{name: name for name in TURNS}}
# What logs call omega. Not gx, gy, gz: these may be gravity.
_SETS = "gyro_{} gyro.{} w_{} omega{} omega_{} omega.{} angular_velocity_{} angular_velocity.{}"
ROLES = (*GROUPS, *KNOWN, *GROUPS["a"])
Columns = dict[str, str]
"""The name of a column by the role that it has."""


def _turn_role(argument: str, euler: str) -> str:
    """e1, e2 or e3 for yaw, pitch or roll: its place in the sequence. Raises UsageError."""
    place = euler.lower().find(TURNS[argument])
    if len(set(euler.lower())) < 3:
        raise UsageError(f"--euler {euler}: has no {argument}; name the angles e1, e2 and e3.")
    return f"e{place + 1}"


def _roles_of(argument: str, count: int, order: str, euler: str) -> tuple[str, ...]:
    """The roles that one name of a ROLE=NAME pair stands for. Raises UsageError."""
    key = argument.lower()
    key = "t" if key == "time" else key
    if key in TURNS:
        key = _turn_role(key, euler)
    if count == 0 and key in (*GROUPS, *ROLES):
        return GROUPS.get(key, (key,))
    if key in GROUPS and count == len(GROUPS[key]):
        return tuple("q" + part for part in order) if key == "q" else GROUPS[key]
    roles = [role for group in GROUPS.values() for role in group]
    if key in roles and count == 1:
        return (key,)
    if key not in GROUPS and key not in roles:
        raise UsageError(f"--column {argument}: there is no such role; {nearest(key, ROLES)}.")
    expected = "one column was expected"
    if key in GROUPS:
        expected = f"{len(GROUPS[key])} columns were expected ({MEANING[key]})"
    raise UsageError(f"--column {argument}: {count} given, {expected}.")


def _omega_names(names: Sequence[str]) -> Columns:
    """The role by the name of each column of omega; none where several sets may be omega."""
    own = GROUPS["w"]
    sets = [dict(zip(map(pattern.format, "xyz"), own, strict=True)) for pattern in _SETS.split()]
    found = [one for one in sets if not one.keys().isdisjoint(names)]
    return found[0] if len(found) == 1 and not set(own) & set(names) else {}


def columns_of(
    table: Table,
    assigned: Sequence[tuple[str, Sequence[str]]],
    order: str,
    euler: str,
    timed: bool = True,
) -> Columns:
    """Every role that is mapped, or named so in the file, with its column.

    assigned: pairs of a role, or a group of roles, and the names of its columns; with no names the
    role is left out, though a column has its name.
    order: wxyz or xyzw, of a quaternion's four columns.  timed: whether there are times.
    Raises UsageError for unknown roles, TraceError for missing columns and half groups.
    """
    if order not in QUATERNIONS:
        raise UsageError(f"--quaternion {order}: no such order; {nearest(order, QUATERNIONS)}.")
    found: Columns = {}
    left_out: set[str] = set()
    for argument, names in assigned:
        roles = _roles_of(argument, len(names), order, euler)
        left_out |= set(roles) if not names else set()
        for role, name in zip(roles, names, strict=bool(names)):
            if role in found:
                raise UsageError(f"--column {argument}: {role} is given twice; give it once.")
            found[role] = find_column(table, name, role)
    if not timed and "t" in found:
        raise UsageError("--rate: a column is named as the time too; leave out one of them.")
    named = {role[0] for role in found} | (set() if timed else {"t"})
    named |= set("qer") if named & set("qer") else set()
    turns = len(set(euler.lower())) == 3
    alone = [bare(name) for name in table.names]
    known = KNOWN | _omega_names(alone)
    for name in (n for n, short in zip(table.names, alone, strict=True) if alone.count(short) == 1):
        role = known.get(bare(name), "")
        if role in TURNS:
            role = _turn_role(role, euler) if turns else ""
        if role and role[0] not in named and role not in {*found, *left_out}:
            found[role] = name
    return _whole(table, found, bool(assigned), timed)


def _whole(table: Table, found: Columns, mapped: bool, timed: bool) -> Columns:
    """The columns, if there is a time and every attitude is whole. Raises TraceError."""
    if timed and "t" not in found:
        for name in table.names:
            if KNOWN.get(bare(name)) == "t":
                check_alone(table, name)
        raise TraceError(
            f"{table.file}: no column is the time; name it with --column t=NAME, or give --rate "
            f"(the columns are {', '.join(map(repr, table.names[:20]))})."
        )
    for group in WHOLE:
        roles = GROUPS[group]
        missing = [role for role in roles if role not in found]
        if missing and len(missing) < len(roles):
            raise TraceError(
                f"{table.file}: no column is {missing[0]} ({MEANING[group]}); name it with "
                f"--column {missing[0]}=NAME, or leave the group out with --column {group}=."
            )
    attitudes = [group for group in WHOLE if GROUPS[group][0] in found]
    if len(attitudes) > 1:
        raise UsageError(
            f"{table.file}: the attitude is given as {MEANING[attitudes[0]]} and as "
            f"{MEANING[attitudes[1]]}; leave one of them out, like --column {attitudes[0]}=."
        )
    if not any(role in found for group in "wqerp" for role in GROUPS[group]):
        advice = "" if mapped else ", or have them found by omegadot score --detect"
        raise TraceError(
            f"{table.file}: no column is an angular velocity, an attitude or a position; map them, "
            f"like --column wx=NAME{advice} (the columns are "
            f"{', '.join(map(repr, table.names[:20]))})."
        )
    return found


def assignments_of(options: Sequence[str]) -> list[tuple[str, list[str]]]:
    """``ROLE=NAME``, ``GROUP=NAME,NAME,...`` and ``ROLE=`` taken apart. Raises UsageError."""
    found = []
    for option in options:
        role, equals, names = option.partition("=")
        if not equals or not role.strip():
            raise UsageError(f"--column {option}: write ROLE=NAME, like wx=omega_x.")
        group = GROUPS.get(role.strip().lower(), ())
        parts = [name.strip() for name in names.split(",")] if len(group) > 1 else [names.strip()]
        parts = parts if names.strip() else []
        found.append((role.strip(), parts))
    return found
