//! Two batches of replicates of the same estimator, as one picture.
//!
//! With R₁ and R₂ replicates of equally many samples, means m₁, m₂ and standard errors s₁, s₂ of a
//! pixel, the sums of squares about the common mean add up to
//! R₁(R₁−1)s₁² + R₂(R₂−1)s₂² + R₁R₂/(R₁+R₂) (m₁−m₂)² (Chan, Golub & LeVeque 1983). Tile means, which
//! every test is made of, are those of both.

use etalon_film::RenderedImage;
use etalon_images::Image;

/// `first` and `second` together.
///
/// # Errors
/// If they are not batches of one estimator: other sizes, channels, scenes or samples.
pub fn merge(first: &RenderedImage, second: &RenderedImage) -> Result<RenderedImage, String> {
    let missing = "a batch has no statistics";
    let (a, b) = (
        first.metadata.as_ref().ok_or(missing)?,
        second.metadata.as_ref().ok_or(missing)?,
    );
    let same = a.channels == b.channels
        && a.scene_hash == b.scene_hash
        && a.film == b.film
        && a.integrator == b.integrator
        && a.spp * u64::from(b.replicates) == b.spp * u64::from(a.replicates);
    if !same {
        return Err("the batches are of different estimators".to_owned());
    }
    let mut metadata = a.clone();
    metadata.spp += b.spp;
    metadata.replicates += b.replicates;
    metadata.seconds = a.seconds.zip(b.seconds).map(|(a, b)| a + b);
    for (means, more) in metadata.tile_means.iter_mut().zip(&b.tile_means) {
        means.append(more)?;
    }
    let [ra, rb] = [a.replicates, b.replicates].map(f64::from);
    let mut image = Image::new(first.image.width(), first.image.height());
    let mut errors = Vec::new();
    for name in &a.channels {
        let plane = |of: &RenderedImage| of.image.channel(name).map(<[f32]>::to_vec);
        let (Some(ma), Some(mb)) = (plane(first), plane(second)) else {
            return Err(format!("a batch has no channel `{name}`"));
        };
        if let (Some(sa), Some(sb)) = (first.standard_error(name), second.standard_error(name)) {
            let error = |i: usize| {
                let square = |x: f32| f64::from(x) * f64::from(x);
                let apart = f64::from(ma[i]) - f64::from(mb[i]);
                let squares = ra * (ra - 1.0) * square(sa[i])
                    + rb * (rb - 1.0) * square(sb[i])
                    + ra * rb / (ra + rb) * apart * apart;
                (squares / ((ra + rb) * (ra + rb - 1.0))).sqrt() as f32
            };
            errors.push((
                format!("{}{name}", etalon_film::STANDARD_ERROR),
                (0..sa.len()).map(error).collect::<Vec<f32>>(),
            ));
        }
        let mean =
            |(a, b): (&f32, &f32)| ((ra * f64::from(*a) + rb * f64::from(*b)) / (ra + rb)) as f32;
        image.push(name.as_str(), ma.iter().zip(&mb).map(mean).collect());
    }
    for (name, plane) in errors {
        image.push(name, plane);
    }
    Ok(RenderedImage {
        image,
        frame: first.frame,
        metadata: Some(metadata),
    })
}
