//! `cargo xtask tabulate`: writes any model as a table of its BRDF, says what the table's resolution loses, and draws
//! models and tables as polar plots.

mod model;
mod plot;

use etalon_tables::spectral::{self, Grid};
use etalon_tables::write_rgl::{Resolution, write_rgl};
use etalon_tables::{BrdfTable, merl};
use glam::{Vec3, Vec4};
use model::Model;
use std::f32::consts::{FRAC_PI_2, TAU};
use std::fs;
use std::path::{Path, PathBuf};

/// What to tabulate, and how finely.
#[derive(clap::Args)]
#[command(
    after_help = "The kind of table follows from the name of the file: `.brdf` is a spectral table over θo × θi × φ × λ,\n\
`.bsdf` is the RGL database's format, which Mitsuba reads too, `.binary` is MERL's (90 × 90 × 180 colours).\n\n\
Examples:\n  cargo xtask tabulate roughconductor material=Au alpha=0.3 -o gold.brdf --plot gold.svg\n  \
cargo xtask tabulate ward alpha_u=0.1 alpha_v=0.4 -o brushed.bsdf --azimuths 33\n  \
cargo xtask tabulate gold-metallic-paint.binary --plot paint.svg"
)]
pub(crate) struct Arguments {
    /// A plugin and its parameters as key=value (numbers, `true`, `r,g,b`, `nm:value,…`, names); or a file: a single
    /// `<bsdf>` in XML, or a table
    #[arg(required = true, num_args = 1.., value_name = "MODEL")]
    model: Vec<String>,
    /// The table to write: `.brdf`, `.bsdf` or `.binary`
    #[arg(short, long, value_name = "FILE", required_unless_present = "plot")]
    output: Option<PathBuf>,
    /// A polar plot to write
    #[arg(long, value_name = "FILE.svg")]
    plot: Option<PathBuf>,
    /// Elevations of the known direction, and in a `.brdf` of the other too
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(2..=1024))]
    elevations: Option<u16>,
    /// Azimuths: between the directions in a `.brdf` (61), of the known direction in a `.bsdf` (1: isotropic)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    azimuths: Option<u16>,
    /// Wavelengths from 360 to 830 nm
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u16).range(2..=471))]
    wavelengths: u16,
    /// Nodes along a side of the square of normals, and of the square of spectra, in a `.bsdf`
    #[arg(long, value_name = "N", default_value_t = 32, value_parser = clap::value_parser!(u16).range(4..=512))]
    nodes: u16,
}

/// Tabulates, measures, and draws.
pub(crate) fn run(arguments: &Arguments) -> Result<(), String> {
    let model = Model::read(&arguments.model)?;
    if let Some(path) = &arguments.output {
        let bytes = table(arguments, &model, path)?;
        fs::write(path, &bytes).map_err(|e| format!("{}: {e}", path.display()))?;
        let table = BrdfTable::parse(&bytes).map_err(|e| e.to_string())?;
        println!(
            "{}: {:.1} kB; off the model by at most {:.4} of the light that arrives (seen from 0° to 75°)",
            path.display(),
            bytes.len() as f64 / 1e3,
            resolution_error(&model, &table)
        );
    }
    if let Some(path) = &arguments.plot {
        let drawn = plot::polar(&model, &arguments.model.join(" "));
        fs::write(path, drawn).map_err(|e| format!("{}: {e}", path.display()))?;
        println!("{}", path.display());
    }
    Ok(())
}

fn table(arguments: &Arguments, model: &Model, path: &Path) -> Result<Vec<u8>, String> {
    let text = arguments.model.join(" ");
    let count = usize::from(arguments.wavelengths);
    let elevations = |default: u16| usize::from(arguments.elevations.unwrap_or(default));
    let azimuths = |default: u16| usize::from(arguments.azimuths.unwrap_or(default));
    match path.extension().and_then(|e| e.to_str()) {
        Some("brdf") => {
            let grid = Grid::new(elevations(46), azimuths(61), count);
            let brdf = |wo: Vec3, wi: Vec3| model.brdf(wo, wi, &grid.wavelengths);
            let first = spectral::write(&grid, brdf, &text, None);
            let read = BrdfTable::parse(&first).map_err(|e| e.to_string())?;
            let error = resolution_error(model, &read);
            Ok(spectral::write(&grid, brdf, &text, Some(error)))
        }
        Some("bsdf") => {
            let resolution = Resolution {
                phi: azimuths(1),
                theta: elevations(16),
                normals: usize::from(arguments.nodes),
                square: usize::from(arguments.nodes),
                wavelengths: Grid::new(2, 2, count).wavelengths,
            };
            let value = |wo: Vec3, wi: Vec3| model.value(wo, wi, &resolution.wavelengths);
            write_rgl(&resolution, value, &text).map_err(|e| e.to_string())
        }
        Some("binary") => {
            let (wavelengths, weights) = model::rgb_weights(48);
            Ok(merl::write(merl::DIMENSIONS, |wo, wi| {
                let spectrum = model.brdf(wo, wi, &wavelengths);
                let mut rgb = [0.0f64; 3];
                for (value, weights) in spectrum.into_iter().zip(&weights) {
                    for (sum, weight) in rgb.iter_mut().zip(weights) {
                        *sum += f64::from(value) * weight;
                    }
                }
                // Below zero would mean that nothing was measured.
                rgb.map(|value| value.max(0.0))
            }))
        }
        _ => Err(format!(
            "{}: the name must end in `.brdf`, `.bsdf` or `.binary`",
            path.display()
        )),
    }
}

/// The greatest of ∫|table − model| cos θi dωi over elevations of `wo` up to 75° and over 450, 550 and 650 nm.
fn resolution_error(model: &Model, table: &BrdfTable) -> f32 {
    const STEPS: [usize; 2] = [64, 96];
    let lambda = [450.0, 550.0, 650.0, 650.0];
    let at = table.at(Vec4::from_array(lambda));
    let mut worst = 0.0f32;
    for step in 0..=10 {
        let theta = 7.5f32.to_radians() * step as f32;
        let wo = direction(theta, 0.3);
        let mut sum = Vec4::ZERO;
        for i in 0..STEPS[0] {
            let theta = FRAC_PI_2 * (i as f32 + 0.5) / STEPS[0] as f32;
            for j in 0..STEPS[1] {
                let wi = direction(theta, TAU * (j as f32 + 0.5) / STEPS[1] as f32);
                let expected = Vec4::from_slice(&model.value(wo, wi, &lambda));
                let (value, _) = at.eval_and_density(wo, wi);
                sum += (value - expected).abs() * wi.truncate().length();
            }
        }
        let cell = FRAC_PI_2 * TAU / (STEPS[0] * STEPS[1]) as f32;
        worst = worst.max((sum * cell).max_element());
    }
    worst
}

/// The direction at an elevation and an azimuth.
fn direction(theta: f32, phi: f32) -> Vec3 {
    let (s, c) = etalon_math::float::sin_cos(theta);
    let (y, x) = etalon_math::float::sin_cos(phi);
    Vec3::new(s * x, s * y, c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_tables::tensor_file::{self, Array, TensorFile};
    use etalon_validation::folders;

    /// The greatest error is stated from other elevations: a table must keep to it between them too.
    #[test]
    fn a_tabulated_conductor_keeps_to_the_error_that_its_table_states() {
        let words = ["roughconductor", "material=Au", "alpha=0.3"].map(str::to_owned);
        let model = Model::read(&words).expect("the model is well-formed");
        let bytes =
            fs::read(folders::scenes().join("measured/gold.brdf")).expect("the scene has it");
        let table = BrdfTable::parse(&bytes).expect("the scene can be rendered");
        let BrdfTable::Spectral(read) = &table else {
            panic!("the table is a spectral one");
        };
        let stated = read.resolution_error.expect("the program writes it");
        assert!(stated < 0.02, "{stated}");
        let error = resolution_error(&model, &table);
        assert!(error <= stated * 1.001, "{error} where {stated} is stated");
        // A table that is brighter by a twentieth is found out.
        let file = TensorFile::parse(&bytes).expect("it was parsed before");
        let mut brighter = file.tensor(spectral::FIELD, 4).expect("the field is there");
        for value in &mut brighter.data {
            *value *= 1.05;
        }
        let names = ["theta_o", "theta_i", "phi", "wavelengths"];
        let axes = names.map(|name| file.abscissae(name).expect("the field is there"));
        let lengths = axes.each_ref().map(|axis| [axis.len()]);
        let mut fields: Vec<(&str, Array<'_>)> = (names.iter().zip(&axes).zip(&lengths))
            .map(|((name, axis), length)| (*name, Array::Floats(axis, length)))
            .collect();
        fields.push((
            spectral::FIELD,
            Array::Floats(&brighter.data, &brighter.shape),
        ));
        let brighter = BrdfTable::parse(&tensor_file::write(&fields)).expect("it is well-formed");
        assert!(resolution_error(&model, &brighter) > stated);
    }
}
