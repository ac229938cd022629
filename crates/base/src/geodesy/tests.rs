use super::*;
use proptest::prelude::*;
use std::f64::consts::PI;

/// An origin, a true bearing, and the place on the geodesic in this direction.
type Reference = (Geographic, f64, Geographic);

const fn at(latitude_deg: f64, longitude_deg: f64) -> Geographic {
    Geographic {
        latitude_deg,
        longitude_deg,
    }
}

/// Places at 1 km, computed by pyproj 3.7.2 (`Geod(ellps="WGS84").fwd`, Karney's algorithm).
const AT_1_KM: [Reference; 40] = [
    (at(0.0, 0.0), 0.0, at(0.009_043_694_77, 0.0)),
    (at(0.0, 0.0), 63.2, at(0.004_077_598_843, 0.008_018_234_844)),
    (
        at(0.0, 0.0),
        123.4,
        at(-0.004_978_379_776, 0.007_499_565_974),
    ),
    (
        at(0.0, 0.0),
        236.7,
        at(-0.004_965_194_774, -0.007_508_185_292),
    ),
    (
        at(0.0, 0.0),
        315.0,
        at(0.006_394_857_886, -0.006_352_048_317),
    ),
    (at(47.3977, 8.5456), 0.0, at(47.406_694_529_994, 8.5456)),
    (
        at(47.3977, 8.5456),
        63.2,
        at(47.401_754_823_502, 8.557_424_832_909),
    ),
    (
        at(47.3977, 8.5456),
        123.4,
        at(47.392_748_145_061, 8.556_658_045_257),
    ),
    (
        at(47.3977, 8.5456),
        236.7,
        at(47.392_761_257_18, 8.534_529_242_887),
    ),
    (
        at(47.3977, 8.5456),
        315.0,
        at(47.404_059_711_89, 8.536_231_954_876),
    ),
    (
        at(-33.8688, 151.2093),
        0.0,
        at(-33.859_784_488_223, 151.2093),
    ),
    (
        at(-33.8688, 151.2093),
        63.2,
        at(-33.864_734_732_356, 151.218_946_347_454),
    ),
    (
        at(-33.8688, 151.2093),
        123.4,
        at(-33.873_762_529_654, 151.218_323_312_017),
    ),
    (
        at(-33.8688, 151.2093),
        236.7,
        at(-33.873_749_385_001, 151.200_266_318_794),
    ),
    (
        at(-33.8688, 151.2093),
        315.0,
        at(-33.862_424_834_953, 151.201_658_366_144),
    ),
    (at(70.0, 25.7), 0.0, at(70.008_963_619_038, 25.7)),
    (
        at(70.0, 25.7),
        63.2,
        at(70.004_039_961_745, 25.723_378_882_368),
    ),
    (
        at(70.0, 25.7),
        123.4,
        at(69.995_064_355_209, 25.721_857_190_223),
    ),
    (
        at(70.0, 25.7),
        236.7,
        at(69.995_077_420_395, 25.678_117_675_417),
    ),
    (
        at(70.0, 25.7),
        315.0,
        at(70.006_337_273_998, 25.681_477_202_469),
    ),
    (at(-70.0, -60.3), 0.0, at(-69.991_036_371_856, -60.3)),
    (
        at(-70.0, -60.3),
        63.2,
        at(-69.995_956_969_244, -60.276_630_170_394),
    ),
    (
        at(-70.0, -60.3),
        123.4,
        at(-70.004_932_958_844, -60.278_132_472_124),
    ),
    (
        at(-70.0, -60.3),
        236.7,
        at(-70.004_919_887_501, -60.321_892_646_707),
    ),
    (
        at(-70.0, -60.3),
        315.0,
        at(-69.993_660_796_557, -60.318_511_550_38),
    ),
    (at(16.5, 179.9995), 0.0, at(16.509_036_366_463, 179.9995)),
    (
        at(16.5, 179.9995),
        63.2,
        at(16.504_074_128_505, -179.992_139_473_883),
    ),
    (
        at(16.5, 179.9995),
        123.4,
        at(16.495_025_504_783, -179.992_680_647_812),
    ),
    (
        at(16.5, 179.9995),
        236.7,
        at(16.495_038_678_777, 179.991_671_660_431),
    ),
    (
        at(16.5, 179.9995),
        315.0,
        at(16.506_389_571_906, 179.992_876_709_625),
    ),
    (
        at(-16.5, -179.9995),
        0.0,
        at(-16.490_963_625_738, -179.9995),
    ),
    (
        at(-16.5, -179.9995),
        63.2,
        at(-16.495_925_535_647, -179.991_139_823_914),
    ),
    (
        at(-16.5, -179.9995),
        123.4,
        at(-16.504_974_200_437, -179.991_680_248_1),
    ),
    (
        at(-16.5, -179.9995),
        236.7,
        at(-16.504_961_025_783, 179.992_671_261_319),
    ),
    (
        at(-16.5, -179.9995),
        315.0,
        at(-16.493_610_214_418, 179.993_877_144_504),
    ),
    (at(52.52, -0.0003), 0.0, at(52.528_986_559_107, -0.0003)),
    (
        at(52.52, -0.0003),
        63.2,
        at(52.524_051_108_846, 0.012_850_790_407),
    ),
    (
        at(52.52, -0.0003),
        123.4,
        at(52.515_052_427_52, 0.011_997_603_329),
    ),
    (
        at(52.52, -0.0003),
        236.7,
        at(52.515_065_527_774, -0.012_611_740_736),
    ),
    (
        at(52.52, -0.0003),
        315.0,
        at(52.526_353_999_815, -0.010_718_605_341),
    ),
];

/// The same at 10 km.
const AT_10_KM: [Reference; 4] = [
    (
        at(47.3977, 8.5456),
        63.2,
        at(47.438_193_168_155, 8.663_929_980_052),
    ),
    (
        at(-33.8688, 151.2093),
        236.7,
        at(-33.918_263_845_378, 151.118_916_238_07),
    ),
    (
        at(70.0, 25.7),
        45.0,
        at(70.063_285_612_944, 25.885_735_299_235),
    ),
    (
        at(70.0, 25.7),
        225.0,
        at(69.936_521_441_082, 25.515_389_416_349),
    ),
];

fn frame(origin: Geographic, rotation_deg: f64) -> LocalFrame {
    LocalFrame::new(origin, rotation_deg, 0.0)
}

/// The point of a world at a distance from its origin, on a heading.
fn point(distance_m: f64, heading_rad: f64) -> Point {
    Point {
        x: distance_m * libm::cos(heading_rad),
        y: distance_m * libm::sin(heading_rad),
    }
}

/// How far two directions in degrees are apart.
fn apart_deg(one: f64, other: f64) -> f64 {
    wrapped_deg(one - other).abs()
}

#[test]
fn a_place_at_1_km_is_within_a_centimetre_and_a_tenthousandth_of_a_degree_of_the_geodesic() {
    for (origin, bearing_deg, place) in AT_1_KM {
        for rotation_deg in [0.0, 30.0, -135.0] {
            let frame = frame(origin, rotation_deg);
            let local = frame.to_local(place);
            let expected = point(1000.0, (90.0 + rotation_deg - bearing_deg).to_radians());
            assert!(
                local.to(expected).length() < 1e-4,
                "{origin:?} {bearing_deg}"
            );
            let bearing = frame.true_bearing_deg(libm::atan2(local.y, local.x));
            assert!(
                apart_deg(bearing, bearing_deg) < 1e-5,
                "{origin:?} {bearing_deg}"
            );
        }
    }
}

#[test]
fn a_place_at_10_km_is_within_4_centimetres_of_the_geodesic() {
    for (origin, bearing_deg, place) in AT_10_KM {
        let local = frame(origin, 0.0).to_local(place);
        let expected = point(10_000.0, (90.0 - bearing_deg).to_radians());
        assert!(
            local.to(expected).length() < 0.04,
            "{origin:?} {bearing_deg}"
        );
    }
}

#[test]
#[expect(clippy::float_cmp, reason = "exact by construction")]
fn bearings_are_clockwise_from_north_and_headings_anticlockwise_from_the_x_axis() {
    let north_up = frame(at(47.0, 8.0), 0.0);
    for (bearing_deg, heading_rad) in [
        (90.0, 0.0),
        (0.0, PI / 2.0),
        (360.0, PI / 2.0),
        (270.0, PI),
        (-90.0, PI),
        (180.0, -PI / 2.0),
    ] {
        let heading = north_up.heading_rad(bearing_deg);
        assert!(
            (heading - heading_rad).abs() < 1e-15,
            "{bearing_deg}: {heading}"
        );
    }
    // The y axis points east.
    assert_eq!(frame(at(47.0, 8.0), 90.0).heading_rad(180.0), 0.0);
}

#[test]
fn a_compass_reads_less_than_the_true_bearing_where_the_declination_is_east() {
    let frame = LocalFrame::new(at(47.0, 8.0), 0.0, 3.0);
    assert!((frame.compass_heading_rad(87.0, 0.0)).abs() < 1e-15);
    assert!((frame.magnetic_bearing_deg(0.0) - 87.0).abs() < 1e-12);
    // A compass that points 10 degrees to the right of the front reads 10 degrees more.
    assert!((frame.compass_heading_rad(97.0, 10.0)).abs() < 1e-15);
}

#[test]
#[expect(clippy::float_cmp, reason = "exact by construction")]
fn a_bearing_is_below_360_even_if_the_remainder_is_rounded_to_it() {
    let frame = LocalFrame::new(at(0.0, 0.0), 0.0, 1e-18);
    assert_eq!(frame.magnetic_bearing_deg(PI / 2.0), 0.0);
}

fn origins() -> impl Strategy<Value = Geographic> {
    let latitude = -LocalFrame::MAX_LATITUDE_DEG..=LocalFrame::MAX_LATITUDE_DEG;
    (latitude, -180.0..=180.0)
        .prop_map(|(latitude_deg, longitude_deg)| at(latitude_deg, longitude_deg))
}

fn frames() -> impl Strategy<Value = LocalFrame> {
    (origins(), -360.0..=360.0, -180.0..=180.0)
        .prop_map(|(origin, rotation, declination)| LocalFrame::new(origin, rotation, declination))
}

proptest! {
    #[test]
    fn a_point_returns_from_its_geographic_place(
        frame in frames(),
        distance_m in 0.0..=LocalFrame::MAX_DISTANCE_M,
        heading_rad in -PI..PI,
    ) {
        let there = point(distance_m, heading_rad);
        let place = frame.to_geographic(there);
        prop_assert!(place.longitude_deg > -180.0 && place.longitude_deg <= 180.0);
        prop_assert!(frame.to_local(place).to(there).length() < 1e-6);
    }

    #[test]
    fn the_origin_is_the_point_0_0(origin in origins(), rotation_deg in -360.0..=360.0) {
        prop_assert_eq!(frame(origin, rotation_deg).to_local(origin), Point::default());
    }

    #[test]
    fn a_place_on_a_bearing_is_in_the_direction_of_its_heading(
        frame in frames(),
        bearing_deg in 0.0..360.0,
    ) {
        let step = Geographic {
            latitude_deg: frame.origin.latitude_deg + 1e-6 * libm::cos(f64::to_radians(bearing_deg)),
            longitude_deg: frame.origin.longitude_deg
                + 1e-6 * libm::sin(f64::to_radians(bearing_deg)) * frame.series.north_by_latitude
                    / frame.series.east_by_longitude,
        };
        let local = frame.to_local(step);
        let off_rad = libm::atan2(local.y, local.x) - frame.heading_rad(bearing_deg);
        prop_assert!(crate::trig::wrapped(off_rad).abs() < 1e-5);
    }

    #[test]
    fn a_bearing_returns_from_its_heading(
        frame in frames(),
        bearing_deg in -720.0..720.0,
        mounting_deg in -180.0..180.0,
    ) {
        let heading_rad = frame.heading_rad(bearing_deg);
        prop_assert!(heading_rad > -PI && heading_rad <= PI);
        prop_assert!(apart_deg(frame.true_bearing_deg(heading_rad), bearing_deg) < 1e-9);
        let heading_rad = frame.compass_heading_rad(bearing_deg, mounting_deg);
        let magnetic_deg = frame.magnetic_bearing_deg(heading_rad);
        prop_assert!((0.0..360.0).contains(&magnetic_deg));
        prop_assert!(apart_deg(magnetic_deg, bearing_deg - mounting_deg) < 1e-9);
    }

    #[test]
    fn a_place_elsewhere_on_earth_is_never_near_the_origin(
        origin in origins(),
        latitude_deg in -90.0..=90.0,
        longitude_deg in -180.0..=180.0,
    ) {
        let place = at(latitude_deg, longitude_deg);
        prop_assume!((latitude_deg - origin.latitude_deg).abs() > 1.0);
        prop_assert!(frame(origin, 0.0).to_local(place).length() > 100_000.0);
    }
}
