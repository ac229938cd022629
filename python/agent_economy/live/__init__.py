"""Drives real robots with the brains of the simulator, and stops them when anything is wrong."""
