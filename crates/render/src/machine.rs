//! What the program was compiled for, and whether this machine can run it.
//!
//! A seed gives the same bits wherever multiply-adds are fused: on x86-64 that is the level x86-64-v3 (AVX2 and FMA), which
//! `.cargo/config.toml` of the repository asks for. That file travels neither with packages nor with `cargo install`.

use etalon_math::lane::FUSES;

/// Whether the compiler used AVX2.
const AVX2: bool = cfg!(all(target_arch = "x86_64", target_feature = "avx2"));

/// The instructions that the program uses.
pub fn level() -> &'static str {
    match (std::env::consts::ARCH, AVX2, FUSES) {
        ("x86_64", true, true) => "x86-64-v3 (AVX2, FMA)",
        ("x86_64", _, _) => "x86-64 without fused multiply-adds",
        ("aarch64", _, true) => "aarch64 (NEON)",
        (other, _, _) => other,
    }
}

/// Why this machine cannot run the program, if so. To be asked before anything else, as what is missing ends a program without a word;
/// so simple that the compiler uses nothing of it here.
#[inline(never)]
pub fn refusal() -> Option<&'static str> {
    #[cfg(target_arch = "x86_64")]
    {
        // The standard library's own question is answered by the compiler where it may use the instructions already.
        let cpu = raw_cpuid::CpuId::new();
        let has_fma = cpu.get_feature_info().is_some_and(|f| f.has_fma());
        let has_avx2 = (cpu.get_extended_feature_info()).is_some_and(|f| f.has_avx2());
        if (FUSES && !has_fma) || (AVX2 && !has_avx2) {
            return Some(
                "this processor has no AVX2 or no FMA, which this build of Etalon needs (x86-64-v3: most of Intel's since 2013, of \
                 AMD's since 2015); build it from source with RUSTFLAGS=\"-C target-cpu=native\"",
            );
        }
    }
    None
}

/// What one should know of a build without fused multiply-adds.
pub fn remark() -> Option<&'static str> {
    (cfg!(target_arch = "x86_64") && !FUSES).then_some(
        "built without fused multiply-adds: slower, and a seed gives other bits than elsewhere; build with \
         RUSTFLAGS=\"-C target-cpu=x86-64-v3\"",
    )
}
