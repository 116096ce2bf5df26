//! Nodes, instances, cameras, lights, and what stands in for what glTF does not say.

use super::*;
use crate::same_tree::children;

/// A model of nodes, one mesh without material, and further members.
fn nodes(nodes: &str, more: &str) -> String {
    model(&format!(
        r#""meshes": [{{"name": "tri", "primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 2}}, "indices": 3}}]}}],
        "nodes": [{nodes}] {more}"#
    ))
}

const DEFAULT: &str = r#"<bsdf type="twosided"><bsdf type="principled"><rgb name="base_color" value="1,1,1"/>
    <float name="eta" value="1.5"/><string name="diffuse_model" value="lambert"/><float name="metallic" value="1"/><float name="roughness" value="1"/></bsdf></bsdf>"#;

#[test]
fn a_mesh_in_two_places_is_a_group() {
    let text = nodes(
        r#"{"children": [1, 2], "scale": [1, 2, 3]},
        {"mesh": 0, "translation": [1, 0, 0], "rotation": [0, 0, 1, 0]},
        {"mesh": 0, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,5,1]}"#,
        "",
    );
    let xml = format!(
        r#"<shape type="shapegroup" id="g"><shape type="ply">
        <string name="filename" value="mesh 0 of the scene file"/>{DEFAULT}</shape></shape>
        <shape type="instance"><ref id="g"/><transform name="to_world"><rotate z="1" angle="180"/><translate x="1"/>
            <scale x="1" y="2" z="3"/></transform></shape>
        <shape type="instance"><ref id="g"/><transform name="to_world"><translate z="5"/>
            <scale x="1" y="2" z="3"/></transform></shape>"#
    );
    assert_same(&text, &xml);
    assert_eq!(sound(&text).meshes.len(), 1);
}

#[test]
fn the_default_scene_counts() {
    let scenes = r#", "scenes": [{"nodes": [0]}, {"nodes": [1]}], "scene": 1"#;
    let text = nodes(
        r#"{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 1]}"#,
        scenes,
    );
    let xml = format!(
        r#"<shape type="ply"><string name="filename" value="mesh 0 of the scene file"/>
        <transform name="to_world"><translate z="1"/></transform>{DEFAULT}</shape>"#
    );
    assert_same(&text, &xml);
}

/// A camera of glTF at (0, 1, 5) looks along −z.
#[test]
fn cameras_look_back() {
    let text = nodes(
        r#"{"mesh": 0}, {"camera": 0, "translation": [0, 1, 5], "scale": [2, 2, 2]}, {"camera": 1, "name": "top"}"#,
        r#", "cameras": [
            {"type": "perspective", "perspective": {"yfov": 0.5, "aspectRatio": 1.5, "znear": 0.1, "zfar": 100}},
            {"type": "orthographic", "orthographic": {"xmag": 4, "ymag": 2, "znear": 0.5, "zfar": 10}}]"#,
    );
    let film = |width: u32| {
        format!(
            r#"<film type="hdrfilm"><integer name="width" value="{width}"/><integer name="height" value="720"/></film>
            <sampler type="sobol"><integer name="sample_count" value="64"/></sampler>"#
        )
    };
    let xml = format!(
        r#"<sensor type="perspective"><transform name="to_world"><lookat origin="0,1,5" target="0,1,4" up="0,1,0"/></transform>
        <float name="fov" value="28.64788975654116"/><string name="fov_axis" value="y"/>
        <float name="near_clip" value="0.10000000149"/><float name="far_clip" value="100"/>{}</sensor>
        <sensor type="orthographic"><transform name="to_world"><scale x="4" y="4"/>
            <lookat origin="0,0,0" target="0,0,-1" up="0,1,0"/></transform>
        <float name="near_clip" value="0.5"/><float name="far_clip" value="10"/>{}</sensor>"#,
        film(1080),
        film(1440)
    );
    assert_same(&text, &xml);
    let sensors = children(&sound(&text).root);
    let named = sensors.iter().any(|node| node.id.as_deref() == Some("top"));
    assert!(named, "{sensors:?}");
}

/// 683 cd of a point are 1 W/sr. All of them shine along −z of their node.
#[test]
fn lights_are_of_watts() {
    let light =
        |number| format!(r#""extensions": {{"KHR_lights_punctual": {{"light": {number}}}}}"#);
    let text = nodes(
        &format!(
            r#"{{{}, "translation": [1, 2, 3]}}, {{{}, "rotation": [1, 0, 0, 0]}}, {{{}, "translation": [0, 0, 2]}}"#,
            light(0),
            light(1),
            light(2)
        ),
        r#", "extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "point", "intensity": 683, "color": [1, 0.5, 0]}, {"type": "directional", "intensity": 1366},
            {"type": "spot", "intensity": 683, "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}}]}}"#,
    );
    let xml = r#"<emitter type="point"><point name="position" x="1" y="2" z="3"/><rgb name="intensity" value="1,0.5,0"/></emitter>
        <emitter type="directional"><vector name="direction" x="0" y="0" z="1"/><rgb name="irradiance" value="2,2,2"/></emitter>
        <emitter type="spot"><rgb name="intensity" value="1,1,1"/><string name="falloff" value="quadratic_in_cosine"/>
        <transform name="to_world"><lookat origin="0,0,2" target="0,0,0" up="0,1,0"/></transform>
        <float name="cutoff_angle" value="28.64788975654116"/><float name="beam_width" value="14.32394487827058"/></emitter>"#;
    assert_same(&text, xml);
}

#[test]
fn stand_ins_are_noted() {
    let outcome = read(&nodes(r#"{"mesh": 0}"#, ""));
    let said = outcome.lines();
    assert!(said.contains("note: the scene has no camera"), "{said}");
    assert!(said.contains("even light of radiance 1"), "{said}");
    let root = outcome.document.expect("a document").root;
    let plugins: Vec<String> = (children(&root).iter())
        .map(|node| node.plugin.value.clone())
        .collect();
    assert_eq!(plugins, ["path", "perspective", "ply", "constant"]);
    let options = ReadOptions {
        environment: Some("/sky.exr".into()),
        integrator: Some("bdpt".into()),
        ..ReadOptions::default()
    };
    let text = nodes(r#"{"mesh": 0}"#, "");
    let outcome = read_bytes("a.gltf", text.as_bytes(), &options);
    let document = outcome.document.expect("a document");
    let xml = xml(
        r#"<integrator type="bdpt"/><emitter type="envmap"><string name="filename" value="/sky.exr"/></emitter>"#,
    );
    assert_alike(&document, &xml);
}
