use super::*;

const MATE: AgentId = AgentId::robot(0, 1);
const HERE: Point = Point { x: 1.0, y: 1.0 };
const THERE: Point = Point { x: 3.0, y: 1.0 };

/// The goal of a place: each has its own.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "small"
)]
fn goal(at: Point) -> GoalPlace {
    let (issuer, number) = (MATE, at.x as u32);
    GoalPlace {
        id: GoalId {
            issuer: issuer.into(),
            number,
        },
        at,
    }
}

fn report(peers: &mut Peers, at: Point, observations: u32, age_s: f64) -> (Point, u32, f64) {
    let value = (at, observations);
    peers.update_observations(MATE, Reading { value, age_s })
}

fn position(peers: &Peers) -> Option<Point> {
    peers.mates.iter().find_map(Peer::at)
}

fn is_taken(peers: &Peers, to: Point) -> bool {
    peers.is_any_going_to(goal(to).id, |_| true)
}

#[test]
fn the_observations_since_the_last_message_are_counted() {
    let mut peers = Peers::default();
    assert_eq!(report(&mut peers, HERE, 7, 0.0), (HERE, 1, f64::INFINITY));
    peers.advance(2.0);
    assert_eq!(report(&mut peers, THERE, 12, 0.5), (HERE, 5, 1.5));
    assert_eq!(report(&mut peers, THERE, 12, 0.5), (THERE, 0, 0.0));
}

#[test]
fn an_overtaken_message_is_ignored() {
    let mut peers = Peers::default();
    report(&mut peers, HERE, 7, 0.0);
    peers.update_position(MATE, HERE, 0.0);
    assert_eq!(report(&mut peers, THERE, 20, 1.0).1, 0);
    peers.update_position(MATE, THERE, 1.0);
    assert_eq!(position(&peers), Some(HERE));
    peers.advance(1.0);
    assert_eq!(report(&mut peers, THERE, 9, 0.0), (HERE, 2, 1.0));
}

#[test]
fn a_destination_is_known_until_arrival_or_expiry() {
    let mut peers = Peers::default();
    peers.update_destination(MATE, goal(THERE), CommitmentStatus::Active, 0.0);
    assert!(is_taken(&peers, THERE) && !peers.is_any_going_to(goal(THERE).id, |id| id != MATE));
    for status in [CommitmentStatus::Done, CommitmentStatus::Released] {
        peers.update_destination(MATE, goal(THERE), CommitmentStatus::Active, 0.0);
        peers.update_destination(MATE, goal(THERE), status, 0.0);
        assert!(!is_taken(&peers, THERE));
    }
    peers.update_destination(MATE, goal(THERE), CommitmentStatus::Active, 0.0);
    peers.advance(9.9);
    assert!(is_taken(&peers, THERE));
    peers.advance(0.2);
    assert!(!is_taken(&peers, THERE));
}

#[test]
fn position_reports_do_not_extend_a_destination() {
    let mut peers = Peers::default();
    peers.update_destination(MATE, goal(THERE), CommitmentStatus::Active, 0.0);
    for _ in 0..11 {
        peers.advance(1.0);
        peers.update_position(MATE, HERE, 0.0);
    }
    assert_eq!(position(&peers), Some(HERE));
    assert!(!is_taken(&peers, THERE));
}

#[test]
fn ages_start_at_the_age_of_the_message_and_old_messages_are_ignored() {
    let mut peers = Peers::default();
    peers.update_destination(MATE, goal(THERE), CommitmentStatus::Active, 500.0);
    peers.update_position(MATE, HERE, 500.0);
    assert!(!is_taken(&peers, THERE) && position(&peers).is_none());
    peers.update_destination(MATE, goal(THERE), CommitmentStatus::Active, 9.0);
    peers.update_position(MATE, HERE, 9.0);
    assert!(is_taken(&peers, THERE) && position(&peers) == Some(HERE));
    peers.advance(1.1);
    assert!(!is_taken(&peers, THERE) && position(&peers).is_none());
}

#[test]
fn an_old_message_does_not_override_a_newer_one() {
    let mut peers = Peers::default();
    peers.update_destination(MATE, goal(HERE), CommitmentStatus::Active, 1.0);
    peers.update_destination(MATE, goal(THERE), CommitmentStatus::Active, 4.0);
    peers.update_destination(MATE, goal(HERE), CommitmentStatus::Released, 2.0);
    assert!(is_taken(&peers, HERE) && !is_taken(&peers, THERE));
    peers.update_destination(MATE, goal(HERE), CommitmentStatus::Released, 0.5);
    peers.update_destination(MATE, goal(HERE), CommitmentStatus::Active, 1.0);
    assert!(!is_taken(&peers, HERE));
}

#[test]
fn each_visit_is_returned_once() {
    let (mut peers, mut since) = (Peers::default(), 0);
    for x in 0..100 {
        let at = Point {
            x: f64::from(x),
            y: 0.0,
        };
        peers.update_destination(MATE, goal(at), CommitmentStatus::Done, 100.0);
        peers.update_destination(MATE, goal(at), CommitmentStatus::Released, 0.0);
        if x < 50 {
            assert_eq!(peers.visits_since(&mut since), [goal(at).id]);
            assert_eq!(peers.visits_since(&mut since), []);
        }
    }
    assert_eq!(peers.visits_since(&mut since).len(), 50);
    assert_eq!(peers.visits.len(), MAX_VISITS);
}

#[test]
fn memory_is_bounded_for_any_number_of_peers() {
    let mut peers = Peers::default();
    for index in 0..1000 {
        let id = AgentId::robot(0, index);
        peers.update_destination(id, goal(HERE), CommitmentStatus::Active, 0.0);
    }
    assert_eq!(peers.mates.len(), MAX_PEERS);
}
