"""Positions and bearings in the world, for the fence and the rules.

The loop computes those of percepts itself, with the engine's exact functions.
"""

import math

from agent_economy.live.plan import Origin

SEMI_MAJOR_M = 6_378_137.0
ECCENTRICITY_SQUARED = 6.694379990141316e-3
FULL_TURN_DEG = 360.0
STEPS = 8
"""Each step of the inverse leaves less than a hundredth of the error."""


def world_of(origin: Origin, latitude_deg: float, longitude_deg: float) -> tuple[float, float]:
    """Return the position in the world, in metres, to the second order around the origin."""
    latitude = math.radians(origin.latitude_deg)
    sine, cosine = math.sin(latitude), math.cos(latitude)
    scale = 1 - ECCENTRICITY_SQUARED * sine * sine
    normal_m = SEMI_MAJOR_M / math.sqrt(scale)
    meridian_m = normal_m * (1 - ECCENTRICITY_SQUARED) / scale
    north = math.radians(latitude_deg - origin.latitude_deg)
    east = math.radians((longitude_deg - origin.longitude_deg + 540) % FULL_TURN_DEG - 180)
    north_m = meridian_m * north + normal_m * sine * cosine * east * east / 2
    east_m = normal_m * cosine * east - normal_m * sine * north * east
    turn = math.radians(origin.rotation_deg)
    x_m = east_m * math.cos(turn) - north_m * math.sin(turn)
    y_m = east_m * math.sin(turn) + north_m * math.cos(turn)
    return x_m, y_m


def geographic_of(origin: Origin, x_m: float, y_m: float) -> tuple[float, float]:
    """Return latitude and longitude of a position in the world: the inverse of `world_of`."""
    latitude, longitude = origin.latitude_deg, origin.longitude_deg
    metre_deg = 360.0 / (2 * math.pi * SEMI_MAJOR_M)
    turn = math.radians(origin.rotation_deg)
    for _ in range(STEPS):
        there_x_m, there_y_m = world_of(origin, latitude, longitude)
        dx_m, dy_m = x_m - there_x_m, y_m - there_y_m
        east_m = dx_m * math.cos(turn) + dy_m * math.sin(turn)
        north_m = dy_m * math.cos(turn) - dx_m * math.sin(turn)
        latitude += north_m * metre_deg
        longitude += east_m * metre_deg / math.cos(math.radians(origin.latitude_deg))
    return latitude, longitude


def world_heading_deg(origin: Origin, magnetic_deg: float) -> float:
    """Return the heading in the world of a compass bearing, 0 to 360, anticlockwise from x.

    The conversion of headings to bearings is its own inverse.
    """
    return magnetic_bearing_deg(origin, math.radians(magnetic_deg))


def magnetic_bearing_deg(origin: Origin, heading_rad: float) -> float:
    """Return the compass bearing of a heading in the world, 0 to 360, clockwise."""
    bearing = 90 - math.degrees(heading_rad) + origin.rotation_deg - origin.declination_deg
    return bearing % FULL_TURN_DEG
