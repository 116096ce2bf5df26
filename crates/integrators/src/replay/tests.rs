//! Do remarks change what is told, and that alone?

use super::event_log::{EventLog, Place};
use super::{Event, Gathered};
use crate::steps::path_throughput::PathThroughput;
use etalon_math::{Density, SolidAngle};
use etalon_spectrum::{Wavelengths, sensor_response};
use etalon_transport::{
    BsdfSample, ChainRemark, MergedPhoton, Mixed, Mixture, SamplePdf, TraceEvent,
};
use glam::{Vec3, Vec4};

const WAVELENGTHS: Wavelengths = Wavelengths {
    lambda: Vec4::new(450.0, 500.0, 550.0, 600.0),
    density: Vec4::splat(0.004),
};

fn density(value: f32) -> Density<SolidAngle> {
    Density::uniform(value)
}

fn evaluated(wi: Vec3) -> Event {
    Event::Evaluated {
        wi,
        value: Vec4::ONE,
        density: Some(density(0.25)),
        mixture: None,
    }
}

fn sample(wi: Vec3, value: f32, chance: f32) -> BsdfSample {
    BsdfSample {
        wi,
        value: Vec4::splat(value),
        chance: SamplePdf::Continuous(density(chance)),
        eta: 1.0,
        is_null: false,
    }
}

fn mixture(wi: Vec3, mixed: Mixed) -> Mixture {
    Mixture {
        wi,
        own: SamplePdf::Continuous(density(0.25)),
        other: density(0.75),
        share: 0.5,
        mixed,
    }
}

fn start() -> Option<Place> {
    Some(Place {
        walk: 0,
        prefix: Some(PathThroughput::START),
    })
}

/// Photons are told, and not what was asked for their sake; afterwards everything is.
#[test]
fn photons_stand_for_the_questions_that_they_raised() {
    let mut notes = EventLog::default();
    notes.begin_at_camera(2.0, Vec3::Z);
    notes.ask(start(), Vec3::X, evaluated(Vec3::X));
    let (radius, among) = (0.5, 7);
    notes.record(TraceEvent::Gathering { radius, among }, sensor_response);
    notes.ask(start(), Vec3::Y, evaluated(Vec3::Y));
    let photon = MergedPhoton {
        position: Vec3::ONE,
        distance: 0.25,
        from: Vec3::Y,
        segments: 3,
        wavelengths: WAVELENGTHS,
        scattering: Vec4::ONE,
        estimate: Vec4::new(1.0, 2.0, 3.0, 4.0),
    };
    notes.record(TraceEvent::Photon(photon), sensor_response);
    // One that brings nothing.
    let estimate = Vec4::ZERO;
    notes.record(
        TraceEvent::Photon(MergedPhoton { estimate, ..photon }),
        sensor_response,
    );
    // A camera path at other wavelengths: it leads nowhere.
    let other = sample(Vec3::NEG_Y, 1.0, 1.0);
    notes.scatter(
        start(),
        Event::Scattered {
            walk: Some(0),
            sample: Some(other),
            prefix: None,
            mixture: None,
        },
    );
    notes.record(TraceEvent::Gathered, sensor_response);
    assert!(notes.along(Vec3::NEG_Y).is_none());
    assert!(notes.along(Vec3::Z).is_some());
    notes.ask(start(), Vec3::Z, evaluated(Vec3::Z));
    let events = notes.take_events();
    let [
        Event::Evaluated { wi: Vec3::X, .. },
        Event::Photons {
            radius: 0.5,
            among: 7,
            photons,
        },
        Event::Evaluated { wi: Vec3::Z, .. },
    ] = &events[..]
    else {
        panic!("{events:?}");
    };
    let [Gathered { photon, rgb }] = photons[..] else {
        panic!("{photons:?}");
    };
    let expected = sensor_response(&WAVELENGTHS).rgb(photon.estimate * 2.0);
    assert_eq!(rgb, expected.to_array());
}

/// The walk goes on with the density of the mixture, whoever chose the direction.
#[test]
fn a_mixture_stands_for_what_the_model_says_of_it_alone() {
    for by_model in [false, true] {
        let mut notes = EventLog::default();
        notes.begin(Vec4::ONE, Vec3::Z);
        let alone = sample(Vec3::X, 1.0, 0.25);
        if by_model {
            let place = start().map(|place| place.extended(Some(&alone)));
            notes.scatter(
                place,
                Event::Scattered {
                    walk: Some(0),
                    sample: Some(alone),
                    prefix: place.and_then(|place| place.prefix),
                    mixture: None,
                },
            );
        } else {
            notes.ask(start(), Vec3::X, evaluated(Vec3::X));
        }
        let together = sample(Vec3::X, 1.0, 0.5);
        let mixed = Mixed::Sampled {
            by_model,
            sample: Some(together),
        };
        notes.mix(start(), mixture(Vec3::X, mixed));
        let place = notes.along(Vec3::X).expect("the walk goes there");
        let value = place.prefix.expect("it is known").beta;
        assert_eq!(value, Vec4::splat(2.0));
        let events = notes.take_events();
        let [
            Event::Scattered {
                walk: Some(0),
                sample: Some(sample),
                prefix: Some(prefix),
                mixture: Some(_),
            },
        ] = &events[..]
        else {
            panic!("{events:?}");
        };
        assert_eq!(sample.chance.lanes(), Vec4::splat(0.5));
        assert_eq!(prefix.beta, value);
    }
}

#[test]
fn a_direction_that_is_only_weighed_keeps_its_line() {
    let mut notes = EventLog::default();
    notes.begin(Vec4::ONE, Vec3::Z);
    notes.ask(start(), Vec3::X, evaluated(Vec3::X));
    let weighed = Mixed::Weighed(density(0.5));
    notes.mix(start(), mixture(Vec3::X, weighed));
    let events = notes.take_events();
    assert!(
        matches!(
            &events[..],
            [Event::Evaluated {
                mixture: Some(Mixture {
                    mixed: Mixed::Weighed(_),
                    ..
                }),
                ..
            }]
        ),
        "{events:?}"
    );
}

/// Mutant: walks of other paths of the same sample are counted along.
#[test]
fn every_path_of_a_chain_has_walks_of_its_own() {
    let mut notes = EventLog::default();
    assert_eq!(notes.begin(Vec4::ONE, Vec3::X), 0);
    assert_eq!(notes.begin(Vec4::ONE, Vec3::Y), 1);
    for remark in [
        ChainRemark::Uniform(3),
        ChainRemark::Begins {
            number: 0,
            start: 3,
        },
        ChainRemark::Proposal {
            step: 0,
            large: true,
        },
    ] {
        notes.record(TraceEvent::Chain(remark), sensor_response);
        assert!(notes.along(Vec3::X).is_none());
        assert_eq!(notes.begin(Vec4::ONE, Vec3::X), 0);
    }
    notes.record(TraceEvent::Chain(ChainRemark::Ends), sensor_response);
    assert!(notes.along(Vec3::X).is_some());
}

#[test]
fn wavelengths_are_those_that_count() {
    let drawn = Wavelengths {
        lambda: Vec4::splat(700.0),
        ..WAVELENGTHS
    };
    for first in [None, Some(Event::Wavelengths(drawn))] {
        let mut notes = EventLog::default();
        first.into_iter().for_each(|event| notes.note(event));
        notes.record(TraceEvent::Wavelengths(WAVELENGTHS), sensor_response);
        let events = notes.take_events();
        let [Event::Wavelengths(told)] = events[..] else {
            panic!("{events:?}");
        };
        assert_eq!(told.lambda, WAVELENGTHS.lambda);
    }
}
