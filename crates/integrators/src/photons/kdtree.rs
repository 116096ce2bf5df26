//! A k-d tree of points: all within a radius, or the k nearest.
//!
//! The tree is implicit (Bentley 1975): the points are put in an order in which the middle of
//! every range parts it by one coordinate, the one along which the range is longest; left of the
//! middle is what lies below, right of it what lies above. Points that share a coordinate are
//! parted by their numbers, so that the tree is a function of the points alone: neither the number
//! of threads that build it nor how they divide the work can change it.

use core::cmp::Ordering;
use glam::Vec3;

/// Ranges with fewer points are not divided among threads.
const ALONE: usize = 4096;

/// A k-d tree.
#[derive(Clone, Debug, Default)]
pub struct KdTree {
    points: Vec<Vec3>,
    /// The axis of each node's split.
    axes: Vec<u8>,
}

/// A point that a query found, by its place in the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbour {
    /// Squared distance (m²).
    pub distance_squared: f32,
    /// Place in the order that [`KdTree::new`] gave.
    pub place: usize,
}

impl Neighbour {
    /// Nearer first, then the smaller place.
    fn order(&self, other: &Self) -> Ordering {
        let by_distance = self.distance_squared.total_cmp(&other.distance_squared);
        by_distance.then(self.place.cmp(&other.place))
    }
}

impl KdTree {
    /// The tree of some points, and the order in which it keeps them: the number of the point at
    /// each place. Uses the current thread pool.
    pub fn new(points: impl IntoIterator<Item = Vec3>) -> (Self, Vec<u32>) {
        let mut numbered: Vec<(Vec3, u32)> = points.into_iter().zip(0..).collect();
        let mut axes = vec![0; numbered.len()];
        part(&mut numbered, &mut axes);
        let (points, order) = numbered.into_iter().unzip();
        (Self { points, axes }, order)
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Visits all points not farther than the root of `radius_squared`, always in the same order.
    #[inline]
    pub fn within(&self, centre: Vec3, radius_squared: f32, mut visit: impl FnMut(Neighbour)) {
        self.search(centre, radius_squared, |found, bound| {
            visit(found);
            bound
        });
    }

    /// The points that [`KdTree::within`] visits, in the same order, in `found`, if there are at most `most`. Whether that is so;
    /// if not, no more than one beyond are visited.
    pub fn within_at_most(
        &self,
        centre: Vec3,
        radius_squared: f32,
        most: usize,
        found: &mut Vec<Neighbour>,
    ) -> bool {
        found.clear();
        self.search(centre, radius_squared, |point, bound| {
            found.push(point);
            // Nothing is within a negative bound.
            if found.len() > most { -1.0 } else { bound }
        });
        found.len() <= most
    }

    /// The `count` nearest points (fewer if there are no more within the root of `radius_squared`)
    /// in `nearest`, nearest first.
    pub fn nearest(
        &self,
        centre: Vec3,
        count: usize,
        radius_squared: f32,
        nearest: &mut Vec<Neighbour>,
    ) {
        nearest.clear();
        if count == 0 {
            return;
        }
        self.search(centre, radius_squared, |found, bound| {
            let place = nearest.partition_point(|other| other.order(&found).is_lt());
            if nearest.len() == count {
                if place == count {
                    return bound;
                }
                nearest.pop();
            }
            nearest.insert(place, found);
            match nearest.last() {
                Some(last) if nearest.len() == count => last.distance_squared,
                _ => bound,
            }
        });
    }

    /// Visits points not farther than the root of a bound that each visit may lower.
    #[inline]
    fn search(&self, centre: Vec3, mut bound: f32, mut visit: impl FnMut(Neighbour, f32) -> f32) {
        // Ranges still to be searched, and how far they are at least. A tree of 2³² points has 32
        // levels.
        let mut stack = [(0, 0, 0.0_f32); 40];
        let mut top = 0;
        let mut range = (0, self.points.len());
        loop {
            while range.0 < range.1 {
                let middle = range.0 + (range.1 - range.0) / 2;
                let point = self.points[middle];
                let distance_squared = point.distance_squared(centre);
                if distance_squared <= bound {
                    let place = middle;
                    bound = visit(
                        Neighbour {
                            distance_squared,
                            place,
                        },
                        bound,
                    );
                }
                let axis = usize::from(self.axes[middle]);
                let beyond = centre[axis] - point[axis];
                let (below, above) = ((range.0, middle), (middle + 1, range.1));
                let (near, far) = if beyond < 0.0 {
                    (below, above)
                } else {
                    (above, below)
                };
                stack[top] = (far.0, far.1, beyond * beyond);
                top += 1;
                range = near;
            }
            range = loop {
                if top == 0 {
                    return;
                }
                top -= 1;
                let (low, high, at_least) = stack[top];
                if low < high && at_least <= bound {
                    break (low, high);
                }
            };
        }
    }
}

/// Orders the points of a range.
fn part(points: &mut [(Vec3, u32)], axes: &mut [u8]) {
    if points.len() < 2 {
        return;
    }
    let (mut low, mut high) = (points[0].0, points[0].0);
    for (point, _) in points.iter() {
        low = low.min(*point);
        high = high.max(*point);
    }
    let axis = (high - low).max_position();
    let middle = points.len() / 2;
    points.select_nth_unstable_by(middle, |a, b| {
        a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1))
    });
    axes[middle] = axis as u8;
    let alone = points.len() < ALONE;
    let (below, above) = points.split_at_mut(middle);
    let (axes_below, axes_above) = axes.split_at_mut(middle);
    let (above, axes_above) = (&mut above[1..], &mut axes_above[1..]);
    if alone {
        part(below, axes_below);
        part(above, axes_above);
    } else {
        rayon::join(|| part(below, axes_below), || part(above, axes_above));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use proptest::test_runner::RngSeed;

    /// Points of which many share coordinates, and some coincide.
    fn points() -> impl Strategy<Value = Vec<Vec3>> {
        let coordinate = prop_oneof![(-4_i8..=4).prop_map(f32::from), -4.0_f32..4.0, Just(-0.0)];
        let point = [coordinate.clone(), coordinate.clone(), coordinate].prop_map(Vec3::from_array);
        proptest::collection::vec(point, 0..300)
    }

    /// The result of a linear scan: indices and squared distances, nearest first.
    fn scan(points: &[Vec3], centre: Vec3, radius_squared: f32) -> Vec<(f32, u32)> {
        let mut found: Vec<(f32, u32)> = (points.iter().zip(0..))
            .map(|(point, number)| (point.distance_squared(centre), number))
            .filter(|(distance, _)| *distance <= radius_squared)
            .collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 300,
            rng_seed: RngSeed::Fixed(4),
            failure_persistence: None,
            ..ProptestConfig::default()
        })]

        #[test]
        fn finds_what_a_linear_scan_finds(
            points in points(),
            centre in [-5.0_f32..5.0, -5.0_f32..5.0, -5.0_f32..5.0],
            at_a_point in any::<bool>(),
            radius in 0.0_f32..6.0,
            count in 0_usize..40,
        ) {
            let (tree, order) = KdTree::new(points.iter().copied());
            let centre = match points.first() {
                Some(first) if at_a_point => *first,
                _ => Vec3::from_array(centre),
            };
            let expected = scan(&points, centre, radius * radius);
            let mut found = Vec::new();
            tree.within(centre, radius * radius, |point| {
                found.push((point.distance_squared, order[point.place]));
            });
            let mut limited = Vec::new();
            let all = tree.within_at_most(centre, radius * radius, count, &mut limited);
            prop_assert_eq!(all, found.len() <= count);
            let limited: Vec<_> = limited.iter().map(|f| (f.distance_squared, order[f.place])).collect();
            prop_assert_eq!(&limited, &found[..found.len().min(count + 1)]);
            found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            prop_assert_eq!(&found, &expected);
            // Among points at the same distance, any may be the last of the nearest.
            let mut nearest = Vec::new();
            tree.nearest(centre, count, radius * radius, &mut nearest);
            let distances: Vec<f32> = nearest.iter().map(|n| n.distance_squared).collect();
            let expected: Vec<f32> = expected.iter().take(count).map(|e| e.0).collect();
            prop_assert_eq!(distances, expected);
            for near in &nearest {
                let point = points[order[near.place] as usize];
                prop_assert_eq!(point.distance_squared(centre), near.distance_squared);
            }
        }
    }

    #[test]
    fn the_tree_is_the_same_for_any_number_of_threads() {
        let scatter = |i: u32| {
            let hash = etalon_sampling::hash::mix64(u64::from(i % 60_000));
            Vec3::new(
                (hash % 97) as f32,
                (hash >> 20 & 63) as f32,
                i as f32 % 31.0,
            )
        };
        let points: Vec<Vec3> = (0..100_000).map(scatter).collect();
        let trees = [1, 2, 16].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let pool = pool.build().expect("a pool");
            let (tree, order) = pool.install(|| KdTree::new(points.iter().copied()));
            (tree.axes, order)
        });
        assert!(trees[0] == trees[1] && trees[1] == trees[2]);
    }
}
