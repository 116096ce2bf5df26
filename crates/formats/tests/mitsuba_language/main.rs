//! The scene language, feature by feature.

mod mitsuba06;
mod old_files;

use etalon_formats::mitsuba::{read, read_text};
use etalon_formats::{Document, ReadOptions, ReadOutcome};
use etalon_params::{Class, DMat4, DVec3, Node, Property, SpectrumText, Value};
use std::path::Path;
use std::sync::Arc;

fn write(folder: &Path, name: &str, text: &str) {
    let path = folder.join(name);
    std::fs::create_dir_all(path.parent().expect("a folder")).expect("created");
    std::fs::write(path, text).expect("written");
}

/// Reads `main.xml` among `files`.
fn outcome(files: &[(&str, &str)], options: &ReadOptions) -> ReadOutcome {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, text) in files {
        write(folder.path(), name, text);
    }
    read(&folder.path().join("main.xml"), options)
}

fn document(outcome: ReadOutcome) -> Document {
    assert!(!outcome.has_errors(), "{}", outcome.lines());
    outcome.document.expect("a document without mistakes")
}

fn scene(body: &str) -> Document {
    let text = format!("<scene version=\"3.0.0\">{body}</scene>");
    document(outcome(&[("main.xml", &text)], &ReadOptions::default()))
}

#[test]
fn a_text_is_a_scene_of_no_file() {
    let text = "<scene version='3.0.0'>\n  <shape type='$kind'/></scene>";
    let options = ReadOptions {
        defines: vec![("kind".to_owned(), "sphere".to_owned())],
        ..ReadOptions::default()
    };
    let scene = document(read_text(text, &options));
    assert_eq!(children(&scene.root)[0].plugin.value, "sphere");
    let lines = read_text(text, &ReadOptions::default()).lines();
    assert!(lines.starts_with("<string>:2:"), "{lines}");
}

fn property<'a>(node: &'a Node, name: &str) -> &'a Property {
    node.properties
        .iter()
        .find(|p| p.name == name)
        .unwrap_or_else(|| panic!("no property `{name}`"))
}

fn children(node: &Node) -> Vec<Arc<Node>> {
    node.properties
        .iter()
        .filter_map(|p| match &p.value {
            Value::Object(child) => Some(child.clone()),
            _ => None,
        })
        .collect()
}

fn matrix(operations: &str) -> DMat4 {
    let scene = scene(&format!(
        "<shape type='cube'><transform name='to_world'>{operations}</transform></shape>"
    ));
    match property(&children(&scene.root)[0], "to_world").value {
        Value::Transform(m) => m,
        ref other => panic!("{other:?}"),
    }
}

#[test]
fn every_object_tag_has_its_class() {
    let classes = [
        ("bsdf", Class::Bsdf),
        ("emitter", Class::Emitter),
        ("film", Class::Film),
        ("integrator", Class::Integrator),
        ("medium", Class::Medium),
        ("phase", Class::Phase),
        ("rfilter", Class::ReconstructionFilter),
        ("sampler", Class::Sampler),
        ("sensor", Class::Sensor),
        ("shape", Class::Shape),
        ("subsurface", Class::Subsurface),
        ("texture", Class::Texture),
        ("spectrum", Class::Texture),
        ("volume", Class::Volume),
    ];
    for (tag, class) in classes {
        let scene = scene(&format!("<{tag} type='t' id='i' name='n'/>"));
        assert_eq!(scene.root.class, Class::Scene);
        let child = &children(&scene.root)[0];
        assert_eq!((child.class, child.plugin.value.as_str()), (class, "t"));
        assert_eq!(child.id.as_deref(), Some("i"));
        assert_eq!(scene.root.properties[0].name, "n");
    }
}

#[test]
fn every_property_tag_has_its_value() {
    let scene = scene(
        "<bsdf type='x'>
           <float name='f' value=' 1.5e1 '/> <integer name='i' value='-3'/>
           <boolean name='b' value='TRUE'/> <string name='s' value='a b'/>
           <point name='p' x='1' y='2' z='3'/> <vector name='v' value='1, 2 3'/>
           <vector name='w' value='2'/>
           <rgb name='grey' value='0.5'/> <rgb name='rgb' value='0.1,0.2 0.3'/>
           <spectrum name='u' value='0.25'/>
           <spectrum name='l' value='400:0.1, 500:0.2 700:1e-1'/>
         </bsdf>",
    );
    let node = &children(&scene.root)[0];
    let value = |name| &property(node, name).value;
    assert!(matches!(value("f"), Value::Float(15.0)));
    assert!(matches!(value("i"), Value::Integer(-3)));
    assert!(matches!(value("b"), Value::Boolean(true)));
    assert!(matches!(value("s"), Value::String(s) if s == "a b"));
    assert!(matches!(value("p"), Value::Vector(v) if *v == DVec3::new(1.0, 2.0, 3.0)));
    assert!(matches!(value("v"), Value::Vector(v) if *v == DVec3::new(1.0, 2.0, 3.0)));
    assert!(matches!(value("w"), Value::Vector(v) if *v == DVec3::splat(2.0)));
    assert!(matches!(value("grey"), Value::Rgb(v) if *v == DVec3::splat(0.5)));
    assert!(matches!(value("rgb"), Value::Rgb(v) if *v == DVec3::new(0.1, 0.2, 0.3)));
    assert!(matches!(
        value("u"),
        Value::Spectrum(SpectrumText::Uniform(0.25))
    ));
    assert!(
        matches!(value("l"), Value::Spectrum(SpectrumText::Samples(s))
        if s[..] == [(400.0, 0.1), (500.0, 0.2), (700.0, 0.1)])
    );
}

#[test]
fn spectra_come_from_files_beside_the_scene() {
    let main = "<scene version='3.0.0'><include filename='sub/inc.xml'/></scene>";
    let inc = "<scene version='3.0.0'><bsdf type='diffuse'>
        <spectrum name='reflectance' filename='a.spd'/></bsdf></scene>";
    let spd = "# wavelength value\n400 0.5\n\n500.5 1\n";
    let files = [("main.xml", main), ("sub/inc.xml", inc), ("sub/a.spd", spd)];
    let scene = document(outcome(&files, &ReadOptions::default()));
    let node = &children(&scene.root)[0];
    assert!(matches!(&property(node, "reflectance").value,
        Value::Spectrum(SpectrumText::Samples(s)) if s[..] == [(400.0, 0.5), (500.5, 1.0)]));
    let names: Vec<_> = scene.files.iter().map(|f| f.path.file_name()).collect();
    assert_eq!(names.len(), 3);
    let last = scene.search.folders().last().expect("folders");
    assert!(
        last.ends_with("sub"),
        "folders of included files are searched"
    );
}

#[test]
fn transforms_multiply_from_the_left() {
    // Compared with the matrices of Mitsuba 3.9.1's parser.
    let m = matrix("<rotate y='1' angle='90'/><translate x='1'/>");
    assert!((m.w_axis.x - 1.0).abs() < 1e-12 && m.w_axis.z.abs() < 1e-12);
    let m = matrix("<translate x='1'/><rotate y='1' angle='90'/>");
    assert!(m.w_axis.x.abs() < 1e-12 && (m.w_axis.z + 1.0).abs() < 1e-12);
    let m = matrix("<scale value='2'/><scale x='3'/>");
    assert_eq!(m, DMat4::from_scale(DVec3::new(6.0, 2.0, 2.0)));
    let m = matrix("<translate value='1 2 3'/><translate/>");
    assert_eq!(m.w_axis.truncate(), DVec3::new(1.0, 2.0, 3.0));
    assert_eq!(matrix(""), DMat4::IDENTITY);
    let m = matrix("<matrix value='1 2 3 4 5 6 7 8 9 10 11 12 0 0 0 1'/>");
    assert_eq!(m.row(1).to_array(), [5.0, 6.0, 7.0, 8.0]);
    let m = matrix("<lookat origin='0 0 0' target='0,0,-1'/>");
    assert_eq!(m.col(1).truncate(), DVec3::X);
}

#[test]
fn references_share_one_node_and_may_come_first() {
    let scene = scene(
        "<shape type='cube'><ref id='red' name='bsdf'/></shape>
         <shape type='sphere'><ref id='also'/></shape>
         <alias id='red' as='also'/> <bsdf type='diffuse' id='red'/>",
    );
    let shapes = children(&scene.root);
    let (a, b) = (&children(&shapes[0])[0], &children(&shapes[1])[0]);
    assert!(Arc::ptr_eq(a, b) && Arc::ptr_eq(a, &shapes[2]));
    assert_eq!(shapes[0].properties[0].name, "bsdf");
}

#[test]
fn parameters_come_from_defaults_and_the_command_line() {
    let main = r"<scene version='3.0.0'><default name='spp' value='4'/>
        <default name='t' value='independent'/><default name='spp' value='9'/>
        <sampler type='$t'><integer name='sample_count' value='$spp'/>
        <string name='s' value='\$t $spp$t'/></sampler></scene>";
    let options = ReadOptions {
        defines: vec![("spp".into(), "16".into())],
        ..ReadOptions::default()
    };
    let plain = document(outcome(&[("main.xml", main)], &ReadOptions::default()));
    let sampler = &children(&plain.root)[0];
    assert_eq!(sampler.plugin.value, "independent");
    assert!(matches!(
        property(sampler, "sample_count").value,
        Value::Integer(4)
    ));
    assert!(matches!(&property(sampler, "s").value, Value::String(s) if s == "$t 4independent"));
    let defined = document(outcome(&[("main.xml", main)], &options));
    let sampler = &children(&defined.root)[0];
    assert!(matches!(
        property(sampler, "sample_count").value,
        Value::Integer(16)
    ));
}

#[test]
fn includes_add_their_children_in_place() {
    let main = "<scene version='3.0.0'><path value='more'/><shape type='a'/>
        <include filename='i.xml'/><include filename='b.xml' name='named'/><shape type='c'/>
        <string name='x' value='$p'/></scene>";
    let i = "<scene version='0.6.0'><default name='p' value='q'/>
        <shape type='b'><float name='intIOR' value='2'/></shape><ref id='one'/></scene>";
    let b = "<bsdf version='3.0.0' type='diffuse' id='one'/>";
    let files = [("main.xml", main), ("more/i.xml", i), ("more/b.xml", b)];
    let scene = document(outcome(&files, &ReadOptions::default()));
    let nodes = children(&scene.root);
    let plugins: Vec<_> = nodes.iter().map(|n| n.plugin.value.as_str()).collect();
    assert_eq!(plugins, ["a", "b", "diffuse", "diffuse", "c"]);
    assert!(matches!(
        property(&nodes[1], "int_ior").value,
        Value::Float(2.0)
    ));
    assert!(Arc::ptr_eq(&nodes[2], &nodes[3]));
    assert!(matches!(
        property(&scene.root, "named").value,
        Value::Object(_)
    ));
}

#[test]
fn old_versions_are_upgraded() {
    let main = "<scene version='0.6.0'><bsdf type='diffuse'>
        <texture type='bitmap' name='diffuseReflectance'>
        <float name='uscale' value='2'/><float name='voffset' value='3'/>
        <float name='vscale' value='5'/><string name='wrapMode' value='clamp'/></texture></bsdf>
        <sensor type='perspective'><transform name='toWorld'>
        <lookAt origin='0 0 0' target='0 0 1' up='0 1 0'/></transform></sensor></scene>";
    let scene = document(outcome(&[("main.xml", main)], &ReadOptions::default()));
    let nodes = children(&scene.root);
    let Value::Object(texture) = &property(&nodes[0], "reflectance").value else {
        panic!("a texture");
    };
    // Scale after translation, as Mitsuba 3.9.1's parser prints it.
    let Value::Transform(m) = property(texture, "to_uv").value else {
        panic!("a transform");
    };
    assert_eq!(m.row(0).to_array(), [2.0, 0.0, 0.0, 0.0]);
    assert_eq!(m.row(1).to_array(), [0.0, 5.0, 0.0, 15.0]);
    property(texture, "wrap_mode");
    property(&nodes[1], "to_world");
}

#[test]
fn the_innermost_integrator_can_be_replaced() {
    let main = "<scene version='3.0.0'><integrator type='moment'><integrator type='aov'>
        <string name='aovs' value='d:depth'/><integrator type='unknown'>
        <integer name='max_depth' value='3'/><boolean name='guide' value='true'/>
        </integrator></integrator></integrator></scene>";
    let options = ReadOptions {
        integrator: Some("direct".into()),
        ..ReadOptions::default()
    };
    let scene = document(outcome(&[("main.xml", main)], &options));
    let moment = &children(&scene.root)[0];
    let aov = &children(moment)[0];
    let inner = &children(aov)[0];
    let plugins = [moment, aov, inner].map(|n| n.plugin.value.as_str());
    assert_eq!(plugins, ["moment", "aov", "direct"]);
    assert_eq!(aov.properties.len(), 2);
    assert_eq!(inner.properties.len(), 1);
    assert!(property(inner, "max_depth").is_used());

    let empty = "<scene version='3.0.0'/>";
    let scene = document(outcome(&[("main.xml", empty)], &options));
    assert_eq!(children(&scene.root)[0].plugin.value, "direct");
}

#[test]
fn several_mistakes_are_reported_in_one_run() {
    let main = "<scene version='3.0.0'>
  <bsdf type='diffuse'><float name='a' value='x'/></bsdf>
  <shap type='cube'/>
  <shape type='cube'><ref id='nothing'/></shape>
  <integer name='n' value='$n'/>
</scene>";
    let outcome = outcome(&[("main.xml", main)], &ReadOptions::default());
    assert_eq!(outcome.diagnostics.len(), 4, "{}", outcome.lines());
    assert!(
        outcome.document.is_some(),
        "further mistakes can be looked for"
    );
    assert!(outcome.sound().is_none());
}

#[test]
fn spans_lead_to_names_and_values() {
    let main = "<scene version='3.0.0'>\n<bsdf type='diffuse' name='b'>
        <rgb  name='reflectance' value='1, 2, 3'/><point name='p' x='1' y='22' z='3'/>
        <transform name='t'/></bsdf></scene>";
    let outcome = outcome(&[("main.xml", main)], &ReadOptions::default());
    let text = |span: etalon_params::Span| {
        outcome.sources.text(span.file)[span.start as usize..span.end as usize].to_owned()
    };
    let scene = outcome.sound().expect("no mistakes");
    let bsdf = &scene.root.properties[0];
    assert_eq!(
        (text(bsdf.name_span), text(bsdf.span)),
        ("b".into(), "diffuse".into())
    );
    let node = &children(&scene.root)[0];
    let rgb = property(node, "reflectance");
    assert_eq!(
        (text(rgb.name_span), text(rgb.span)),
        ("reflectance".into(), "1, 2, 3".into())
    );
    assert_eq!(text(property(node, "p").span), "1' y='22' z='3");
    assert_eq!(text(property(node, "t").span), "<transform");
    assert!(text(node.span).starts_with("<bsdf") && text(node.span).ends_with("</bsdf>"));
    assert_eq!(text(node.plugin.span), "diffuse");
}

#[test]
fn after_a_mistake_a_harmless_value_stands_in() {
    let main = "<scene version='3.0.0'><shape type='obj' idd='x' id='broken'>
        <string name='filename' value='$file'/><float name='radius'/>
        <rgb name='c' value='a b c'/><ref id='typeless'/></shape>
        <bsdf id='typeless'/><shape type='cube'><ref id='typeless'/></shape></scene>";
    let outcome = outcome(&[("main.xml", main)], &ReadOptions::default());
    assert_eq!(outcome.diagnostics.len(), 5, "{}", outcome.lines());
    let document = outcome.document.as_ref().expect("a document with mistakes");
    let shape = &children(&document.root)[0];
    assert!(matches!(&property(shape, "filename").value, Value::String(s) if s.is_empty()));
    assert!(matches!(property(shape, "radius").value, Value::Float(1.0)));
    assert!(matches!(property(shape, "c").value, Value::Rgb(_)));
    assert!(children(shape).is_empty());
    for name in ["filename", "radius", "c"] {
        assert!(outcome.stand_ins.contains(&property(shape, name).span));
    }
    // Neither shape is to blame for the material that it lost.
    for shape in children(&document.root) {
        assert!(outcome.stand_ins.contains(&shape.plugin.span));
    }
    assert_eq!(outcome.stand_ins.len(), 5);
}
