//! An order in which each thing comes after those that it refers to.

/// How deep things may refer to each other, so that one may follow references by recursion.
pub(crate) const MOST_LEVELS: usize = 128;

/// How many circles are told.
const MOST_TANGLES: usize = 50;

/// What stands against an order.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Tangle {
    /// Things that refer to each other in a circle.
    Circle(Vec<usize>),
    /// A thing whose references are more than [`MOST_LEVELS`] deep.
    Depth(usize),
}

/// The order of things by what each of them refers to. References that close a circle are left out, and the circle is told.
pub(crate) fn order(references: &[Vec<usize>]) -> (Vec<usize>, Vec<Tangle>) {
    let mut search = Search {
        references,
        state: vec![State::New; references.len()],
        order: Vec::with_capacity(references.len()),
        tangles: Vec::new(),
    };
    for root in 0..references.len() {
        search.visit(root);
    }
    (search.order, search.tangles)
}

/// A depth-first search.
struct Search<'a> {
    references: &'a [Vec<usize>],
    state: Vec<State>,
    order: Vec<usize>,
    tangles: Vec<Tangle>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    New,
    /// On the way from the root.
    Open,
    /// In the order; how many levels are below it.
    Done(usize),
}

impl Search<'_> {
    /// Puts a thing and all that it refers to into the order. The way is kept here rather than on the call stack, as it may be
    /// as long as the scene.
    fn visit(&mut self, root: usize) {
        // Each thing on the way with the number of its references that were followed, and the levels below them.
        let mut way = vec![(root, 0, 0)];
        if self.state[root] != State::New {
            return;
        }
        self.state[root] = State::Open;
        while let Some((thing, followed, levels)) = way.last_mut() {
            let thing = *thing;
            let Some(&next) = self.references[thing].get(*followed) else {
                let levels = *levels;
                if levels == MOST_LEVELS {
                    self.tangles.push(Tangle::Depth(thing));
                }
                self.state[thing] = State::Done(levels);
                self.order.push(thing);
                way.pop();
                if let Some((_, _, above)) = way.last_mut() {
                    *above = levels.saturating_add(1).max(*above);
                }
                continue;
            };
            *followed += 1;
            match self.state[next] {
                State::Done(below) => *levels = (below + 1).max(*levels),
                State::New => {
                    self.state[next] = State::Open;
                    way.push((next, 0, 0));
                }
                // A circle may be as long as the scene, and there may be as many.
                State::Open if self.tangles.len() >= MOST_TANGLES => {}
                State::Open => {
                    let on_the_way = way.iter().map(|(thing, ..)| *thing);
                    let circle = on_the_way.skip_while(|thing| *thing != next).collect();
                    self.tangles.push(Tangle::Circle(circle));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_comes_after_what_it_refers_to() {
        let references = [vec![2, 1], vec![2], vec![], vec![0]];
        assert_eq!(order(&references), (vec![2, 1, 0, 3], vec![]));
    }

    #[test]
    fn circles_are_told() {
        let circle = |things: &[usize]| Tangle::Circle(things.to_vec());
        let (found, tangles) = order(&[vec![1], vec![2], vec![1]]);
        assert_eq!(found, [2, 1, 0]);
        assert_eq!(tangles, [circle(&[1, 2])]);
        assert_eq!(order(&[vec![0]]).1, [circle(&[0])]);
    }

    #[test]
    fn long_chains_are_told_once_and_cost_no_stack() {
        let mut chain: Vec<Vec<usize>> = (0..200_000).map(|i| vec![i + 1]).collect();
        chain.push(Vec::new());
        let (found, tangles) = order(&chain);
        assert_eq!(found.len(), chain.len());
        assert_eq!(tangles, [Tangle::Depth(200_000 - MOST_LEVELS)]);
    }
}
