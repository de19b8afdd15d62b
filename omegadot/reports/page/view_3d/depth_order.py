"""In which order to paint the faces of several convex solids, wherever the eye stands.

A tree of planes parts the body's space until every cell holds pieces of one solid alone. Seen
from an eye, what lies beyond a plane is painted first and what lies on the eye's side last; the
pieces of one convex solid hide nothing of each other once those that face away are left out. So
the order is right for solids that are apart or touch, and costs a walk. Where solids run through
each other and no face can part them without a cut, small pieces share a cell, those wholly
inside a solid left out, and are painted by their distance, which is right to about their size.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from omegadot.reference_impl.system import Array
from omegadot.reports.page.view_3d.meshes import Mesh

# So many planes are looked at for the one that parts the most.
_TRIED = 64
# Pieces that are painted by their distance are this small, over the body's reach.
_SMALL = 0.25

# Outward unit normals (n, 3) and offsets (n,) of a solid's faces.
Planes: TypeAlias = tuple[Array, Array]


@dataclass(frozen=True)
class Piece:
    """A convex polygon of a solid. corners: (n, 3); normal: unit, outwards."""

    solid: int
    corners: Array
    normal: Array
    marked: bool


@dataclass(frozen=True)
class Cell:
    """The plane ``normal . r = offset`` with what lies in it, behind it and before it.

    A last cell has no plane (None), only pieces: of one solid, or `mixed`.
    """

    pieces: tuple[Piece, ...]
    plane: tuple[Array, float] | None = None
    behind: Cell | None = None
    before: Cell | None = None
    mixed: bool = False


def depth_order(solids: Sequence[Mesh]) -> Cell:
    """The tree of every face of the solids. Raises ValueError where there is none."""
    pieces = []
    for number, mesh in enumerate(solids):
        for face, marked in zip(mesh.faces, mesh.marked, strict=True):
            corners = mesh.vertices[list(face)]
            pieces.append(Piece(number, corners, _normal(corners), marked))
    if (tree := _parted(pieces, [_planes(mesh) for mesh in solids])) is None:
        raise ValueError("a body without a face cannot be drawn; give it a solid.")
    return tree


def _planes(mesh: Mesh) -> Planes:
    corners = [mesh.vertices[list(face)] for face in mesh.faces]
    normals = np.array([_normal(own) for own in corners])
    return normals, np.sum(normals * [own[0] for own in corners], axis=-1)


def _normal(corners: Array) -> Array:
    """Newell's sum over the edges, which no single short edge can spoil."""
    after = corners[[*range(1, len(corners)), 0]]
    less, more = corners - after, corners + after
    area = np.sum(less[:, [1, 2, 0]] * more[:, [2, 0, 1]], axis=0)
    length = float(np.sqrt(area @ area))
    return np.asarray(area / length) if length > 0 else np.zeros(3)


def _parted(pieces: list[Piece], solids: list[Planes]) -> Cell | None:
    """The tree of these pieces of the solids; None where there are none."""
    if not pieces:
        return None
    if len({piece.solid for piece in pieces}) == 1:
        return Cell(tuple(pieces))
    reach = max(float(np.abs(piece.corners).max()) for piece in pieces)
    # A corner this close lies in the plane: some roundings of its own coordinates.
    near = 1e-9 * reach
    plane = _best_plane(pieces, near)
    if plane is None:
        small = [part for piece in pieces for part in _halved(piece, _SMALL * reach)]
        return Cell(tuple(p for p in small if not _inside(p, solids, near)), mixed=True)
    normal, offset = plane
    inside, behind, before = [], [], []
    for piece in pieces:
        height = piece.corners @ normal - offset
        if np.all(np.abs(height) <= near):
            inside.append(piece)
        elif np.all(height <= near):
            behind.append(piece)
        else:
            before.append(piece)
    return Cell(tuple(inside), plane, _parted(behind, solids), _parted(before, solids))


def _best_plane(pieces: list[Piece], near: float) -> tuple[Array, float] | None:
    """A piece's own plane with pieces on either side and none cut, parting the most solids."""
    starts = np.cumsum([0] + [len(piece.corners) for piece in pieces])[:-1]
    corners = np.concatenate([piece.corners for piece in pieces])
    solids = np.array([piece.solid for piece in pieces])
    normals = np.array([piece.normal for piece in pieces])
    offsets = np.sum(normals * corners[starts], axis=-1)
    heights = corners @ normals.T - offsets
    high = np.maximum.reduceat(heights, starts) > near
    low = np.minimum.reduceat(heights, starts) < -near
    useful = high.any(axis=0) & low.any(axis=0) & ~(high & low).any(axis=0)
    best, least = None, np.inf
    for k in np.flatnonzero(useful)[:_TRIED]:
        left = len(set(solids[high[:, k]])) + len(set(solids[low[:, k]]))
        if left < least:
            best, least = (normals[k], float(offsets[k])), left
    return best


def _halved(piece: Piece, size: float) -> list[Piece]:
    """The piece, cut across its longest extent until none is longer than `size`."""
    low, high = piece.corners.min(axis=0), piece.corners.max(axis=0)
    axis = int(np.argmax(high - low))
    if high[axis] - low[axis] <= size:
        return [piece]
    height = piece.corners[:, axis] - 0.5 * (low[axis] + high[axis])
    halves = (_cut(piece, height), _cut(piece, -height))
    return [part for half in halves for part in _halved(half, size)]


def _inside(piece: Piece, solids: list[Planes], near: float) -> bool:
    """Whether another solid hides the whole piece."""
    return any(
        bool(np.all(piece.corners @ normals.T <= offsets - near))
        for number, (normals, offsets) in enumerate(solids)
        if number != piece.solid
    )


def _cut(piece: Piece, height: Array) -> Piece:
    """The part of the polygon where the height, given at its corners, is not below zero."""
    kept = []
    for k, corner in enumerate(piece.corners):
        if height[k] >= 0:
            kept.append(corner)
        after = (k + 1) % len(height)
        if height[k] * height[after] < 0:
            share = height[k] / (height[k] - height[after])
            kept.append(corner + share * (piece.corners[after] - corner))
    return Piece(piece.solid, np.array(kept), piece.normal, piece.marked)
