use super::*;

const MATE: RobotId = RobotId { kind: 0, index: 1 };
const HERE: Point = Point { x: 1.0, y: 1.0 };
const THERE: Point = Point { x: 3.0, y: 1.0 };

fn looked(peers: &mut Peers, at: Point, observations: u32, age_s: f64) -> (Point, u32, f64) {
    let value = (at, observations);
    peers.looked(MATE, Reading { value, age_s })
}

fn place(peers: &Peers) -> Option<Point> {
    peers.mates.iter().find_map(Peer::at)
}

fn is_taken(peers: &Peers, to: Point) -> bool {
    peers.anybody_goes(to, |_| true)
}

#[test]
fn looks_between_two_messages_are_those_that_came_between() {
    let mut peers = Peers::default();
    assert_eq!(looked(&mut peers, HERE, 7, 0.0), (HERE, 1, f64::INFINITY));
    peers.pass(2.0);
    assert_eq!(looked(&mut peers, THERE, 12, 0.5), (HERE, 5, 1.5));
    assert_eq!(looked(&mut peers, THERE, 12, 0.5), (THERE, 0, 0.0));
}

#[test]
fn a_message_that_was_overtaken_tells_no_more_looks_and_no_place() {
    let mut peers = Peers::default();
    looked(&mut peers, HERE, 7, 0.0);
    peers.stands(MATE, HERE, 0.0);
    assert_eq!(looked(&mut peers, THERE, 20, 1.0).1, 0);
    peers.stands(MATE, THERE, 1.0);
    assert_eq!(place(&peers), Some(HERE));
    peers.pass(1.0);
    assert_eq!(looked(&mut peers, THERE, 9, 0.0), (HERE, 2, 1.0));
}

#[test]
fn where_one_goes_is_known_until_it_is_there_or_not_heard_of() {
    let mut peers = Peers::default();
    peers.goes(MATE, THERE, CommitmentStatus::Active, 0.0);
    assert!(is_taken(&peers, THERE) && !peers.anybody_goes(THERE, |id| id != MATE));
    for status in [CommitmentStatus::Done, CommitmentStatus::Released] {
        peers.goes(MATE, THERE, CommitmentStatus::Active, 0.0);
        peers.goes(MATE, THERE, status, 0.0);
        assert!(!is_taken(&peers, THERE));
    }
    peers.goes(MATE, THERE, CommitmentStatus::Active, 0.0);
    peers.pass(9.9);
    assert!(is_taken(&peers, THERE));
    peers.pass(0.2);
    assert!(!is_taken(&peers, THERE));
}

#[test]
fn who_goes_on_telling_where_it_is_holds_no_place_for_that() {
    let mut peers = Peers::default();
    peers.goes(MATE, THERE, CommitmentStatus::Active, 0.0);
    for _ in 0..11 {
        peers.pass(1.0);
        peers.stands(MATE, HERE, 0.0);
    }
    assert_eq!(place(&peers), Some(HERE));
    assert!(!is_taken(&peers, THERE));
}

#[test]
fn an_age_begins_at_that_of_the_message_and_what_is_too_old_is_not_taken() {
    let mut peers = Peers::default();
    peers.goes(MATE, THERE, CommitmentStatus::Active, 500.0);
    peers.stands(MATE, HERE, 500.0);
    assert!(!is_taken(&peers, THERE) && place(&peers).is_none());
    peers.goes(MATE, THERE, CommitmentStatus::Active, 9.0);
    peers.stands(MATE, HERE, 9.0);
    assert!(is_taken(&peers, THERE) && place(&peers) == Some(HERE));
    peers.pass(1.1);
    assert!(!is_taken(&peers, THERE) && place(&peers).is_none());
}

#[test]
fn an_old_message_takes_back_nothing_that_was_said_after_it() {
    let mut peers = Peers::default();
    peers.goes(MATE, HERE, CommitmentStatus::Active, 1.0);
    peers.goes(MATE, THERE, CommitmentStatus::Active, 4.0);
    peers.goes(MATE, HERE, CommitmentStatus::Released, 2.0);
    assert!(is_taken(&peers, HERE) && !is_taken(&peers, THERE));
    peers.goes(MATE, HERE, CommitmentStatus::Released, 0.5);
    peers.goes(MATE, HERE, CommitmentStatus::Active, 1.0);
    assert!(!is_taken(&peers, HERE));
}

#[test]
fn where_others_have_been_is_told_once() {
    let (mut peers, mut since) = (Peers::default(), 0);
    for x in 0..100 {
        let at = Point {
            x: f64::from(x),
            y: 0.0,
        };
        peers.goes(MATE, at, CommitmentStatus::Done, 100.0);
        peers.goes(MATE, at, CommitmentStatus::Released, 0.0);
        if x < 50 {
            assert_eq!(peers.visits_since(&mut since), [at]);
            assert_eq!(peers.visits_since(&mut since), []);
        }
    }
    assert_eq!(peers.visits_since(&mut since).len(), 50);
    assert_eq!(peers.visits.len(), MOST_VISITS);
}

#[test]
fn a_crowd_takes_bounded_memory() {
    let mut peers = Peers::default();
    for index in 0..1000 {
        let id = RobotId { kind: 0, index };
        peers.goes(id, Point::default(), CommitmentStatus::Active, 0.0);
    }
    assert_eq!(peers.mates.len(), MOST);
}
