"""The trace's own units, in which people read its errors."""

from __future__ import annotations

from omegadot.commands.score.judged import ChannelScore, Judged


def factor_of(found: Judged, channel: str) -> tuple[float, str]:
    """From the yardstick's unit to the one that people read here, the trace's own, and its name."""
    how = found.reading.how
    if channel == "omega":
        return found.rate / how.scale_of("rate"), how.rate_unit
    if channel == "attitude":
        by_angles = "e1" in found.reading.columns
        return (1.0 / how.scale_of("angle"), how.angle_unit) if by_angles else (1.0, "rad")
    if channel == "position":
        return 1.0 / how.scale_of("length"), how.length_unit
    return 1.0, "relative"


def in_own_unit(found: Judged, channel: str) -> ChannelScore:
    """One channel, in the trace's own unit."""
    return found.score(channel, *factor_of(found, channel))
