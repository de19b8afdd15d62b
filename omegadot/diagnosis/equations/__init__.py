"""Causes of wrong accelerations and torques: wrong equations, with and without numbers."""
