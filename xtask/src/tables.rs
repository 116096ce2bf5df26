//! `cargo xtask tables`: regenerates the data of `crates/spectrum/data` and `crates/lights/data`.
//!
//! - `rgb2spec.bin`, the coefficients of smooth spectra for RGB colours, is fitted from nothing but
//!   the tables of the CIE; the bytes are the same on every machine.
//! - `hosek_wilkie.bin` of `crates/lights/data`, the coefficients of the clear sky and the sun in single precision, from
//!   Mitsuba's `sunsky_datasets.bin`, named by `--sky`.
//! - `conductors.txt`, complex refractive indices, is distilled from a copy of the
//!   refractiveindex.info database (CC0 1.0) named by `--refractiveindex`; without it the file
//!   stays as it is.

use etalon_spectrum::upsample::table;
use etalon_tables::tensor_file::{self, Array, TensorFile};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// What to write.
#[derive(Clone, Debug, Default, clap::Args)]
pub(crate) struct Arguments {
    /// Root of a copy of the refractiveindex.info database (the folder that holds `database/`)
    #[arg(long, value_name = "DIR")]
    pub(crate) refractiveindex: Option<PathBuf>,
    /// Mitsuba's `data/sunsky/sunsky_datasets.bin`, which has Hošek and Wilkie's numbers
    #[arg(long, value_name = "FILE")]
    pub(crate) sky: Option<PathBuf>,
}

/// Range that the table of every conductor covers, nm.
const RANGE: [f64; 2] = [360.0, 830.0];

/// Pages with more knots than one per this many nanometres are resampled at this step.
const STEP: f64 = 5.0;

/// Name of a conductor and its page below `database/data`. Where Mitsuba has the name, the page is the
/// one whose reflectances under D65 come nearest to Mitsuba's.
const CONDUCTORS: &[(&str, &str)] = &[
    ("a-C", "main/C/nk/Arakawa.yml"),
    ("Ag", "main/Ag/nk/Rakic-LD.yml"),
    ("Al", "main/Al/nk/Rakic-LD.yml"),
    ("Au", "main/Au/nk/Olmon-ts.yml"),
    ("Co", "main/Co/nk/Johnson.yml"),
    ("Cr", "main/Cr/nk/Sytchkova.yml"),
    ("Cu", "main/Cu/nk/Hagemann.yml"),
    ("d-C", "main/C/nk/Phillip.yml"),
    ("Fe", "main/Fe/nk/Johnson.yml"),
    ("Hg", "main/Hg/nk/Inagaki.yml"),
    ("Ni", "main/Ni/nk/Rakic-LD.yml"),
    ("Pt", "main/Pt/nk/Rakic-LD.yml"),
    ("Si", "main/Si/nk/Green-2008.yml"),
    ("Ti", "main/Ti/nk/Johnson.yml"),
    ("W", "main/W/nk/Weaver.yml"),
];

/// Writes the tables, and says on standard output what it wrote.
pub(crate) fn run(arguments: &Arguments) -> Result<(), String> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/spectrum/data");
    let coefficients: Vec<u8> = table::build()
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect();
    write(&data.join("rgb2spec.bin"), &coefficients)?;
    if let Some(datasets) = &arguments.sky {
        let bytes = sky(datasets).map_err(|e| format!("{}: {e}", datasets.display()))?;
        write(&data.join("../../lights/data/hosek_wilkie.bin"), &bytes)?;
    }
    match &arguments.refractiveindex {
        Some(database) => write(
            &data.join("conductors.txt"),
            conductors(database)?.as_bytes(),
        ),
        None => {
            println!("conductors.txt stays as it is: no --refractiveindex DIR");
            Ok(())
        }
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let before = fs::read(path).ok();
    fs::write(path, bytes).map_err(|e| format!("{}: {e}", path.display()))?;
    let change = match before {
        Some(old) if old == bytes => "unchanged",
        Some(_) => "changed",
        None => "new",
    };
    println!("{}: {} bytes, {change}", path.display(), bytes.len());
    Ok(())
}

/// The spectral fields of a file of skies, with their numbers of dimensions, in single precision.
fn sky(datasets: &Path) -> Result<Vec<u8>, String> {
    const FIELDS: [(&str, usize); 4] = [
        ("sky_params_spec", 5),
        ("sky_rad_spec", 4),
        ("sun_rad_spec", 4),
        ("sun_ld_spec", 2),
    ];
    let bytes = fs::read(datasets).map_err(|e| e.to_string())?;
    let file = TensorFile::parse(&bytes).map_err(|e| e.to_string())?;
    let tensors = FIELDS.map(|(name, dimensions)| file.tensor(name, dimensions));
    let mut fields = Vec::new();
    for ((name, _), tensor) in FIELDS.iter().zip(&tensors) {
        let tensor = tensor.as_ref().map_err(ToString::to_string)?;
        fields.push((*name, Array::Floats(&tensor.data, &tensor.shape)));
    }
    Ok(tensor_file::write(&fields))
}

/// The text of `conductors.txt`.
fn conductors(database: &Path) -> Result<String, String> {
    let mut text = String::from(
        "# Complex refractive indices from refractiveindex.info (public domain, CC0 1.0).\n\
         # Written by `cargo xtask tables`. Per material: a line with its name and its page in the\n\
         # database, then wavelength in nm, n, k.\n",
    );
    for (name, page) in CONDUCTORS {
        let path = database.join("database/data").join(page);
        let yaml = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        let knots = tabulated_nk(&yaml)
            .and_then(|knots| over_range(&knots))
            .map_err(|e| format!("{}: {e}", path.display()))?;
        let _ = writeln!(text, "\n[{name}] {page}");
        for [lambda, n, k] in knots {
            let _ = writeln!(text, "{lambda} {n} {k}");
        }
    }
    Ok(text)
}

/// The (nm, n, k) rows of a page's block `tabulated nk`.
fn tabulated_nk(yaml: &str) -> Result<Vec<[f64; 3]>, String> {
    let mut rows: Vec<[f64; 3]> = Vec::new();
    let block = yaml
        .lines()
        .skip_while(|line| line.trim() != "- type: tabulated nk")
        .skip(1)
        .skip_while(|line| line.trim() == "data: |")
        .take_while(|line| line.starts_with("        "));
    for line in block {
        let numbers: Vec<f64> = line
            .split_whitespace()
            .map(|word| {
                word.parse()
                    .map_err(|_| format!("\"{word}\" is not a number"))
            })
            .collect::<Result<_, String>>()?;
        let [micrometres, n, k] = numbers[..] else {
            return Err(format!("\"{line}\": expected a wavelength, n and k"));
        };
        rows.push([rounded(micrometres * 1e3), n, k]);
    }
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    rows.dedup_by_key(|row| row[0]);
    Ok(rows)
}

/// `rows` restricted to [`RANGE`], with interpolated rows at its ends; resampled if very dense.
fn over_range(rows: &[[f64; 3]]) -> Result<Vec<[f64; 3]>, String> {
    let (Some(first), Some(last)) = (rows.first(), rows.last()) else {
        return Err("no block \"tabulated nk\"".to_owned());
    };
    if first[0] > RANGE[0] || last[0] < RANGE[1] {
        return Err(format!(
            "covers {}–{} nm, not {}–{} nm",
            first[0], last[0], RANGE[0], RANGE[1]
        ));
    }
    let inside = rows
        .iter()
        .filter(|row| row[0] > RANGE[0] && row[0] < RANGE[1]);
    let steps = ((RANGE[1] - RANGE[0]) / STEP) as usize;
    if inside.clone().count() >= steps {
        return Ok((0..=steps)
            .map(|i| interpolated(rows, RANGE[0] + STEP * i as f64))
            .collect());
    }
    Ok(std::iter::once(interpolated(rows, RANGE[0]))
        .chain(inside.copied())
        .chain(std::iter::once(interpolated(rows, RANGE[1])))
        .collect())
}

/// The row at `lambda` nm, which the rows cover.
fn interpolated(rows: &[[f64; 3]], lambda: f64) -> [f64; 3] {
    let after = rows
        .partition_point(|row| row[0] <= lambda)
        .clamp(1, rows.len() - 1);
    let (a, b) = (rows[after - 1], rows[after]);
    let f = (lambda - a[0]) / (b[0] - a[0]);
    [
        lambda,
        rounded(a[1] + f * (b[1] - a[1])),
        rounded(a[2] + f * (b[2] - a[2])),
    ]
}

/// `value` to six decimals, so that the file does not show rounding noise.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "COMMENTS: |\n    none\nDATA:\n  - type: tabulated nk\n    data: |\n        \
                        0.350 1.0 2.0\n        0.370 3.0 4.0\n        0.840 3.0 0.5\nSPECS:\n    x: 1\n";

    #[test]
    fn a_page_is_cut_to_the_range() {
        let rows = tabulated_nk(PAGE).expect("the page is well-formed");
        assert_eq!(rows.len(), 3);
        let cut = over_range(&rows).expect("the page covers the range");
        assert_eq!(cut[0], [360.0, 2.0, 3.0]);
        assert_eq!(cut[1], [370.0, 3.0, 4.0]);
        assert_eq!(cut[2][0], 830.0);
        assert!(over_range(&rows[1..]).is_err());
    }

    #[test]
    fn a_bad_page_is_refused() {
        assert!(tabulated_nk(&PAGE.replace("3.0 4.0", "3.0")).is_err());
        assert!(tabulated_nk(&PAGE.replace("4.0", "x")).is_err());
        assert!(over_range(&tabulated_nk("DATA:\n").expect("no rows is not malformed")).is_err());
    }
}
