"""A body's look as small whole numbers, for the script that draws it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from omegadot.reference_impl.system import Array
from omegadot.reports.page.view_3d.bodies import Look
from omegadot.reports.page.view_3d.depth_order import Cell, Piece, depth_order

# Coordinates of a shape, over its reach, are whole numbers of this.
_GRAIN = 1e-4


def shape(look: Look) -> dict[str, Any]:
    """The body over its reach: tree, tip and what is told of it; its inertia."""
    reach = max(float(np.sqrt((mesh.vertices**2).sum(axis=-1).max())) for mesh in look.solids)
    grain = _GRAIN * reach
    return {
        "told": look.reported,
        "tip": _grains([look.tip], grain),
        "inertia": [float(f"{x:.6g}") for x in look.inertia.ravel()],
        "body": tree_of(depth_order(look.solids), grain),
        "ball": [float(f"{x:.4g}") for x in look.ball.ravel()],
    }


def tree_of(cell: Cell | None, grain: float) -> list[Any] | None:
    """``[pieces, mixed]`` or ``[pieces, plane, behind, before]``.

    A piece is ``[marked, normal, corners]``; a plane is its normal and its offset.
    """
    if cell is None:
        return None
    pieces = [_piece(piece, grain) for piece in cell.pieces]
    if cell.plane is None:
        return [pieces, cell.mixed]
    normal, offset = cell.plane
    plane = [*_grains([normal], _GRAIN), round(offset / grain)]
    return [pieces, plane, tree_of(cell.behind, grain), tree_of(cell.before, grain)]


def _piece(piece: Piece, grain: float) -> list[Any]:
    return [int(piece.marked), _grains([piece.normal], _GRAIN), _grains(piece.corners, grain)]


def _grains(vectors: Iterable[Array], grain: float) -> list[int]:
    return [int(x) for x in np.rint(np.concatenate(list(vectors)) / grain)]
