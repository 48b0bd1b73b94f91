"""Answers to exercises in kinematics, held against closed forms: which entry is wrong, and which slip explains it."""
