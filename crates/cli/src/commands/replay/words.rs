//! The words in which a replay speaks of numbers and things.

use etalon_integrators::path_throughput::PathThroughput;
use etalon_scene::Names;
use etalon_transport::{ChainRemark, Mixed, Mixture, SamplePdf, SurfaceInteraction};
use glam::{Vec3, Vec4};
use std::fmt::Write;

/// Adds a line.
pub(super) fn line(text: &mut String, line: impl AsRef<str>) {
    text.push_str(line.as_ref());
    text.push('\n');
}

/// Three numbers.
pub(super) fn vector(v: Vec3) -> String {
    format!("({}, {}, {})", v.x, v.y, v.z)
}

/// One number per wavelength.
pub(super) fn lanes(v: Vec4) -> String {
    format!("[{} {} {} {}]", v.x, v.y, v.z, v.w)
}

/// Density per steradian, or probability.
pub(super) fn chance(chance: SamplePdf) -> String {
    let kind = if chance.is_delta() {
        "probability"
    } else {
        "density"
    };
    format!("{kind} {}", lanes(chance.lanes()))
}

/// Value and densities of a walk.
pub(super) fn carried(prefix: Option<PathThroughput>) -> String {
    match prefix {
        Some(PathThroughput {
            beta: value,
            r_u: ratio,
        }) => format!("f/p {}  p/p₀ {}", lanes(value), lanes(ratio)),
        None => "f/p known to the estimator only".to_owned(),
    }
}

/// Which walk; the first is not worth mentioning.
pub(super) fn walk(walk: Option<usize>) -> String {
    match walk {
        Some(0) => String::new(),
        Some(walk) => format!("walk {}: ", walk + 1),
        None => "no walk: ".to_owned(),
    }
}

/// What a thing is called.
fn named(names: &[String], index: u32) -> String {
    let name = names.get(index as usize);
    name.map_or_else(|| index.to_string(), |name| format!("{index} {name}"))
}

/// What was met.
pub(super) fn surface(vertex: &SurfaceInteraction, names: &Names) -> String {
    let mut text = format!(
        "shape {}, material {}",
        named(&names.shapes, vertex.shape.0),
        named(&names.materials, vertex.material.0)
    );
    // Writing to a string cannot fail.
    if vertex.primitive > 0 {
        let _ = write!(text, ", primitive {}", vertex.primitive);
    }
    if vertex.instance.is_some() {
        let _ = write!(text, ", instance {}", vertex.instance.0);
    }
    if vertex.light.is_some() {
        let _ = write!(text, ", light {}", vertex.light.0);
    }
    text
}

/// How a mixture came to its density.
pub(super) fn mixed(mixture: &Mixture) -> String {
    let chosen = match mixture.mixed {
        Mixed::Weighed(_) => "",
        Mixed::Sampled { by_model: true, .. } => "chosen by the model; ",
        Mixed::Sampled {
            by_model: false, ..
        } => "chosen by the guide; ",
    };
    format!(
        "{chosen}the model's {} with weight {}, the guide's density {} with weight {}",
        chance(mixture.own),
        mixture.share,
        lanes(mixture.other.lanes()),
        1.0 - mixture.share,
    )
}

/// What an estimator says of its chains.
pub(super) fn chain(remark: &ChainRemark) -> String {
    match remark {
        ChainRemark::HostsNone => {
            "the Markov chains and uniform samples belong to other samples of this and other pixels"
                .to_owned()
        }
        ChainRemark::Hosts {
            contributions,
            chains,
            steps,
        } => format!(
            "the sample's share: {contributions} contributions of uniform samples, and Markov chains: \
             {chains}, of {steps} steps each"
        ),
        ChainRemark::Uniform(index) => format!("-- uniform sample {index}"),
        ChainRemark::Begins { number, start } => {
            format!("-- chain {number} begins at uniform sample {start}")
        }
        ChainRemark::Proposal { step, large } => {
            let size = if *large { "large" } else { "small" };
            format!("-- step {step}, a {size} one, proposes")
        }
        ChainRemark::Decision {
            from,
            to,
            acceptance,
            accepted,
        } => {
            let decided = match (*accepted, *to > 0.0) {
                (true, _) => "taken; where the chain was contributes",
                (false, true) => "not taken; the proposal contributes",
                (false, false) => "not taken",
            };
            // Without the sign of a zero.
            let (from, to) = (from + 0.0, to + 0.0);
            format!("brightness {to} after {from}, taken with probability {acceptance}: {decided}")
        }
        ChainRemark::Ends => "-- the chain ends; where it stands contributes".to_owned(),
    }
}
