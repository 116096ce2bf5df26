"""Writes mitsuba_values.txt: values of Mitsuba 3.9.1's BSDFs (variant scalar_spectral).

    python mitsuba_values.py > mitsuba_values.txt

A line `material …` gives a material in the notation of `notation.rs`; the lines after it are

    eval MODE ; wo ; wi ; value ; pdf
    sample MODE SAMPLE1 ; wo ; wi ; value ; pdf ; eta
    albedo radiance ; wo ; wo ; value ; 0

with one value, or four at 450, 500, 550 and 600 nm. Values include |cos|; a discrete sample's
value is weight times pdf. `wo` is the known direction (Mitsuba's `wi`).
"""
import math
import pathlib
import random

import mitsuba as mi

mi.set_variant("scalar_spectral")
import drjit as dr
import numpy as np

SCENES = pathlib.Path(__file__).resolve().parents[4] / "scenes"
LAMBDA = [450.0, 500.0, 550.0, 600.0]
MODES = {"radiance": mi.TransportMode.Radiance, "importance": mi.TransportMode.Importance}


def parse(tokens):
    """`type key=kind:value ( nested ) …` to a Mitsuba dictionary."""
    out = {"type": tokens.pop(0)}
    while tokens and tokens[0] != ")":
        token = tokens.pop(0)
        if token == "(":
            out[f"nested{len(out)}"] = parse(tokens)
            tokens.pop(0)
            continue
        key, rest = token.split("=", 1)
        kind, value = rest.split(":", 1)
        if kind == "f":
            out[key] = float(value)
        elif kind == "s":
            out[key] = value.replace("_", " ")
            if key == "filename":
                out[key] = str(SCENES / value)
        elif kind == "b":
            out[key] = value == "true"
        elif kind == "u":
            out[key] = {"type": "uniform", "value": float(value)}
        elif kind == "t":
            pairs = [p.split(":") for p in value.split(",")]
            out[key] = {
                "type": "irregular",
                "wavelengths": ",".join(p[0] for p in pairs),
                "values": ",".join(p[1] for p in pairs),
            }
    return out


CONTINUOUS = [
    "diffuse reflectance=u:0.7",
    "diffuse reflectance=t:400:0.1,500:0.6,700:0.9",
    "roughconductor alpha=f:0.3 eta=u:0.2 k=u:3.9",
    "roughconductor alpha=f:0.1 distribution=s:ggx eta=t:400:1.5,700:0.2 k=t:400:1.8,700:3.5",
    "roughconductor alpha_u=f:0.1 alpha_v=f:0.4 distribution=s:ggx specular_reflectance=u:0.8",
    "roughconductor alpha_u=f:0.5 alpha_v=f:0.15 eta=u:1.4 k=u:7.5",
    "roughconductor alpha=f:0.25 sample_visible=b:false eta=u:1.4 k=u:7.5",
    "roughconductor alpha=f:0.25 distribution=s:ggx sample_visible=b:false eta=u:1.4 k=u:7.5",
    "roughdielectric alpha=f:0.3",
    "roughdielectric alpha=f:0.2 distribution=s:ggx int_ior=f:1.5 ext_ior=f:1",
    "roughdielectric alpha_u=f:0.15 alpha_v=f:0.4 distribution=s:ggx int_ior=s:water ext_ior=s:diamond",
    "roughdielectric alpha_u=f:0.4 alpha_v=f:0.2 int_ior=s:carbon_dioxide ext_ior=s:bk7 "
    "specular_reflectance=u:0.5 specular_transmittance=t:400:0.2,700:0.9",
    "roughdielectric alpha=f:0.3 sample_visible=b:false",
    "plastic diffuse_reflectance=u:0.5",
    "plastic diffuse_reflectance=t:400:0.1,700:0.9 nonlinear=b:true int_ior=f:1.9",
    "plastic diffuse_reflectance=u:0.4 int_ior=f:1 ext_ior=f:1.3",
    "roughplastic alpha=f:0.1",
    "roughplastic alpha=f:0.3 distribution=s:ggx diffuse_reflectance=t:400:0.1,700:0.9 nonlinear=b:true",
    "roughplastic alpha=f:0.5 int_ior=f:1.9 specular_reflectance=u:0.3",
    "roughplastic alpha=f:0.05 distribution=s:ggx sample_visible=b:false",
    "principled",
    "principled base_color=u:0.8 metallic=f:0.7 specular=f:0.6 roughness=f:0.4 anisotropic=f:0.5 sheen=f:0.3 "
    "clearcoat=f:0.6 clearcoat_gloss=f:0.3 spec_trans=f:0.4",
    "principled base_color=t:400:0.1,700:0.9 spec_trans=f:0.8 eta=f:1.4 roughness=f:0.5 flatness=f:0.5",
    "principled base_color=t:400:0.1,700:0.9 metallic=f:1 roughness=f:0.3",
    "principledthin",
    "principledthin base_color=t:400:0.1,700:0.8 roughness=f:0.5 spec_trans=f:0.6 diff_trans=f:0.8 anisotropic=f:0.5 "
    "sheen=f:0.3 flatness=f:0.5 eta=f:1.4",
    "mask opacity=f:0.3 ( diffuse reflectance=u:0.8 )",
    "twosided ( diffuse reflectance=u:0.8 )",
    "twosided ( roughconductor alpha_u=f:0.1 alpha_v=f:0.4 ) ( diffuse reflectance=u:0.2 )",
    "twosided allow_transmission=b:true ( roughdielectric alpha=f:0.4 )",
    "blendbsdf weight=f:0.2 ( diffuse reflectance=u:0.8 ) ( roughconductor alpha=f:0.4 eta=u:0.2 k=u:3.9 )",
    "mask opacity=f:0.6 ( blendbsdf weight=f:0.7 ( plastic ) ( twosided ( diffuse ) ) )",
    "pplastic",
    "pplastic alpha=f:0.3 distribution=s:ggx diffuse_reflectance=t:400:0.1,700:0.9 specular_reflectance=u:0.7",
    "measured filename=s:measured/gold.bsdf",
    "measured filename=s:measured/brushed.bsdf",
    "hair",
    "hair eumelanin=f:0.3 pheomelanin=f:0.6 longitudinal_roughness=f:0.5 azimuthal_roughness=f:0.6 scale_tilt=f:0",
    "hair sigma_a=t:400:0.1,700:2 longitudinal_roughness=f:0.2 azimuthal_roughness=f:0.9 scale_tilt=f:4",
    "pplastic alpha_u=f:0.15 alpha_v=f:0.4 int_ior=f:1.9 sample_visible=b:false diffuse_reflectance=u:0.2",
]
DISCRETE = [
    "dielectric",
    "dielectric int_ior=f:1.3 ext_ior=f:2 specular_reflectance=u:0.5 specular_transmittance=t:400:0.2,700:0.9",
    "thindielectric",
    "thindielectric int_ior=s:diamond specular_reflectance=u:0.5 specular_transmittance=u:0.25",
    "conductor",
    "conductor eta=t:400:1.5,700:0.2 k=t:400:1.8,700:3.5 specular_reflectance=u:0.9",
    "plastic",
    "plastic int_ior=f:1.9 specular_reflectance=u:0.4 nonlinear=b:true",
    "mask opacity=f:0.3 ( conductor eta=u:0.2 k=u:3.9 )",
    "null",
]


def direction(theta, phi):
    t, p = math.radians(theta), math.radians(phi)
    v = [math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t)]
    return [float(np.float32(x)) for x in v]


def interaction(wo):
    si = dr.zeros(mi.SurfaceInteraction3f)
    si.t, si.wi, si.wavelengths = 1.0, mi.Vector3f(wo), LAMBDA
    si.n, si.sh_frame = mi.Normal3f(0, 0, 1), mi.Frame3f(mi.Normal3f(0, 0, 1))
    return si


def show(values):
    return " ".join(f"{float(v):.9g}" for v in values)


def lanes(values):
    texts = [f"{float(v):.7g}" for v in values]
    return texts[0] if len(set(texts)) == 1 else " ".join(texts)


random.seed(1)
OUT = [0, 40, 75, 89.5, 100, 140]
for text in CONTINUOUS:
    bsdf = mi.load_dict(parse(text.split()))
    print("material", text)
    for theta in (40, 140):
        wo = direction(theta, 30)
        value = bsdf.eval_diffuse_reflectance(interaction(wo))
        print(f"albedo radiance ; {show(wo)} ; {show(wo)} ; {lanes(value)} ; 0")
    zeros = 0
    for theta in OUT:
        wo = direction(theta, random.uniform(0, 360))
        mirror = [-wo[0], -wo[1], wo[2]]
        through = [-wo[0], -wo[1], -wo[2]]
        for i in range(7):
            if i < 2:
                near = mirror if i == 0 else through
                v = np.array(near) + [random.gauss(0, 0.15) for _ in range(3)]
                wi = [float(np.float32(x)) for x in v / np.linalg.norm(v)]
            else:
                wi = direction([15, 50, 89, 100, 160][i - 2], random.uniform(0, 360))
            mode = "importance" if "dielectric" in text and i % 3 == 1 else "radiance"
            context = mi.BSDFContext(MODES[mode])
            si = interaction(wo)
            value = bsdf.eval(context, si, mi.Vector3f(wi))
            pdf = bsdf.pdf(context, si, mi.Vector3f(wi))
            if max(value) == 0:
                zeros += 1
                if zeros > 4:
                    continue
            print(f"eval {mode} ; {show(wo)} ; {show(wi)} ; {lanes(value)} ; {lanes([pdf])}")
for text in DISCRETE:
    bsdf = mi.load_dict(parse(text.split()))
    print("material", text)
    for theta in OUT:
        wo = direction(theta, random.uniform(0, 360))
        for u_lobe in (1e-6, 0.9999):
            for mode in ("radiance", "importance") if "dielectric" in text else ("radiance",):
                context = mi.BSDFContext(MODES[mode])
                s, weight = bsdf.sample(context, interaction(wo), u_lobe, [0.3, 0.6])
                delta = mi.has_flag(s.sampled_type, mi.BSDFFlags.Delta) or mi.has_flag(
                    s.sampled_type, mi.BSDFFlags.Null
                )
                if max(weight) == 0 or not delta:
                    continue
                value = [w * s.pdf for w in weight]
                print(
                    f"sample {mode} {u_lobe} ; {show(wo)} ; {show(s.wo)} ; "
                    f"{lanes(value)} ; {lanes([s.pdf])} ; {lanes([s.eta])}"
                )
