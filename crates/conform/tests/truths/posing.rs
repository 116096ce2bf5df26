//! What a pose keeps, and what a scene is as text.

use etalon_conform::pose::{Freedom, Pose};
use etalon_conform::questions::ALL;
use etalon_conform::scene::{Scene, VERSION};
use glam::DVec3;
use proptest::prelude::*;

fn places() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-10.0..10.0f64).prop_map(DVec3::from)
}

proptest! {
    #[test]
    fn poses_keep_ratios_angles_and_hands(
        seed: u64,
        index in 0..1000u32,
        a in places(),
        b in places(),
        c in places(),
    ) {
        let pose = Pose::draw(seed, index, Freedom::Any);
        prop_assert!((0.5..=2.0).contains(&pose.scale));
        prop_assert!(pose.shift.abs().max_element() <= 1.0);
        let [p, q, r] = [a, b, c].map(|point| pose.point(point));
        let near = |found: f64, expected: f64| (found - expected).abs() < 1e-9;
        // One factor for all lengths, and for their products.
        let square = pose.scale * pose.scale;
        prop_assert!(near((q - p).dot(r - p), square * (b - a).dot(c - a)));
        prop_assert!(near(p.distance(q), pose.scale * a.distance(b)));
        // The sign of the volume says which hand.
        let volume = |u: DVec3, v: DVec3, w: DVec3| u.cross(v).dot(w);
        let [u, v, w] = [a, b, c].map(|vector| pose.direction(vector));
        prop_assert!(near(volume(u, v, w), volume(a, b, c)));
        // Points, vectors and directions agree.
        prop_assert!((q - p - pose.vector(b - a)).length() < 1e-9);
    }
}

#[test]
fn poses_repeat_and_differ() {
    let draw = |seed, index| Pose::draw(seed, index, Freedom::Any);
    assert_eq!(draw(5, 2), draw(5, 2));
    assert_ne!(draw(5, 2), draw(5, 3));
    assert_ne!(draw(5, 2), draw(6, 2));
    let about = Pose::draw(5, 2, Freedom::AboutOrigin);
    assert_eq!(about.point(DVec3::ZERO), DVec3::ZERO);
    assert_eq!(about.rotation, draw(5, 2).rotation);
}

#[test]
fn names_are_words_of_small_letters() {
    for question in ALL {
        let word = |word: &str| {
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '.';
            !word.is_empty() && word.chars().all(plain)
        };
        assert!(question.name.split('-').all(word), "{}", question.name);
        let told = [question.title, question.formula, question.source];
        assert!(told.iter().all(|text| !text.is_empty()), "{question:?}");
        assert!(question.samples.is_power_of_two(), "{question:?}");
    }
}

#[test]
fn scenes_are_read_as_they_were_written() {
    for question in ALL {
        for index in 0..3 {
            let (scene, truth) = question.posed(11, index);
            let read: Scene = serde_json::from_str(&scene.to_json()).expect("our own text");
            assert_eq!(read, scene, "{question:?}");
            assert_eq!((scene.version, &*scene.question), (VERSION, question.name));
            assert_eq!(truth.pixels, scene.pixels);
            assert_eq!(truth.means.len() as u32, truth.pixels * truth.pixels);
            let sound = |mean: &f64| mean.is_finite() && *mean >= 0.0;
            assert!(truth.means.iter().all(sound), "{question:?}");
        }
    }
}
