"""Denavit-Hartenberg tables of serial chains, from their screws, and proved against both engines."""
