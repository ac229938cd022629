use super::*;

#[test]
fn a_world_that_wraps_is_large_enough_and_holds_its_obstacles_wholly() {
    let periodic = GOOD.replace("size_m = [20, 10]", "size_m = [20, 10]\nperiodic = true");
    assert!(read(&periodic).is_ok());
    let errors = |this, that| read(&periodic.replace(this, that)).unwrap_err().to_string();
    // Half of 10 m, less the skin of 0.6 m and the radius of 0.5 m of the largest robot.
    let reported = errors("range_m = 3", "range_m = 4");
    assert!(
        reported.contains("robots.rover.sensors.eye.range_m = 4: must be at most 3.900"),
        "{reported}"
    );
    let reported = errors("[15, 5]", "[19.5, 5]");
    assert!(
        reported.contains("world.obstacles[1]")
            && reported.contains("because the world is periodic"),
        "{reported}"
    );
    let reported = errors("max_speed_m_s = 5", "max_speed_m_s = 50");
    assert!(reported.contains("world.size_m"), "{reported}");
    let reported = errors("[[6, 6], [7, 6]]", "[[0.1, 6], [19.9, 6]]");
    assert!(reported.contains("robots.rover.start.at_m["), "{reported}");
}
