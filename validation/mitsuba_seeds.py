"""Renders a scene with Mitsuba 3, once per seed, for `cargo xtask references`.

Writes the linear RGB pixels of every seed as little-endian 32-bit floats, seed after seed, row
after row, into one file, and prints what rendered them as JSON.
"""

import argparse
import json
import math
import os
import sys


def check_samples(spp):
    """Refuses a number of samples that Mitsuba would not take as it is.

    The stratified sampler rounds up to the next square without more than a remark in its log. The
    reference would state fewer samples than it has.
    """
    side = math.isqrt(max(spp, 0))
    if spp < 1 or side * side != spp:
        near = " or ".join(str(n * n) for n in (side, side + 1) if n > 0)
        sys.exit(f"--spp {spp}: stratified samples come in squares, such as {near}")


def choose_variant(mi, wanted):
    """The wanted variant, if it can be set up: the LLVM ones need a recent libLLVM."""
    for variant in [wanted, "scalar_spectral"]:
        try:
            mi.set_variant(variant)
            if variant.startswith("llvm"):
                import drjit as dr

                dr.eval(mi.Float(1) + 1)
            return variant
        except Exception as error:
            print(f"{variant}: {error}", file=sys.stderr)
    sys.exit("no spectral variant of Mitsuba works here")


def load(mi, variant, path, defines):
    """The scene, with stratified samples within each pixel: the same means with less noise.

    Films sample beyond their borders, as ours do: it matters for filters wider than a pixel.
    """
    mi.file_resolver().append(os.path.dirname(os.path.abspath(path)))
    config = mi.parser.ParserConfig(variant)
    state = mi.parser.parse_file(config, path, **defines)
    for node in state.nodes:
        if node.props.plugin_name() == "independent":
            node.props.set_plugin_name("stratified")
        if node.props.plugin_name() == "hdrfilm":
            node.props["sample_border"] = True
    mi.parser.transform_all(config, state)
    scene = mi.parser.instantiate(config, state)
    return scene[0] if isinstance(scene, list) else scene


def render(mi, scene, spp, seed):
    """A picture. What cannot be traced as one kernel (`timed_sunsky` of Mitsuba 3.9.1) is evaluated step by step."""
    try:
        return mi.render(scene, spp=spp, seed=seed)
    except RuntimeError:
        import drjit as dr

        flags = [dr.JitFlag.SymbolicCalls, dr.JitFlag.SymbolicLoops, dr.JitFlag.SymbolicConditionals]
        if not any(dr.flag(flag) for flag in flags):
            raise
        for flag in flags:
            dr.set_flag(flag, False)
        return mi.render(scene, spp=spp, seed=seed)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene")
    parser.add_argument("output")
    parser.add_argument("--spp", type=int, required=True)
    parser.add_argument("--seeds", type=int, required=True)
    parser.add_argument("--variant", default="llvm_ad_spectral")
    parser.add_argument("-D", "--define", action="append", default=[], metavar="KEY=VALUE")
    arguments = parser.parse_args()
    check_samples(arguments.spp)

    import mitsuba as mi
    import numpy as np

    variant = choose_variant(mi, arguments.variant)
    defines = dict(pair.split("=", 1) for pair in arguments.define)
    scene = load(mi, variant, arguments.scene, defines)
    shape = None
    skipped = []
    written = 0
    seed = 0
    with open(arguments.output, "wb") as output:
        while written < arguments.seeds:
            seed += 1
            pixels = np.array(render(mi, scene, arguments.spp, seed))
            rgb = np.ascontiguousarray(pixels[..., :3], dtype="<f4")
            shape = rgb.shape
            if np.isfinite(rgb).all():
                output.write(rgb.tobytes())
                written += 1
                continue
            # One path in a thousand million that Mitsuba loses spoils a whole seed. The seed is
            # left out and named; a scene in which that is common is no reference.
            skipped.append(seed)
            if len(skipped) > arguments.seeds // 8:
                sys.exit(f"pixels that are not finite in seeds {skipped}")
    facts = {
        "mitsuba": mi.__version__,
        "variant": variant,
        "height": shape[0],
        "width": shape[1],
        "skipped_seeds": skipped,
    }
    print(json.dumps(facts))


if __name__ == "__main__":
    main()
