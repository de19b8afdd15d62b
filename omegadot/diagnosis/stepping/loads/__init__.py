"""Loads and terms that act otherwise, or at other times, within steps."""
