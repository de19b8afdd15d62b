"""Causes of a model that does not read back: tensors and conventions."""
