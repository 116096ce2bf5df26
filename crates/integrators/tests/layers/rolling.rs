//! A rolling shutter: integrators that start at the camera take the moments that the world gives them; others are refused.

use crate::together::{Record, drafts};
use crate::world::{Plane, Stack};
use etalon_integrators::AnyIntegrator;
use etalon_integrators::naive::Naive;
use etalon_integrators::path::Path;
use etalon_params::{Class, Diagnostics, FileId, Node, Span, Spanned};
use etalon_transport::{Integrator, RowExposure, SceneCapabilities, TileSink};

/// How many of 40 samples see a bright sky behind a camera that sees nothing before the moment 0.75, alone and together.
fn seen<I: Integrator<State = ()>>(integrator: &I, row_moment: Option<f32>) -> [usize; 2] {
    let mut world = Stack::new(Vec::<Plane>::new(), |_| 1.0, 2.0, true);
    world.camera.sees_after = 0.75;
    world.row_moment = row_moment;
    let mut alone = Record::default();
    for draft in &mut drafts(40) {
        alone.begin_sample(draft.site.pixel, draft.weight);
        integrator.sample(&world, &(), &draft.site, &mut draft.sampler, &mut alone);
    }
    let mut together = Record::default();
    integrator.sample_batch(&world, &(), drafts(40).drain(..), &mut together);
    let lit = |record: Record| {
        let lit = record.samples.iter().filter(|sample| sample.2[1] != 0);
        lit.count()
    };
    [lit(alone), lit(together)]
}

/// The mutant whose samples are of the moment that they drew, and not of that of their row, sees some of both.
#[test]
fn samples_are_of_the_moments_of_their_rows() {
    fn check<I: Integrator<State = ()>>(integrator: &I) {
        assert_eq!(seen(integrator, Some(0.8)), [40; 2]);
        assert_eq!(seen(integrator, Some(0.7)), [0; 2]);
        let [alone, together] = seen(integrator, None);
        assert_eq!(alone, together);
        assert!((2..20).contains(&alone), "{alone}");
    }
    check(&Path::default());
    check(&Naive::default());
}

#[test]
fn integrators_that_follow_light_are_refused() {
    let capabilities = SceneCapabilities {
        rows: RowExposure::InTurn,
        ..SceneCapabilities::default()
    };
    let refused = |name: &str| {
        let here = Span {
            file: FileId(0),
            start: 0,
            end: 1,
        };
        let node = Node {
            class: Class::Integrator,
            plugin: Spanned {
                value: name.into(),
                span: here,
            },
            id: None,
            span: here,
            properties: Vec::new(),
        };
        let integrator = AnyIntegrator::from_node(&node, &Diagnostics::new()).expect(name);
        let all = integrator.incompatibilities(&capabilities);
        all.iter()
            .any(|reason| reason.fatal && reason.message.contains("rolling shutter"))
    };
    for name in ["bdpt", "mmlt", "forward", "vcm", "sppm", "photonmap"] {
        assert!(refused(name), "{name}");
    }
    for name in [
        "path", "ptracer", "direct", "naive", "volpath", "guided", "whitted", "depth", "ao",
    ] {
        assert!(!refused(name), "{name}");
    }
}
