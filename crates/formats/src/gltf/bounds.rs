//! The box around everything.

use super::nodes::Placed;
use super::reader::Reader;
use etalon_params::DVec3;

/// The least and the greatest coordinates of what is there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
}

impl Bounds {
    /// Of points, if there are any.
    fn of(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        points.into_iter().fold(None, |bounds, point| {
            let Self { low, high } = bounds.unwrap_or(Self {
                low: point,
                high: point,
            });
            Some(Self {
                low: low.min(point),
                high: high.max(point),
            })
        })
    }

    fn corners(self) -> [DVec3; 8] {
        core::array::from_fn(|i| {
            let side = |bit: usize, low, high| if i >> bit & 1 == 0 { low } else { high };
            DVec3::new(
                side(0, self.low.x, self.high.x),
                side(1, self.low.y, self.high.y),
                side(2, self.low.z, self.high.z),
            )
        })
    }
}

impl Reader<'_> {
    /// The box around the meshes that were read.
    pub(crate) fn bounds(&self, placed: &[Placed]) -> Option<Bounds> {
        let mut boxes: Vec<Vec<DVec3>> = vec![Vec::new(); self.root.meshes.len()];
        for ((mesh, _), loaded) in &self.primitives {
            let data = loaded.as_ref().and_then(|part| self.meshes.get(part.mesh));
            let positions = data.iter().flat_map(|data| &data.positions);
            let own = Bounds::of(positions.map(|position| position.as_dvec3()));
            if let (Some(own), Some(corners)) = (own, boxes.get_mut(*mesh)) {
                corners.extend(own.corners());
            }
        }
        let corners = placed.iter().flat_map(|place| {
            let corners = boxes.get(place.mesh).into_iter().flatten();
            corners.map(|corner| place.world.transform_point3(*corner))
        });
        Bounds::of(corners)
    }
}
