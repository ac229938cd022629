//! Geographic coordinates (WGS 84) and the coordinates of a world.
//!
//! A world is flat: east and north of its origin are polynomials of second order in the differences of
//! latitude and longitude, with the radii of curvature of the ellipsoid at the origin. Compared with
//! geodesics, a point is wrong by 0.04 mm at a distance of 1 km, by 4 cm at 10 km and by 41 m at 100 km, up
//! to a latitude of 70 degrees; the error grows with the cube of the distance.

use crate::geometry::Point;
use crate::trig::{sin_cos, wrapped_deg};

/// Semi-major axis of the ellipsoid, in metres.
const SEMI_MAJOR_M: f64 = 6_378_137.0;
const FLATTENING: f64 = 1.0 / 298.257_223_563;
/// Square of the eccentricity.
const ECCENTRICITY_SQUARED: f64 = FLATTENING * (2.0 - FLATTENING);

/// Each iteration doubles the number of correct digits; the first guess has one at the farthest point.
const ITERATIONS: usize = 6;

/// A place on the ellipsoid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Geographic {
    /// Latitude, from -90 to 90; north is positive.
    pub latitude_deg: f64,
    /// Longitude; east is positive.
    pub longitude_deg: f64,
}

/// The place and the orientation of a world on the earth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalFrame {
    origin: Geographic,
    rotation_deg: f64,
    declination_deg: f64,
    /// Sine and cosine of the rotation.
    rotation: (f64, f64),
    series: Series,
}

impl LocalFrame {
    /// The largest absolute latitude of an origin, in degrees: east and north change too quickly near the poles.
    pub const MAX_LATITUDE_DEG: f64 = 85.0;

    /// Points of a world up to this distance from the origin can be converted; it exceeds every world.
    pub const MAX_DISTANCE_M: f64 = 200_000.0;

    /// The frame of a world with the point (0, 0) at `origin`, whose y axis has the true bearing
    /// `rotation_deg`. `declination_deg` is the bearing of magnetic north, east positive.
    #[must_use]
    pub fn new(origin: Geographic, rotation_deg: f64, declination_deg: f64) -> Self {
        Self {
            origin,
            rotation_deg,
            declination_deg,
            rotation: sin_cos(rotation_deg.to_radians()),
            series: Series::at(origin.latitude_deg.to_radians()),
        }
    }

    /// The point of the world at a geographic place.
    #[must_use]
    pub fn to_local(&self, place: Geographic) -> Point {
        let longitude_deg = wrapped_deg(place.longitude_deg - self.origin.longitude_deg);
        let from_origin = Difference {
            latitude_rad: (place.latitude_deg - self.origin.latitude_deg).to_radians(),
            longitude_rad: longitude_deg.to_radians(),
        };
        let EastNorth { east_m, north_m } = self.series.east_north(from_origin);
        let (sine, cosine) = self.rotation;
        Point {
            x: east_m * cosine - north_m * sine,
            y: east_m * sine + north_m * cosine,
        }
    }

    /// The geographic place of a point of the world, up to [`Self::MAX_DISTANCE_M`] from the origin; the
    /// longitude is above -180 and at most 180.
    #[must_use]
    pub fn to_geographic(&self, point: Point) -> Geographic {
        let (sine, cosine) = self.rotation;
        let from_origin = self.series.difference(EastNorth {
            east_m: point.x * cosine + point.y * sine,
            north_m: point.y * cosine - point.x * sine,
        });
        let longitude_deg = self.origin.longitude_deg + from_origin.longitude_rad.to_degrees();
        Geographic {
            latitude_deg: self.origin.latitude_deg + from_origin.latitude_rad.to_degrees(),
            longitude_deg: wrapped_deg(longitude_deg),
        }
    }

    /// The heading in the world (0 along x, anticlockwise, above -pi and at most pi) of a true bearing.
    #[must_use]
    pub fn heading_rad(&self, true_bearing_deg: f64) -> f64 {
        wrapped_deg(90.0 + self.rotation_deg - wrapped_deg(true_bearing_deg)).to_radians()
    }

    /// The heading in the world of a robot whose compass reads a magnetic bearing; `mounting_deg` is the
    /// direction of the compass relative to the front of the robot, clockwise.
    #[must_use]
    pub fn compass_heading_rad(&self, magnetic_bearing_deg: f64, mounting_deg: f64) -> f64 {
        let front_deg = wrapped_deg(magnetic_bearing_deg) - mounting_deg;
        self.heading_rad(front_deg + self.declination_deg)
    }

    /// The true bearing of a heading, from 0 to below 360.
    #[must_use]
    pub fn true_bearing_deg(&self, heading_rad: f64) -> f64 {
        bearing_deg(90.0 + self.rotation_deg - wrapped_deg(heading_rad.to_degrees()))
    }

    /// The magnetic bearing of a heading, from 0 to below 360.
    #[must_use]
    pub fn magnetic_bearing_deg(&self, heading_rad: f64) -> f64 {
        bearing_deg(self.true_bearing_deg(heading_rad) - self.declination_deg)
    }
}

/// The same angle, from 0 to below 360.
fn bearing_deg(angle_deg: f64) -> f64 {
    let bearing_deg = angle_deg.rem_euclid(360.0);
    // The remainder of a tiny negative angle is rounded to 360.
    if bearing_deg < 360.0 {
        bearing_deg
    } else {
        0.0
    }
}

/// A difference of two places.
#[derive(Debug, Clone, Copy)]
struct Difference {
    latitude_rad: f64,
    longitude_rad: f64,
}

/// A vector from the origin.
#[derive(Debug, Clone, Copy)]
struct EastNorth {
    east_m: f64,
    north_m: f64,
}

/// East and north at a latitude: the coefficients of the powers of the differences of latitude and longitude.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Series {
    east_by_longitude: f64,
    east_by_both: f64,
    north_by_latitude: f64,
    north_by_latitude_squared: f64,
    north_by_longitude_squared: f64,
}

impl Series {
    fn at(latitude_rad: f64) -> Self {
        let (sine, cosine) = sin_cos(latitude_rad);
        let flatness = 1.0 - ECCENTRICITY_SQUARED * sine * sine;
        // The radii of curvature across and along the meridian.
        let across_m = SEMI_MAJOR_M / flatness.sqrt();
        let along_m = across_m * (1.0 - ECCENTRICITY_SQUARED) / flatness;
        let slope = ECCENTRICITY_SQUARED * sine * cosine / flatness;
        Self {
            east_by_longitude: across_m * cosine,
            east_by_both: -along_m * sine,
            north_by_latitude: along_m,
            north_by_latitude_squared: 1.5 * along_m * slope,
            north_by_longitude_squared: 0.5 * across_m * sine * cosine,
        }
    }

    fn east_north(&self, by: Difference) -> EastNorth {
        let (latitude, longitude) = (by.latitude_rad, by.longitude_rad);
        EastNorth {
            east_m: longitude * (self.east_by_longitude + self.east_by_both * latitude),
            north_m: latitude
                * (self.north_by_latitude + self.north_by_latitude_squared * latitude)
                + self.north_by_longitude_squared * longitude * longitude,
        }
    }

    /// The inverse, by Newton's method.
    fn difference(&self, to: EastNorth) -> Difference {
        let mut by = Difference {
            latitude_rad: to.north_m / self.north_by_latitude,
            longitude_rad: to.east_m / self.east_by_longitude,
        };
        for _ in 0..ITERATIONS {
            by = self.improved(by, to);
        }
        by
    }

    fn improved(&self, by: Difference, to: EastNorth) -> Difference {
        let is = self.east_north(by);
        let (east_m, north_m) = (to.east_m - is.east_m, to.north_m - is.north_m);
        let east_by_longitude = self.east_by_longitude + self.east_by_both * by.latitude_rad;
        let east_by_latitude = self.east_by_both * by.longitude_rad;
        let north_by_longitude = 2.0 * self.north_by_longitude_squared * by.longitude_rad;
        let north_by_latitude =
            self.north_by_latitude + 2.0 * self.north_by_latitude_squared * by.latitude_rad;
        let determinant =
            east_by_longitude * north_by_latitude - east_by_latitude * north_by_longitude;
        let latitude = east_by_longitude * north_m - north_by_longitude * east_m;
        let longitude = north_by_latitude * east_m - east_by_latitude * north_m;
        Difference {
            latitude_rad: by.latitude_rad + latitude / determinant,
            longitude_rad: by.longitude_rad + longitude / determinant,
        }
    }
}

#[cfg(test)]
mod tests;
