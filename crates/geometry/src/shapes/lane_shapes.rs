//! Shapes whose points are chosen for receivers in lanes, each lane its own shape.

use super::rectangle::Rectangle;
use super::sphere::Sphere;
use crate::shapes::Shape;
use etalon_math::lane::{Lane, Select};
use etalon_transport::{LanePoint, LaneReceiver};

macro_rules! lane_shapes {
    ($($kind:ident,)*) => {
        impl Shape {
            /// Whether points of the two can be chosen together; of one and itself, whether they can be chosen in lanes at all.
            pub(crate) fn is_alike(&self, other: &Self) -> bool {
                match (self, other) {
                    $((Self::$kind(_), Self::$kind(_)) => true,)*
                    _ => false,
                }
            }

            /// Points of shapes that are all alike, each chosen for a receiver.
            #[inline]
            pub(crate) fn points_toward<'s, F: Lane>(
                shape: impl Fn(usize) -> &'s Self,
                from: &LaneReceiver<F>,
                u: [F; 2],
            ) -> LanePoint<F> {
                let mut point = match shape(0) {
                    $(Self::$kind(_) => {
                        let own = |i: usize| match shape(i) {
                            Self::$kind(own) => own,
                            _ => unreachable!("all shapes are alike"),
                        };
                        $kind::points_toward(own, from, u)
                    })*
                    _ => unreachable!("its points are chosen one by one"),
                };
                let density = point.density;
                let finite = density.gt(F::ZERO) & density.lt(F::splat(f32::INFINITY));
                point.density = finite.select(density, F::ZERO);
                point
            }
        }
    };
}

// The list.
lane_shapes! { Sphere, Rectangle, }
