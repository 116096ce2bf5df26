"""Renders a scene with Mitsuba 3 when told to, for `cargo xtask speed`.

Says `ready WIDTH HEIGHT` once everything is compiled. Each line `SEED FILE` on standard input is a picture to
render; its linear RGB goes into the file as little-endian 32-bit floats, and its seconds to standard output.
"""

import argparse
import os
import sys
import time


def load(mi, variant, path, defines, rfilter):
    """The scene, with this reconstruction filter in place of its own."""
    mi.file_resolver().append(os.path.dirname(os.path.abspath(path)))
    config = mi.parser.ParserConfig(variant)
    state = mi.parser.parse_file(config, path, **defines)
    filters = {"box", "tent", "gaussian", "mitchell", "catmullrom", "lanczos"}
    for node in state.nodes:
        if rfilter is not None and node.props.plugin_name() in filters:
            node.props.set_plugin_name(rfilter)
    mi.parser.transform_all(config, state)
    scene = mi.parser.instantiate(config, state)
    return scene[0] if isinstance(scene, list) else scene


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene")
    parser.add_argument("--spp", type=int, required=True)
    parser.add_argument("--threads", type=int, required=True)
    parser.add_argument("--variant", required=True)
    parser.add_argument("--filter")
    parser.add_argument("-D", "--define", action="append", default=[], metavar="KEY=VALUE")
    arguments = parser.parse_args()

    import drjit as dr
    import mitsuba as mi
    import numpy as np

    mi.set_variant(arguments.variant)
    dr.set_thread_count(arguments.threads)
    defines = dict(pair.split("=", 1) for pair in arguments.define)
    scene = load(mi, arguments.variant, arguments.scene, defines, arguments.filter)

    def render(seed):
        """The pixels, when they are there."""
        pixels = np.array(mi.render(scene, spp=arguments.spp, seed=seed))
        return np.ascontiguousarray(pixels[..., :3], dtype="<f4")

    height, width, _ = render(0).shape
    print("ready", width, height, flush=True)
    for line in sys.stdin:
        seed, file = line.split(maxsplit=1)
        start = time.perf_counter()
        pixels = render(int(seed))
        seconds = time.perf_counter() - start
        with open(file.strip(), "wb") as output:
            output.write(pixels.tobytes())
        print(seconds, flush=True)


if __name__ == "__main__":
    main()
