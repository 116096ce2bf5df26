//! A world around another that changes nothing changes no bit of any picture.
//!
//! Whoever passes questions on may forget one, and the contract's default answers in its place: what is drawn is then
//! another estimator, or wrong. So every claim's scene is rendered through a [`Faulty`] world without a fault, and some
//! of its samples are drawn again both unheard and while they are written down.

use etalon_film::ExactFilm;
use etalon_integrators::RenderPlan;
use etalon_integrators::replay::Address;
use etalon_render::pipeline::{LoadOptions, Loaded, load};
use etalon_sampling::{ReplicateKind, SamplerKind};
use etalon_transport::{Film, World};
use etalon_validation::claim::{Budget, Claim, Estimator, Oracle};
use etalon_validation::fault::{Faulty, PlantedFault};
use etalon_validation::{folders, rendering};
use glam::UVec2;
use rayon::prelude::*;
use std::collections::HashSet;

/// Samples per pixel.
const SPP: u32 = 4;

/// The longest side of a picture (pixels), around the middle of the scene's own.
const LONGEST: u32 = 6;

/// A claim's estimators that stand in its file, that of its oracle among them, each once.
fn estimators(claim: &Claim) -> Vec<&Estimator> {
    let oracle = match &claim.oracle {
        Oracle::Agreement { estimator } => Some(estimator.as_ref()),
        _ => None,
    };
    let mut known = HashSet::new();
    let own = claim.estimators.iter().filter(|e| e.in_matrix.is_none());
    let all = own.chain(oracle);
    all.filter(|e| {
        known.insert(format!(
            "{:?} {:?} {:?}",
            e.integrator, e.defines, e.light_chooser
        ))
    })
    .collect()
}

/// The scene's film, cut down to its middle.
fn film(loaded: &Loaded) -> Result<ExactFilm, String> {
    let mut settings = loaded.compiled.film.clone();
    let size = settings.crop_size.min(UVec2::splat(LONGEST));
    settings.crop_offset += (settings.crop_size - size) / 2;
    settings.crop_size = size;
    ExactFilm::new(settings, &loaded.integrator.channels()).map_err(|e| e.message)
}

/// Whether a world without a fault is rendered to the same bits as the world itself.
fn renders_alike(loaded: &Loaded, plan: &RenderPlan) -> Result<bool, String> {
    let scene = &loaded.compiled.scene;
    let (mut plain, mut through) = (film(loaded)?, film(loaded)?);
    let integrator = &loaded.integrator;
    integrator.render(std::slice::from_ref(scene), &mut plain, plan, &());
    integrator.render(&[Faulty::new(scene, None, 0)], &mut through, plan, &());
    let [plain, through] = [plain, through].map(|film| {
        let developed = film.develop(rendering::facts(loaded, plan, String::new()));
        let planes = developed.colours().into_iter().filter_map(|name| {
            let plane = developed.image.channel(name)?;
            Some(plane.iter().map(|x| x.to_bits()).collect::<Vec<_>>())
        });
        planes.collect::<Vec<_>>()
    });
    Ok(plain == through)
}

/// Whether samples are the same while they are written down.
fn replays_alike(loaded: &Loaded, plan: &RenderPlan) -> Result<bool, String> {
    let film = film(loaded)?;
    let (origin, size) = (film.origin(), film.size());
    let addresses: Vec<Address> = (0..size.min_element())
        .map(|at| Address {
            pixel: origin + UVec2::splat(at),
            replicate: 0,
            sample: at % SPP.min(plan.samples_per_replicate),
        })
        .collect();
    let scene = &loaded.compiled.scene;
    let replays = loaded
        .integrator
        .replay(scene, &film, plan, &addresses, &|_| String::new());
    // Debug tells every float apart, but for the payload of a NaN.
    Ok((replays.iter())
        .all(|replay| format!("{:?}", replay.delivered) == format!("{:?}", replay.unheard)))
}

/// What differs for an estimator.
fn differences(claim: &Claim, estimator: &Estimator) -> Vec<String> {
    let found = || -> Result<Vec<&str>, String> {
        let loaded = rendering::load_for(claim, estimator)?;
        let budget = Budget {
            spp: SPP,
            replicates: 1,
            ..estimator.thorough
        };
        let plan = rendering::plan(&loaded, estimator, budget, 1);
        let mut found = Vec::new();
        if !renders_alike(&loaded, &plan)? {
            found.push("another picture through a world without a fault");
        }
        if !replays_alike(&loaded, &plan)? {
            found.push("another sample where it is written down");
        }
        Ok(found)
    };
    let say = |what: &str| format!("{}, {}: {what}", claim.name, estimator.label());
    match found() {
        Ok(found) => found.into_iter().map(say).collect(),
        Err(message) => vec![say(&message)],
    }
}

/// Mutants rejected: a world that forgets `medium_light_density`; a scattering model that forgets `hemisphere`.
#[test]
fn worlds_around_a_world_are_transparent() {
    let claims = Claim::read_all(&folders::claims()).expect("claims can be read");
    let rows: Vec<(&Claim, &Estimator)> = claims
        .iter()
        .flat_map(|claim| estimators(claim).into_iter().map(move |e| (claim, e)))
        .collect();
    let found: Vec<String> = (rows.par_iter())
        .flat_map(|(claim, estimator)| differences(claim, estimator))
        .collect();
    assert!(found.is_empty(), "of {}:\n{}", rows.len(), found.join("\n"));
}

/// More light is more light, whether a path runs into what emits it, samples it or follows particles from it: with the same
/// random numbers a picture is as much brighter as the fault says. Mutant rejected: a medium that keeps what it emits, +0.4 %
/// in place of 20.
#[test]
fn a_fault_of_energy_reaches_what_media_emit() {
    let claims = Claim::read_named(&folders::claims(), Some("fire")).expect("a claim");
    let claim = &claims[0];
    for estimator in estimators(claim) {
        let loaded = rendering::load_for(claim, estimator).expect("a scene");
        let budget = Budget {
            spp: SPP,
            replicates: 1,
            ..estimator.thorough
        };
        let plan = rendering::plan(&loaded, estimator, budget, 1);
        let light = |fault| {
            let picture = rendering::picture(&loaded, &plan, estimator, fault, None);
            let picture = picture.expect("a picture");
            let red = picture.image.channel("R").expect("red").iter();
            red.map(|x| f64::from(*x)).sum::<f64>()
        };
        let [sound, more] = [None, Some(PlantedFault::GreatEnergy)].map(light);
        let factor = more / sound;
        assert!(
            sound > 0.0 && (factor - 1.2).abs() < 1e-4,
            "{}: {factor}",
            estimator.label()
        );
    }
}

/// A room with a lamp, whose vertices are shaded in vector lanes; by a world around it, one by one.
const LANES: &str = r#"<scene version="3.0.0">
    <integrator type="path"><integer name="light_candidates" value="CANDIDATES"/><integer name="rr_depth" value="2"/></integrator>
    <sensor type="perspective"><transform name="to_world"><lookat origin="0, -3, 1" target="0, 0, 0.3" up="0, 0, 1"/></transform>
        <film type="hdrfilm"><integer name="width" value="24"/><integer name="height" value="24"/></film></sensor>
    <shape type="rectangle"><transform name="to_world"><scale value="2"/></transform>
        <bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="-90"/><scale value="2"/><translate y="1"/></transform>
        <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.2, 0.7, 0.3"/></bsdf>
            <bsdf type="diffuse"><rgb name="reflectance" value="0.9, 0.2, 0.3"/></bsdf></bsdf></shape>
    <shape type="sphere"><point name="center" value="0.3, 0, 0.4"/><float name="radius" value="0.4"/>BSDF</shape>
    <shape type="rectangle"><transform name="to_world"><rotate x="1" angle="180"/><scale value="0.5"/><translate z="1.2"/></transform>
        <emitter type="area"/></shape>
</scene>"#;

/// What the ball is made of: every model that is written for lanes; and with media, in the ball and all around.
const BALLS: [&str; 12] = [
    r#"<bsdf type="diffuse"/>"#,
    r#"<bsdf type="dielectric"/>"#,
    r#"<bsdf type="dielectric"><string name="int_ior" value="cauchy:1.4,0.05"/></bsdf>"#,
    r#"<bsdf type="roughdielectric"><float name="alpha" value="0.3"/></bsdf>"#,
    r#"<bsdf type="roughdielectric"><string name="distribution" value="ggx"/><string name="int_ior" value="cauchy:1.4,0.05"/></bsdf>"#,
    r#"<bsdf type="conductor"><string name="material" value="Cu"/></bsdf>"#,
    r#"<bsdf type="roughconductor"><float name="alpha" value="0.2"/></bsdf>"#,
    r#"<bsdf type="twosided"><bsdf type="roughconductor"><string name="distribution" value="ggx"/></bsdf></bsdf>"#,
    r#"<bsdf type="plastic"/>"#,
    r#"<bsdf type="roughplastic"/>"#,
    r#"<bsdf type="dielectric"/><medium type="homogeneous" name="interior"><float name="sigma_t" value="3"/></medium>"#,
    r#"<bsdf type="diffuse"/></shape><shape type="sphere"><float name="radius" value="20"/><bsdf type="null"/>
        <medium type="homogeneous" name="interior"><float name="sigma_t" value="0.3"/></medium>"#,
];

/// Mutants rejected: candidates of one lane that are chosen by another's number; Russian roulette that is not weighed.
#[test]
fn vertices_shaded_in_lanes_are_what_they_are_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("room.xml");
    for (candidates, ball) in ["1", "3"].into_iter().cycle().zip(BALLS) {
        let scene = LANES
            .replace("CANDIDATES", candidates)
            .replace("BSDF", ball);
        std::fs::write(&path, scene).expect("a writable folder");
        let loaded = load(&path, &LoadOptions::default()).expect("a scene");
        assert!(loaded.compiled.scene.lanes().is_some());
        let plan = RenderPlan {
            seed: 1,
            replicates: 1,
            replicate_kind: ReplicateKind::Blocks,
            share: None,
            samples_per_replicate: 16,
            sampler: SamplerKind::Sobol,
        };
        let alike = renders_alike(&loaded, &plan).expect("a picture");
        assert!(alike, "{candidates} candidates, {ball}");
    }
}
