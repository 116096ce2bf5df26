//! Bodies that overlap, by their sets.

use super::*;

const AIR: MediumId = MediumId::NONE;

/// Bodies of shapes with these priorities and media around the origin.
fn concentric(
    shapes: &[(u32, i64, u32)],
    camera: MediumId,
    is_simple: bool,
) -> (Bodies, Diagnostics) {
    let mut sources = etalon_params::Sources::default();
    let span = Span {
        file: sources.add("", ""),
        start: 0,
        end: 0,
    };
    let shapes = shapes.iter().map(|(shape, priority, medium)| {
        let (priority, medium) = (*priority, *medium);
        let (material, medium) = (MaterialId(priority as u32), MediumId(medium));
        let body = Body {
            priority,
            material,
            medium,
        };
        (ShapeId(*shape), body, span)
    });
    let shapes: Vec<_> = shapes.collect();
    let diagnostics = Diagnostics::new();
    let extent = |_| {
        let bounds = [Vec3::NEG_ONE, Vec3::ONE];
        Some(Extent { bounds, is_simple })
    };
    let bodies = Bodies::new(&shapes, 2, &[], camera, extent, &diagnostics);
    (bodies.expect("sound"), diagnostics)
}

/// Glass (3), ice (2) and juice (1), which is medium 1; medium 0 is fog.
fn bodies() -> Bodies {
    let shapes = [
        (0, 1, 1),
        (1, 3, u32::MAX),
        (2, 2, u32::MAX),
        (3, 2, u32::MAX),
    ];
    concentric(&shapes, MediumId(0), true).0
}

/// The priority that counts after entering (+) and leaving (−) shapes, and the medium.
fn walk(bodies: &Bodies, mut set: MediumId, way: &[i32]) -> (MediumId, i64, MediumId) {
    for step in way {
        let shape = ShapeId(step.unsigned_abs() - 1);
        let kind = bodies.of_shape(shape).expect("a body");
        set = bodies.after(set, kind, *step > 0);
    }
    let filling = bodies.filling(set);
    let priority = filling.body.map_or(0, |body| body.priority);
    (set, priority, filling.medium)
}

#[test]
fn the_strongest_body_counts_in_whatever_order_they_are_entered() {
    let bodies = bodies();
    for start in [AIR, MediumId(0)] {
        assert_eq!(walk(&bodies, start, &[]), (start, 0, start));
        assert_eq!(walk(&bodies, start, &[1]).1, 1);
        assert_eq!(walk(&bodies, start, &[1]).2, MediumId(1));
        // Into the wall of the glass before the juice in it ends.
        assert_eq!(walk(&bodies, start, &[1, 2]).1, 3);
        assert_eq!(walk(&bodies, start, &[1, 2, -1]).1, 3);
        assert_eq!(walk(&bodies, start, &[1, 2, -1, -2]), (start, 0, start));
        assert_eq!(
            walk(&bodies, start, &[2, 1]).0,
            walk(&bodies, start, &[1, 2]).0
        );
        assert_eq!(walk(&bodies, start, &[2, 1, -2]).2, MediumId(1));
        // Two pieces of ice, alike, that overlap: one is left, the other not.
        assert_eq!(walk(&bodies, start, &[1, 3, 4, -3]).1, 2);
        assert_eq!(walk(&bodies, start, &[1, 3, 4, -3, -4]).1, 1);
    }
}

#[test]
fn what_was_never_entered_is_not_left() {
    assert_eq!(walk(&bodies(), AIR, &[-2]).0, AIR);
}

/// In the one medium in which all sets of them can be listed.
#[test]
fn sixteen_bodies_in_each_other_are_told_apart() {
    let shapes: Vec<_> = (0..16).map(|index| (index, i64::from(index), 1)).collect();
    for is_simple in [true, false] {
        let (bodies, diagnostics) = concentric(&shapes, AIR, is_simple);
        assert!(diagnostics.into_sorted().is_empty());
        let mut set = AIR;
        for entered in 1..=16 {
            let (after, priority, _) = walk(&bodies, set, &[entered]);
            assert_eq!(priority, i64::from(entered) - 1);
            set = after;
        }
        for left in (1..=16).rev() {
            assert_eq!(walk(&bodies, set, &[]).1, i64::from(left) - 1);
            set = walk(&bodies, set, &[-left]).0;
        }
        assert_eq!(set, AIR);
    }
}

/// A mesh that cuts itself is entered twice before it is left.
#[test]
fn a_body_may_be_entered_again() {
    let (bodies, _) = concentric(&[(0, 1, 1), (1, 3, 1)], AIR, false);
    assert_eq!(walk(&bodies, AIR, &[1, 1, 2, 2, -1, -2]).1, 3);
    assert_eq!(walk(&bodies, AIR, &[1, 1, 2, 2, -1, -2, -2]).1, 1);
}

#[test]
fn bodies_that_are_too_many_to_tell_apart_are_told() {
    let shapes: Vec<_> = (0..20)
        .map(|index| (index, i64::from(index % 16), 1))
        .collect();
    let (bodies, diagnostics) = concentric(&shapes, MediumId(0), true);
    let message = diagnostics.into_sorted()[0].message.clone();
    assert!(
        message.contains("20 bodies") && message.contains("6 are told apart"),
        "{message}"
    );
    assert_eq!(walk(&bodies, AIR, &[1, 2, 3, 4, 5, 6]).1, 5);
    assert_eq!(walk(&bodies, AIR, &[1, 2, 3, 4, 5, 6, 7]).1, 5);
    assert!(bodies.fillings.len() as u64 <= MOST_SETS);
    assert_eq!(sets_by_size(&[1, 2], 3), [1, 2, 2, 1]);
}

#[test]
fn the_sides_of_a_surface_follow_from_where_a_ray_comes_from() {
    let bodies = bodies();
    let (juice, ..) = walk(&bodies, AIR, &[1]);
    let (both, ..) = walk(&bodies, AIR, &[1, 3]);
    let ice = bodies.of_shape(ShapeId(2)).expect("a body");
    let expected = MediumInterface {
        inside: both,
        outside: juice,
    };
    assert_eq!(bodies.around(ice, juice, true), expected);
    assert_eq!(bodies.around(ice, both, false), expected);
}
