//! The sum over all techniques and wavelengths that weighs a path, relative to the one that made it.
//!
//! Written with the vertices x₀ (light), x₁ … x_{K−2} (surfaces, points of media) and x_{K−1} (camera), technique σ
//! has σ vertices made from the light. Against the technique s that made the path,
//!
//! ```text
//! p_σ,ₖ / p_s,₀ = Π_{i<min} aᵢ,ₖ/aᵢ,₀ · Π_{i ≥ max} bᵢ,ₖ/bᵢ,₀ · Π_{σ≤i<s} bᵢ,ₖ/aᵢ,₀   (or, for σ > s, Π_{s≤i<σ} aᵢ,ₖ/bᵢ,₀)
//! ```
//!
//! The first two products are the density ratios that throughputs carry (`r_u`); the third grows by a factor a
//! step. Only densities of lane 0, which really chose, are divided by.
//!
//! Merging at xᵢ (see [`crate::vcm`]) arrives there from both sides: its density is that of technique i
//! times aᵢ, or of technique i + 1 times bᵢ, and n π r².

use super::path_vertex::PathVertex;
use glam::Vec4;

/// The densities at the end of a light subpath that its techniques need.
#[derive(Clone, Copy)]
pub(super) struct EndPdfs {
    /// Density of the other subpath arriving at this end.
    pub(super) here: Vec4,
    /// Density of the other subpath arriving at the vertex before it.
    pub(super) before: Vec4,
}

/// The light's end of a path.
#[derive(Clone, Copy)]
pub(super) struct LightEnd {
    /// Whether a path can run into it.
    pub(super) can_be_hit: bool,
    /// a₀ of emission.
    pub(super) emitted: f32,
    /// a₀ of light sampling.
    pub(super) sampled: f32,
    /// See [`CameraEnd::merging`].
    pub(super) merging: f32,
    /// See [`CameraEnd::connections`].
    pub(super) connections: f32,
}

/// Sum of the pdf ratios of the techniques with fewer light vertices than a path whose last vertex from the light is
/// `vertices[last]`. `rest` is the density ratio of the camera's part, `ends` the camera subpath's densities at
/// the last vertex and the one before it, `pdf_rev` that at the light once it is farther away; `connects` says
/// whether the last vertex may be an end of a connection.
pub(super) fn pdf_ratios_fewer<B>(
    vertices: &[PathVertex<B>],
    last: usize,
    rest: Vec4,
    ends: EndPdfs,
    light: LightEnd,
    pdf_rev: Vec4,
    mut connects: bool,
) -> f32 {
    let mut sum = 0.0;
    let mut product = rest;
    let mut at = Some(last);
    for step in 0.. {
        let Some(index) = at else {
            break;
        };
        let vertex = &vertices[index];
        let b = match step {
            0 => ends.here,
            1 => ends.before,
            _ => vertex.pdf_rev,
        };
        if connects && vertex.merges() && light.merging > 0.0 {
            sum += light.merging * (product * b * vertex.throughput.r_u).element_sum();
        }
        product *= b / vertex.arrival;
        at = vertex.parent;
        let here = connects;
        match at {
            Some(parent) => {
                connects = !vertices[parent].is_delta;
                if here && connects {
                    sum += light.connections
                        * (product * vertices[parent].throughput.r_u).element_sum();
                }
            }
            None => {
                // σ = 1: light sampling from the first vertex.
                let product = product * light.connections;
                if here {
                    sum += product.element_sum() * (light.sampled / light.emitted);
                }
                if light.can_be_hit {
                    let b = if step == 0 { ends.before } else { pdf_rev };
                    sum += (product * b).element_sum() / light.emitted;
                }
            }
        }
    }
    sum
}

/// The camera's end of a path.
#[derive(Clone, Copy)]
pub(super) struct CameraEnd {
    /// Whether the camera subpath's first vertex can be connected to the camera.
    pub(super) connects: bool,
    /// Number of samples that can connect to the camera.
    pub(super) samples: f32,
    /// Whether techniques without merging take part, as a number: one, or zero.
    pub(super) connections: f32,
    /// n π r², the area on which photons are merged times their number (m²): over the density per area
    /// with which either subpath arrives at a vertex, what makes of a connection there a merging. Zero
    /// if there is none, as in `bdpt`.
    pub(super) merging: f32,
}

/// Sum of the pdf ratios of the techniques with more light vertices than a path whose last vertex from the camera is the last of
/// `vertices`, or `end` where that is not among them. `product` is the density ratio of the light's part and
/// all factors so far, `connects` whether the last vertex may be an end of a connection.
pub(super) fn pdf_ratios_more<'c, B: 'c>(
    end: Option<&'c PathVertex<B>>,
    vertices: &'c [PathVertex<B>],
    mut product: Vec4,
    ends: EndPdfs,
    mut connects: bool,
    camera: CameraEnd,
) -> f32 {
    let mut sum = 0.0;
    let mut remaining = end.into_iter().chain(vertices.iter().rev()).peekable();
    let mut step = 0;
    while let Some(vertex) = remaining.next() {
        let next = remaining.peek();
        let a = match step {
            0 => ends.here,
            1 => ends.before,
            _ => vertex.pdf_rev,
        };
        if connects && vertex.merges() && camera.merging > 0.0 {
            sum += camera.merging * (product * a * vertex.throughput.r_u).element_sum();
        }
        if next.is_none() && !camera.connects {
            break;
        }
        product *= a / vertex.arrival;
        let here = connects;
        match next {
            Some(next) => {
                connects = !next.is_delta;
                if here && connects {
                    sum += camera.connections * (product * next.throughput.r_u).element_sum();
                }
            }
            None if here => sum += camera.connections * camera.samples * product.element_sum(),
            None => {}
        }
        step += 1;
    }
    sum
}
