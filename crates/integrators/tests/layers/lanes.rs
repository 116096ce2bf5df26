//! The four wavelengths of a path: whoever chooses, the sum over choosers is right.

use crate::agreement::everything;
use crate::exact::{Exact, integral, mean_of};
use crate::measure::{LIMIT, measure};
use crate::scatter::tilt;
use crate::world::{Fault, Plane, Stack};
use etalon_integrators::path::Path;
use etalon_integrators::settings::PathSettings;
use etalon_spectrum::Wavelengths;
use glam::Vec4;

const N: u32 = 100_000;

/// Four wavelengths far apart.
const FOUR: Wavelengths = Wavelengths {
    lambda: Vec4::new(450.0, 530.0, 590.0, 640.0),
    density: Vec4::splat(0.01),
};

/// A grating under a filter and a sky that brightens toward the zenith, unlike in the other
/// tests: where light goes matters.
fn grating() -> Stack {
    let planes = vec![
        Plane {
            smooth: 0.5,
            exponent: |nm| 2.0 + (nm - 360.0) * 0.1,
            reflectance: |nm| 0.9 - (nm - 360.0) * 5e-4,
            ..Plane::WHITE
        },
        Plane {
            height: 1.0,
            passing: |nm| 0.9 - (nm - 360.0) * 1e-3,
            ..Plane::BLACK
        },
    ];
    Stack {
        sky_power: 3.0,
        ..Stack::new(planes, |_| 1.0, 0.5, false)
    }
}

/// ∫ (n + 1)/2π cosⁿθ cosᵐθ dω = (n + 1)/(n + m + 1) for the lobe, cosᵐ for the mirror.
fn grating_radiance(stack: &Stack, lambda: f32) -> f64 {
    let [floor, filter] = [&stack.planes[0], &stack.planes[1]];
    let m = f64::from(stack.sky_power);
    let n = f64::from((floor.exponent)(lambda));
    let lobe = (n + 1.0) / (n + m + 1.0);
    let mirror = f64::from(tilt(lambda)).powi(3);
    let share = f64::from(floor.smooth);
    f64::from((floor.reflectance)(lambda))
        * f64::from((filter.passing)(lambda))
        * (share * mirror + (1.0 - share) * lobe)
}

fn path(rr_depth: u32) -> Path {
    Path {
        settings: PathSettings {
            rr_depth,
            ..PathSettings::default()
        },
        ..Path::default()
    }
}

#[test]
fn a_grating_shows_its_closed_form() {
    for rr_depth in [1, 5] {
        let stack = grating();
        let expected = integral(|lambda| grating_radiance(&stack, lambda));
        let z = measure(&path(rr_depth), &stack, N).z(expected);
        assert!(z < LIMIT, "rr_depth {rr_depth}: z = {z:.2}");
    }
    for fault in [Fault::OtherLanes, Fault::AtomForAll, Fault::FreePassage] {
        let stack = grating().with(fault);
        let expected = integral(|lambda| grating_radiance(&stack, lambda));
        let z = measure(&path(5), &stack, N).z(expected);
        assert!(z > LIMIT, "{fault:?} unnoticed: z = {z:.2}");
    }
}

/// With the same four wavelengths in every path, each lane's mean over equally likely choosers
/// is its own radiance. If one lane always chose, what it cannot find would be lost.
#[test]
fn rotated_wavelengths_have_the_expectation_of_each_lane() {
    let fixed = |stack: Stack, fault| Stack {
        fixed: Some(FOUR),
        fault,
        ..stack
    };
    let stack = fixed(grating(), Fault::None);
    let expected = mean_of(&FOUR, |lambda| grating_radiance(&stack, lambda));
    let z = measure(&path(5), &stack, N).z(expected);
    assert!(z < LIMIT, "grating: z = {z:.2}");

    let stack = fixed(everything(), Fault::None);
    let exact = Exact {
        stack: &stack,
        max_depth: u32::MAX,
        hidden: false,
    };
    let z = measure(&path(3), &stack, N).z(exact.colour());
    assert!(z < LIMIT, "everything: z = {z:.2}");

    let stack = fixed(grating(), Fault::FirstLane);
    let z = measure(&path(5), &stack, N).z(expected);
    assert!(
        z > LIMIT,
        "a lane that always chooses is unnoticed: z = {z:.2}"
    );
}

/// Where nothing depends on wavelength it does not matter who chooses, in every bit.
#[test]
fn grey_worlds_do_not_care_who_chooses() {
    let grey = |fault| {
        let stack = Stack::new(
            vec![
                Plane::WHITE,
                Plane {
                    height: 1.0,
                    passing: |_| 0.5,
                    ..Plane::WHITE
                },
            ],
            |_| 1.0,
            0.5,
            false,
        );
        Stack {
            fixed: Some(FOUR),
            fault,
            ..stack
        }
    };
    let rotating = measure(&path(2), &grey(Fault::None), 2000).mean;
    let first = measure(&path(2), &grey(Fault::FirstLane), 2000).mean;
    for (a, b) in rotating.into_iter().zip(first) {
        assert!((a - b).abs() < 1e-6 * b, "{a} and {b}");
    }
}
