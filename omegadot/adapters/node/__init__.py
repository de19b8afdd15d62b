"""Engines that run in JavaScript, through Node: one worker for all, one small file for each."""
