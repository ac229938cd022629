//! Of lanes with a stated risk r, a share r is not clear.

use super::simulated::{
    Item, Random, Searcher, Sensor, clearance, items, picture, with_lookalikes,
};
use crate::clearance::{Clearance, LanePicture};
use brain::{AgentId, GoalId, MarkVerdict, Statement};

/// Places are neutralised above this probability of a mine: an attempt in vain is rare.
const NEUTRALISE_ABOVE: f64 = 0.95;

/// Blind shares of both models: the floor of the risk is 0.8% with two mines.
pub(super) const BLIND: [f64; 2] = [0.08, 0.05];

/// Expected mines and clutter.
const EXPECTED: [f64; 2] = [2.0, 4.0];

/// Shares of the mines that look like clutter to both models.
const ALIKE: [f64; 2] = [0.3, 0.2];

const LANES: u64 = 30_000;

/// A goal of a controller.
const GOAL: GoalId = GoalId {
    issuer: brain::Issuer::Agent(AgentId::OPERATOR),
    number: 0,
};

/// Limits of the stated risk.
const LIMITS: [f64; 10] = [0.01, 0.02, 0.035, 0.06, 0.1, 0.15, 0.2, 0.28, 0.38, 0.5];

const SENSORS: [Sensor; 2] = [
    Sensor {
        detection: 0.4,
        is_right: 0.7,
        false_alarms_per_m2: 0.001,
        noise_m: 0.1,
    },
    Sensor {
        detection: 0.75,
        is_right: 0.95,
        false_alarms_per_m2: 0.0003,
        noise_m: 0.05,
    },
];

/// Number, mean stated risk and share of lanes that are not clear, by stated risk.
#[derive(Debug, Default, Clone, Copy)]
struct Bin {
    lanes: f64,
    stated: f64,
    left: f64,
}

/// Two robots of each model look at random cells, up to some passes.
pub(super) fn search(
    clearance: &Clearance,
    picture: &mut LanePicture,
    loss: f64,
    random: &mut Random,
) -> Vec<Item> {
    let mut items = items(clearance, random);
    for (kind, max_looks) in [(0, 12.0), (1, 6.0)] {
        for index in 0..2 {
            let share = random.unit().sqrt();
            let passes = (random.unit() * max_looks) as u32 + 1;
            let cells = 0..clearance.lane.cells();
            let looks = cells.map(|_| if random.is(share) { passes } else { passes / 2 });
            let searcher = Searcher {
                id: AgentId::robot(kind, index),
                sensor: &SENSORS[usize::from(kind)],
                loss,
                looks: looks.collect(),
            };
            searcher.search(&mut items, picture, random);
        }
    }
    items
}

/// Looks again where something has been destroyed.
fn search_again(
    cells: &[usize],
    (picture, items): (&mut LanePicture, &mut Vec<Item>),
    random: &mut Random,
) {
    for kind in 0..2 {
        let all = 0..picture.clearance().lane.cells();
        let searcher = Searcher {
            id: AgentId::robot(kind, 2),
            sensor: &SENSORS[usize::from(kind)],
            loss: 0.0,
            looks: all
                .map(|cell| if cells.contains(&cell) { 12 } else { 0 })
                .collect(),
        };
        searcher.search(items, picture, random);
    }
}

/// Destroys what is at places that probably hold a mine. Returns their cells.
pub(super) fn neutralise(picture: &mut LanePicture, items: &mut Vec<Item>) -> Vec<usize> {
    let mut cells = Vec::new();
    let probable = picture.marks().filter(|mark| mark.mine > NEUTRALISE_ABOVE);
    let probable: Vec<_> = probable.collect();
    for mark in probable {
        let numbered = items.iter().enumerate();
        let away = numbered.map(|(index, item)| (item.at.to(mark.at).length(), index));
        let nearest = away.min_by(|one, other| one.0.total_cmp(&other.0));
        if let Some((_, index)) = nearest.filter(|(away_m, _)| *away_m < 0.5) {
            items.remove(index);
            cells.push(picture.clearance().lane.nearest_cell(mark.at));
            picture.take_statement(&Statement {
                mark: GOAL,
                at_m: [mark.at.x as f32, mark.at.y as f32],
                verdict: MarkVerdict::Neutralised,
            });
        }
    }
    cells
}

/// Lanes by the risk that a controller states which assumes these blind shares.
fn bins(assumed: [f64; 2], loss: f64) -> Vec<Bin> {
    let (truth, assumed) = (clearance(EXPECTED, BLIND), clearance(EXPECTED, assumed));
    bins_of(LANES, (&truth, &assumed), loss)
}

fn bins_of(lanes: u64, (truth, assumed): (&Clearance, &Clearance), loss: f64) -> Vec<Bin> {
    let mut bins = vec![Bin::default(); LIMITS.len() - 1];
    for lane in 0..lanes {
        let mut random = Random(lane.wrapping_mul(0x1234_5678_9abc_def1));
        let mut picture = picture(assumed);
        let mut items = search(truth, &mut picture, loss, &mut random);
        let destroyed = neutralise(&mut picture, &mut items);
        search_again(&destroyed, (&mut picture, &mut items), &mut random);
        let stated = picture.risk().probability;
        let bin = LIMITS.iter().filter(|limit| stated >= **limit).count();
        if picture.missing_marks() == 0 && (1..LIMITS.len()).contains(&bin) {
            let is_left = items.iter().any(|item| item.kind == 0);
            let bin = &mut bins[bin - 1];
            bin.lanes += 1.0;
            bin.stated += stated;
            bin.left += f64::from(u8::from(is_left));
        }
    }
    bins.into_iter()
        .map(|bin| Bin {
            stated: bin.stated / bin.lanes,
            left: bin.left / bin.lanes,
            ..bin
        })
        .collect()
}

/// The stated tolerance, and three standard errors of the share.
fn is_calibrated(bin: &Bin) -> bool {
    let error = (bin.stated * (1.0 - bin.stated) / bin.lanes).sqrt();
    (bin.left - bin.stated).abs() <= (0.2 * bin.stated).max(0.005) + 3.0 * error
}

/// By chance, each bin fails with a probability below 0.3%, as it would at the edge of the tolerance.
#[test]
fn of_lanes_with_a_stated_risk_that_share_is_not_clear() {
    let bins = bins(BLIND, 0.0);
    for bin in &bins {
        assert!(
            bin.lanes >= 500.0 && is_calibrated(bin),
            "{bin:?} of {bins:#?}"
        );
    }
}

/// Looks of which no message arrives do not count, so that more lanes are clear than stated.
#[test]
fn lost_messages_never_make_a_lane_look_safer() {
    let bins = bins(BLIND, 0.3);
    for bin in &bins {
        let is_less = bin.left < bin.stated || is_calibrated(bin);
        assert!(bin.lanes >= 250.0 && is_less, "{bin:?} of {bins:#?}");
    }
    let sum = |value: fn(&Bin) -> f64| bins.iter().map(|bin| bin.lanes * value(bin)).sum::<f64>();
    assert!(
        sum(|bin| bin.stated) > 1.1 * sum(|bin| bin.left),
        "{bins:#?}"
    );
}

#[test]
fn a_controller_that_ignores_blindness_understates_the_risk() {
    let bins = bins([0.0, 0.0], 0.0);
    let wrong = bins
        .iter()
        .filter(|bin| bin.lanes >= 500.0 && !is_calibrated(bin));
    assert!(wrong.clone().count() >= 3, "{bins:#?}");
    for bin in wrong {
        assert!(bin.left > bin.stated, "{bin:?}");
    }
}

/// By chance, each bin fails with a probability below 0.3%, as it would at the edge of the tolerance.
#[test]
fn with_mines_that_look_like_clutter_the_stated_share_of_lanes_is_not_clear() {
    let lane = with_lookalikes(clearance(EXPECTED, BLIND), ALIKE);
    let bins = bins_of(LANES / 3, (&lane, &lane), 0.0);
    for bin in bins.iter().filter(|bin| bin.lanes >= 200.0) {
        assert!(is_calibrated(bin), "{bin:?} of {bins:#?}");
    }
    let enough = bins.iter().filter(|bin| bin.lanes >= 200.0);
    assert!(enough.count() >= 6, "{bins:#?}");
}

#[test]
fn a_controller_that_ignores_lookalikes_understates_the_risk() {
    let assumed = clearance(EXPECTED, BLIND);
    let truth = with_lookalikes(assumed.clone(), ALIKE);
    let bins = bins_of(LANES / 3, (&truth, &assumed), 0.0);
    let wrong = bins
        .iter()
        .filter(|bin| bin.lanes >= 200.0 && !is_calibrated(bin));
    assert!(wrong.clone().count() >= 3, "{bins:#?}");
    for bin in wrong {
        assert!(bin.left > bin.stated, "{bin:?}");
    }
}
