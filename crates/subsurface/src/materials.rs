//! Measured coefficients of matter, by name.
//!
//! σs′ = (1 − g) σs and σa at red, green and blue, mm⁻¹: with an isotropic phase function they stand for the matter, whatever its
//! own (H. W. Jensen et al. 2001, "A Practical Model for Subsurface Light Transport", figure 5; S. G. Narasimhan et al. 2006,
//! "Acquiring Scattering Properties of Participating Media by Dilution", table 1, undiluted).

/// Name, σs′, σa.
#[rustfmt::skip]
const MATERIALS: [(&str, [f64; 3], [f64; 3]); 37] = [
    ("apple", [2.29, 2.39, 1.97], [0.0030, 0.0034, 0.046]),
    ("chicken1", [0.15, 0.21, 0.38], [0.015, 0.077, 0.19]),
    ("chicken2", [0.19, 0.25, 0.32], [0.018, 0.088, 0.20]),
    ("cream", [7.38, 5.47, 3.15], [0.0002, 0.0028, 0.0163]),
    ("ketchup", [0.18, 0.07, 0.03], [0.061, 0.97, 1.45]),
    ("marble", [2.19, 2.62, 3.00], [0.0021, 0.0041, 0.0071]),
    ("potato", [0.68, 0.70, 0.55], [0.0024, 0.0090, 0.12]),
    ("skimmilk", [0.70, 1.22, 1.90], [0.0014, 0.0025, 0.0142]),
    ("skin1", [0.74, 0.88, 1.01], [0.032, 0.17, 0.48]),
    ("skin2", [1.09, 1.59, 1.79], [0.013, 0.070, 0.145]),
    ("spectralon", [11.6, 20.4, 14.9], [0.0, 0.0, 0.0]),
    ("wholemilk", [2.55, 3.21, 3.77], [0.0011, 0.0024, 0.014]),
    ("lowfat milk", [0.89187, 1.5136, 2.532], [0.002875, 0.00575, 0.0115]),
    ("reduced milk", [2.4858, 3.1669, 4.5214], [0.0025556, 0.0051111, 0.012778]),
    ("regular milk", [4.5513, 5.8294, 7.136], [0.0015333, 0.0046, 0.019933]),
    ("espresso", [0.72378, 0.84557, 1.0247], [4.7984, 6.5751, 8.8493]),
    ("mint mocha coffee", [0.31602, 0.38538, 0.48131], [3.772, 5.8228, 7.82]),
    ("lowfat soy milk", [0.30576, 0.34233, 0.61664], [0.0014375, 0.0071875, 0.035937]),
    ("regular soy milk", [0.59223, 0.73866, 1.4693], [0.0019167, 0.0095833, 0.065167]),
    ("lowfat chocolate milk", [0.64925, 0.83916, 1.1057], [0.0115, 0.0368, 0.1564]),
    ("regular chocolate milk", [1.4585, 2.1289, 2.9527], [0.010063, 0.043125, 0.14375]),
    ("coke", [8.9053e-5, 8.372e-5, 0.0], [0.10014, 0.16503, 0.2468]),
    ("pepsi", [6.1697e-5, 4.2564e-5, 0.0], [0.091641, 0.14158, 0.20729]),
    ("sprite", [6.0306e-6, 6.4139e-6, 6.5504e-6], [0.001886, 0.0018308, 0.0020025]),
    ("gatorade", [0.0024574, 0.003007, 0.0037325], [0.024794, 0.019289, 0.008878]),
    ("chardonnay", [1.7982e-5, 1.3758e-5, 1.2023e-5], [0.010782, 0.011855, 0.023997]),
    ("white zinfandel", [1.7501e-5, 1.9069e-5, 1.288e-5], [0.012072, 0.016184, 0.019843]),
    ("merlot", [2.1129e-5, 0.0, 0.0], [0.11632, 0.25191, 0.29434]),
    ("budweiser beer", [2.4356e-5, 2.4079e-5, 1.0564e-5], [0.011492, 0.024911, 0.057786]),
    ("coors light beer", [5.0922e-5, 4.301e-5, 0.0], [0.006164, 0.013984, 0.034983]),
    ("apple juice", [0.00013612, 0.00015836, 0.000227], [0.012957, 0.023741, 0.052184]),
    ("cranberry juice", [0.00010402, 0.00011646, 7.8139e-5], [0.039437, 0.094223, 0.12426]),
    ("grape juice", [5.382e-5, 0.0, 0.0], [0.10404, 0.23958, 0.29325]),
    ("ruby grapefruit juice", [0.011002, 0.010927, 0.011036], [0.085867, 0.18314, 0.25262]),
    ("white grapefruit juice", [0.22826, 0.23998, 0.32748], [0.0138, 0.018831, 0.056781]),
    ("shampoo", [0.0007176, 0.0008303, 0.0009016], [0.014107, 0.045693, 0.061717]),
    ("strawberry shampoo", [0.00015671, 0.00015947, 1.518e-5], [0.01449, 0.05796, 0.075823]),
];

/// [σa, σs′] (mm⁻¹, linear Rec. 709) of a material, in whatever letters it is written.
pub fn named(name: &str) -> Option<[[f64; 3]; 2]> {
    let plain = name.to_lowercase();
    let found = MATERIALS.iter().find(|(known, ..)| *known == plain);
    found.map(|(_, scattering, absorption)| [*absorption, *scattering])
}

/// The names.
pub fn names() -> impl Iterator<Item = &'static str> {
    MATERIALS.iter().map(|(name, ..)| *name)
}
