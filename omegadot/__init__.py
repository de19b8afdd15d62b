"""omegadot: cross-validation of rigid-body engines against a Newton-Euler reference."""

__version__ = "0.1.0"
