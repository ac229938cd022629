//! An example of a custom behaviour, added as described in `docs/brains.md`: a file and three lines.

#![expect(
    unreachable_pub,
    reason = "the messages of this behaviour stay within tests"
)]

use super::*;

#[path = "../../../../examples/zigzag.rs"]
mod zigzag;

pub use zigzag::Zigzag;

behaviours! {
    /// Drives in a zigzag.
    Zigzag in zigzag;
    /// Avoids what is too near.
    Avoid in avoid;
}

mod tests {
    use super::*;
    use crate::arbitration::subsumption::{arbitrate, layers};
    use crate::navigation::speed_governor::SpeedGovernor;
    use crate::perception::dead_reckoning::DeadReckoning;
    use crate::world_of_walls::{Walk, room, rover};
    use base::geometry::Point;
    use core::cell::Cell;
    use core::f64::consts::FRAC_PI_2;

    fn zigzag() -> BehaviourSpec {
        serde_json::from_str(r#"{"kind": "zigzag", "straight_s": 2}"#).unwrap()
    }

    /// Positions and headings of a robot with both behaviours after each step.
    fn path(size_m: f64, steps: usize) -> Vec<(Point, f64)> {
        let body = rover();
        let behaviours = [zigzag(), BehaviourSpec::Avoid(Avoid::default())];
        let behaviours = behaviours.map(|each| each.ready(&body));
        let (mut layers, mut odometry) = (layers(&behaviours), DeadReckoning::default());
        let sight = SpeedGovernor::new(&body);
        let mut walk = Walk::new(body.clone(), room(size_m, size_m), [2.0, 2.0], 0.0);
        let step = |_| {
            let percept = walk.percept();
            let moved = odometry.reckon(&percept, &body, body.period_s);
            let situation = Situation {
                percept: &percept,
                body: &body,
                beliefs: None,
                localisation: None,
                peers: None,
                rings: &sight.rings,
                last_goal: &Cell::new(0),
                ahead: sight.ahead(&percept, &body, moved.speed_m_s),
                elapsed_s: body.period_s,
                turned_rad: moved.turned_rad,
                current_speed_m_s: moved.speed_m_s,
            };
            let mut motion = match arbitrate(&behaviours, &mut layers, &situation) {
                Some((_, Proposal::Motion(motion))) => motion,
                _ => Motion::default(),
            };
            let most = body.max_turn_rate_rad_s;
            motion.turn_rate_rad_s = motion.turn_rate_rad_s.clamp(-most, most);
            odometry.record_command(motion);
            walk.step(motion);
            (walk.at, walk.heading_rad)
        };
        (0..steps).map(step).collect()
    }

    #[test]
    fn an_added_behaviour_has_its_name_and_requirements() {
        let zigzag = zigzag();
        assert_eq!(zigzag.name(), "zigzag");
        assert_eq!(zigzag, BehaviourSpec::Zigzag(Zigzag { straight_s: 2.0 }));
        assert!(!zigzag.needs_beliefs() && !zigzag.needs_pose() && !zigzag.needs_detector());
        assert!(!zigzag.takes_orders() && !zigzag.serves_controllers());
        let slip = r#"{"kind": "zigzag", "strait_s": 2}"#;
        assert!(serde_json::from_str::<BehaviourSpec>(slip).is_err());
    }

    #[test]
    fn an_added_behaviour_moves_a_robot() {
        let path = path(50.0, 300);
        let (at, _) = path[path.len() - 1];
        assert!(at.x > 8.0 && at.y > 8.0, "{at:?}");
        // Along x or along y, except during turns.
        let along = |rad: f64| {
            path.iter()
                .filter(move |(_, heading_rad)| (heading_rad - rad).abs() < 0.03)
                .count()
        };
        assert!(along(0.0) > 100 && along(FRAC_PI_2) > 100);
    }

    #[test]
    fn an_added_behaviour_is_suppressed_by_those_above() {
        let path = path(8.0, 600);
        assert!(
            path.iter()
                .all(|(at, _)| at.x.min(at.y) > 0.25 && at.x.max(at.y) < 7.75)
        );
    }
}
