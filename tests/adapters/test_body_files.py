"""Bodies through an engine's own reader of files: sound ones are held, misread ones are caught."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from mujoco_cases import INERTIAS, LOADS, at, cases_of, states, system

from omegadot.adapters.body_files import mjcf_of, urdf_of
from omegadot.adapters.dart import model as dart_model
from omegadot.adapters.mujoco import importer as mujoco_importer
from omegadot.adapters.pinocchio import model as pinocchio_model
from omegadot.adapters.protocol import Adapter, UnsupportedError
from omegadot.adapters.registry import BUILT_IN, build_adapter
