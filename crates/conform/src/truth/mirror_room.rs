//! A room of mirrors: floor and ceiling reflect the fractions f and c, the walls reflect all, and
//! the ceiling also emits the radiance L.
//!
//! Upright walls turn a ray but not its angle of elevation, so floor and ceiling take turns. A ray
//! that rises meets L, and f c of the same again after one round trip; a falling ray sees f times the rising radiance:
//!
//! L↑ = L (1 + f c + (f c)² + …) = L/(1 − f c),   L↓ = f L↑
//!
//! (The sum of a geometric series; for parallel mirrors it is Stokes's of 1862.)

/// What a ray that rises, or falls, sees of a ceiling of radiance 1.
pub fn seen(floor: f64, ceiling: f64, falls: bool) -> f64 {
    let rising = 1.0 / (1.0 - floor * ceiling);
    if falls { floor * rising } else { rising }
}

#[cfg(test)]
mod tests {
    use super::seen;

    #[test]
    fn the_series_is_summed() {
        let (floor, ceiling) = (0.7, 0.8);
        for falls in [false, true] {
            // Term by term, mirror by mirror.
            let (mut sum, mut throughput, mut at_floor) = (0.0, 1.0, falls);
            for _ in 0..200 {
                if at_floor {
                    throughput *= floor;
                } else {
                    sum += throughput;
                    throughput *= ceiling;
                }
                at_floor = !at_floor;
            }
            assert!((seen(floor, ceiling, falls) - sum).abs() < 1e-13);
        }
    }
}
