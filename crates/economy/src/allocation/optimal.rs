//! The assignment of goals to idle robots, at most one goal per robot, that assigns the maximum
//! number of goals and among those has the smallest sum of costs.
//!
//! Shortest augmenting paths with potentials (Kuhn, *The Hungarian method for the assignment
//! problem*, 1955; Jonker and Volgenant, *A shortest augmenting path algorithm for dense and sparse
//! linear assignment problems*, 1987): O(n² m) for n rows and m >= n columns.

use super::{Market, Pair};
use alloc::vec::Vec;

pub(super) fn choose(market: &Market) -> Vec<Pair> {
    let idle = market.is_idle.iter().enumerate().filter(|(_, idle)| **idle);
    let idle: Vec<usize> = idle.map(|(robot, _)| robot).collect();
    let mut column_of = alloc::vec![usize::MAX; market.is_idle.len()];
    for (column, robot) in idle.iter().enumerate() {
        column_of[*robot] = column;
    }
    let mut costs_s = alloc::vec![f64::INFINITY; market.goals * idle.len()];
    for offer in &market.offers {
        let column = column_of[offer.pair.robot];
        if column < idle.len() {
            costs_s[offer.pair.goal * idle.len() + column] = offer.cost_s;
        }
    }
    let assigned = assignment([market.goals, idle.len()], &costs_s);
    let pairs = assigned.into_iter().enumerate();
    pairs
        .filter_map(|(goal, column)| {
            let robot = idle[column?];
            Some(Pair { goal, robot })
        })
        .collect()
}

/// The column of each row in the assignment of rows to different columns with the maximum number of
/// pairs and, among those, the smallest sum of costs; `None` for a row without a column.
///
/// `costs` are by rows; one that is not finite forbids its pair. The same costs always give the same
/// assignment: of equal paths, the one to the lowest column is taken.
///
/// ```
/// let costs = [4.0, 1.0, 3.0, 2.0, 0.0, 5.0];
/// assert_eq!(economy::assignment([2, 3], &costs), [Some(1), Some(0)]);
/// ```
#[must_use]
pub fn assignment([rows, columns]: [usize; 2], costs: &[f64]) -> Vec<Option<usize>> {
    let at = |row: usize, column: usize| costs.get(row * columns + column).copied();
    let allowed = |row: usize, column: usize| at(row, column).filter(|cost| cost.is_finite());
    // Without the rows and columns that cannot be assigned, which would make all paths long.
    let own = |row: &usize| (0..columns).any(|column| allowed(*row, column).is_some());
    let left: Vec<usize> = (0..rows).filter(own).collect();
    let other = |column: &usize| left.iter().any(|row| allowed(*row, *column).is_some());
    let right: Vec<usize> = (0..columns).filter(other).collect();
    let most = costs.iter().filter(|cost| cost.is_finite());
    let most = most.fold(0.0, |most: f64, cost| most.max(cost.abs()));
    // A forbidden pair costs more than any assignment without it.
    #[expect(clippy::cast_precision_loss, reason = "some thousands")]
    let forbidden = 2.0 * (most + 1.0) * (left.len().min(right.len()) + 1) as f64;
    let cost = |row: usize, column: usize| allowed(left[row], right[column]).unwrap_or(forbidden);
    let mut column_of = alloc::vec![None; rows];
    for (row, column) in pairs([left.len(), right.len()], cost) {
        let (row, column) = (left[row], right[column]);
        column_of[row] = allowed(row, column).map(|_| column);
    }
    column_of
}

/// The rows and columns of the assignment with the smallest sum of costs.
fn pairs([rows, columns]: [usize; 2], cost: impl Fn(usize, usize) -> f64) -> Vec<(usize, usize)> {
    if rows <= columns {
        let assigned = Paths::new(columns).assigned(rows, cost);
        assigned.map(|(column, row)| (row, column)).collect()
    } else {
        let assigned = Paths::new(rows).assigned(columns, |column, row| cost(row, column));
        assigned.collect()
    }
}

/// The search for augmenting paths, with at least as many columns as rows.
struct Paths {
    row_potential: Vec<f64>,
    column_potential: Vec<f64>,
    /// The row of each column.
    row_of: Vec<Option<usize>>,
    /// Of the path to each column: its length, and the column before.
    length: Vec<f64>,
    before: Vec<Option<usize>>,
    is_final: Vec<bool>,
}

impl Paths {
    fn new(columns: usize) -> Self {
        Self {
            row_potential: Vec::new(),
            column_potential: alloc::vec![0.0; columns],
            row_of: alloc::vec![None; columns],
            length: alloc::vec![0.0; columns],
            before: alloc::vec![None; columns],
            is_final: alloc::vec![false; columns],
        }
    }

    /// Columns with their rows.
    fn assigned(
        mut self,
        rows: usize,
        cost: impl Fn(usize, usize) -> f64,
    ) -> impl Iterator<Item = (usize, usize)> {
        self.row_potential.resize(rows, 0.0);
        for row in 0..rows {
            let end = self.search(row, &cost);
            self.augment(row, end);
        }
        let columns = self.row_of.into_iter().enumerate();
        columns.filter_map(|(column, row)| Some((column, row?)))
    }

    /// The free column at the end of the shortest path from a new row.
    fn search(&mut self, new: usize, cost: &impl Fn(usize, usize) -> f64) -> usize {
        self.length.fill(f64::INFINITY);
        self.before.fill(None);
        self.is_final.fill(false);
        let (mut row, mut last, mut reached) = (new, None, 0.0);
        loop {
            let (next, length) = self.extend(row, last, reached, cost);
            self.is_final[next] = true;
            (last, reached) = (Some(next), length);
            let Some(assigned) = self.row_of[next] else {
                self.raise(new, length);
                return next;
            };
            row = assigned;
        }
    }

    /// Extends the paths by the edges of a row, which was reached over a column; returns the nearest
    /// column that is not final, and the length of the path to it.
    fn extend(
        &mut self,
        row: usize,
        last: Option<usize>,
        reached: f64,
        cost: &impl Fn(usize, usize) -> f64,
    ) -> (usize, f64) {
        let (mut nearest, mut shortest) = (0, f64::INFINITY);
        let base = reached - self.row_potential[row];
        for column in 0..self.length.len() {
            if self.is_final[column] {
                continue;
            }
            let length = base + cost(row, column) - self.column_potential[column];
            if length < self.length[column] {
                (self.length[column], self.before[column]) = (length, last);
            }
            if self.length[column] < shortest {
                (nearest, shortest) = (column, self.length[column]);
            }
        }
        (nearest, shortest)
    }

    /// Changes the potentials so that no reduced cost is negative after the augmentation.
    fn raise(&mut self, new: usize, length: f64) {
        self.row_potential[new] += length;
        for column in 0..self.length.len() {
            if let (true, Some(row)) = (self.is_final[column], self.row_of[column]) {
                let change = length - self.length[column];
                self.row_potential[row] += change;
                self.column_potential[column] -= change;
            }
        }
    }

    /// Moves each row on the path one column further.
    fn augment(&mut self, new: usize, end: usize) {
        let mut column = end;
        while let Some(before) = self.before[column] {
            self.row_of[column] = self.row_of[before];
            column = before;
        }
        self.row_of[column] = Some(new);
    }
}

#[cfg(test)]
mod tests {
    use super::super::market::market_of;
    use super::*;
    use proptest::prelude::*;

    /// Number of pairs, and the sum of their costs.
    fn total(columns: usize, costs: &[f64], assigned: &[Option<usize>]) -> (usize, f64) {
        let pairs = assigned.iter().enumerate();
        let pairs = pairs.filter_map(|(row, column)| Some(costs[row * columns + (*column)?]));
        let costs: Vec<f64> = pairs.collect();
        (costs.len(), costs.iter().sum())
    }

    /// The best total by trying every assignment of the rows from one on.
    fn brute_force([row, rows, columns]: [usize; 3], costs: &[f64], used: u32) -> (usize, f64) {
        if row == rows {
            return (0, 0.0);
        }
        let next = [row + 1, rows, columns];
        let mut best = brute_force(next, costs, used);
        for column in (0..columns).filter(|column| used >> column & 1 == 0) {
            let cost = costs[row * columns + column];
            if cost.is_finite() {
                let (pairs, sum) = brute_force(next, costs, used | 1 << column);
                let this = (pairs + 1, sum + cost);
                if this.0 > best.0 || (this.0 == best.0 && this.1 < best.1) {
                    best = this;
                }
            }
        }
        best
    }

    fn costs() -> impl Strategy<Value = ([usize; 2], Vec<f64>)> {
        (1_usize..6, 1_usize..6).prop_flat_map(|(rows, columns)| {
            let cost = prop_oneof![
                3 => (0_u8..6).prop_map(f64::from),
                3 => 0.0..100.0,
                1 => Just(f64::INFINITY),
            ];
            let costs = proptest::collection::vec(cost, rows * columns);
            costs.prop_map(move |costs| ([rows, columns], costs))
        })
    }

    proptest! {
        #[test]
        fn no_assignment_is_better((size, costs) in costs()) {
            let assigned = assignment(size, &costs);
            let (pairs, sum) = total(size[1], &costs, &assigned);
            let best = brute_force([0, size[0], size[1]], &costs, 0);
            prop_assert_eq!(pairs, best.0);
            prop_assert!((sum - best.1).abs() < 1e-9 * (1.0 + best.1), "{} {}", sum, best.1);
        }

        #[test]
        fn no_column_has_two_rows((size, costs) in costs()) {
            let assigned = assignment(size, &costs);
            let mut columns: Vec<usize> = assigned.into_iter().flatten().collect();
            let count = columns.len();
            columns.sort_unstable();
            columns.dedup();
            prop_assert_eq!(columns.len(), count);
        }
    }

    #[test]
    fn ties_go_to_the_lowest_column_and_numbers_that_are_not_finite_forbid() {
        assert_eq!(assignment([1, 3], &[1.0, 1.0, 1.0]), [Some(0)]);
        assert_eq!(
            assignment([1, 3], &[f64::NAN, f64::INFINITY, 1.0]),
            [Some(2)]
        );
        assert_eq!(assignment([1, 1], &[f64::NAN]), [None]);
        assert_eq!(assignment([2, 0], &[]), [None, None]);
        assert_eq!(assignment([0, 2], &[]), []);
    }

    #[test]
    fn a_robot_that_serves_a_goal_gets_no_other() {
        let mut market = market_of(&[&[1.0, 5.0], &[2.0, 9.0]]);
        assert_eq!(choose(&market).len(), 2);
        market.is_idle[0] = false;
        assert_eq!(choose(&market), [Pair { goal: 0, robot: 1 }]);
    }
}
