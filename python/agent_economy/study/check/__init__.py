"""Checks of a study that is requested: `request` enters them once, and states their order."""
