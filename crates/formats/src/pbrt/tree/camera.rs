//! Cameras (`cameras.cpp`).
//!
//! pbrt's camera looks along +z with +y up and +x to the right, and its CTM leads from the world to the camera; Mitsuba's has +x to the left.
//! So `to_world` = CTM⁻¹ · diag(−1, 1, 1).
//!
//! The screen is a window of the plane at z = 1 in units in which the shorter side of the film reaches from −1 to 1, or what
//! `screenwindow` says; ±1 is seen at half of `fov`. Mitsuba's `fov` with the axis `smaller` is the same, and another window becomes the `fov`
//! of x and an offset of the principal point. An orthographic camera of pbrt sees the window itself, Mitsuba's x from −1 to 1: the
//! rest goes into `to_world`. With a lens, pbrt's orthographic camera sends its rays from one lens about the origin through the window at
//! `focaldistance` (`OrthographicCamera::GenerateRay`), as a perspective camera does whose window is there.
//!
//! pbrt's lens is in camera space, whose lengths an even scale in the CTM changes; Mitsuba's cameras have none, so the lengths are
//! multiplied instead.
//!
//! Nothing is too near or too far for pbrt, so the clipping planes go as far as numbers allow that are multiplied afterwards.

use super::super::parameters::Parameters;
use super::super::scene::Scene;
use super::Mapper;
use super::film::MappedFilm;
use super::node::{Draft, given, word};
use super::placement::placed;
use etalon_math::float64;
use etalon_params::{Class, DMat4, DVec3, Diagnostics, Node, Span, SpectrumText, Value};
use glam::DVec4;
use std::sync::Arc;

/// The distances between which things are seen.
const CLIP: [f64; 2] = [1e-4, 1e12];

/// By how much pixels may be longer than wide for them to count as squares.
const SQUARE: f64 = 1e-4;

/// By how much, of its size, a scale may differ from that along other axes, or from 1, to count as the same.
const EVEN: f64 = 1e-5;

/// The part of the plane z = 1 that is seen: [first, last] of x and of y.
type Window = [[f64; 2]; 2];

/// When the shutter opens and closes.
pub(crate) fn shutter(scene: &Scene) -> [f64; 2] {
    // Mistakes are reported where the camera is read.
    let aside = Diagnostics::new();
    let params = scene.parameters(&scene.camera.entity, &aside);
    [("shutteropen", 0.0), ("shutterclose", 1.0)].map(|(name, at)| params.float(name, at))
}

impl Mapper<'_> {
    /// The sensor with film and sampler; `None` after a mistake.
    pub(crate) fn sensor(&mut self) -> Option<Arc<Node>> {
        let scene = self.scene;
        let params = self.read(&scene.camera.entity);
        let kind = params.entity.kind;
        let film = self.film();
        let sampler = self.sampler(self.samples_of_integrator());
        if kind == "realistic" {
            self.refuse(&params, "camera", "perspective, orthographic, spherical");
            return None;
        }
        let [open, close] = self.shutter_of(&params);
        let film = film?;
        let draft = match kind {
            "spherical" => self.spherical(&params),
            _ => match (self.screen(&params, &film), kind) {
                (Some(window), "perspective") => self.perspective(&params, window),
                (Some(window), _) => self.orthographic(&params, window),
                (None, _) => None,
            },
        };
        params.finish();
        let medium = scene.camera.medium.map(|medium| self.medium(medium));
        let mut draft = draft?;
        for (name, limit) in ["near_clip", "far_clip"].into_iter().zip(CLIP) {
            draft = draft.plain(name, Value::Float(limit));
        }
        if scene.camera.placement.is_animated() || self.anything_moves() {
            let times = [
                ("shutteropen", "shutter_open", open),
                ("shutterclose", "shutter_close", close),
            ];
            for (source, name, time) in times {
                draft = draft.from(&params, source, name, Value::Float(time));
            }
        }
        let exposure = film.gain * (close - open);
        if exposure != 1.0 {
            let response = Value::Spectrum(SpectrumText::Uniform(exposure));
            draft = draft.with("srf", response, film.node.span);
        }
        if let Some(medium) = medium {
            draft = draft.child(medium?);
        }
        Some(draft.child(film.node).child(sampler).node())
    }

    fn shutter_of(&self, params: &Parameters<'_>) -> [f64; 2] {
        let open = params.float("shutteropen", 0.0);
        let what = "a finite time after the shutter opens";
        let later = |close: f64| close > open && close.is_finite();
        let close = params.float_where("shutterclose", 1.0, what, later);
        [open, close]
    }

    /// Whether a shape or an instance moves: only then does it matter to the picture when the shutter is open.
    fn anything_moves(&self) -> bool {
        let scene = self.scene;
        let in_objects = scene.objects.iter().flat_map(|object| &object.shapes);
        let shapes = scene.shapes.iter().chain(in_objects).map(|s| &s.placement);
        let nested = scene.objects.iter().flat_map(|object| &object.instances);
        let instances = scene.instances.iter().chain(nested).map(|i| &i.placement);
        shapes
            .chain(instances)
            .any(|placement| placement.is_animated())
    }

    /// The window of the screen, whose pixels must be squares.
    fn screen(&self, params: &Parameters<'_>, film: &MappedFilm) -> Option<Window> {
        let [width, height] = film.size.map(f64::from);
        let aspect = width / height;
        let frame =
            params.float_where("frameaspectratio", aspect, "a finite number above 0", |a| {
                a > 0.0 && a.is_finite()
            });
        let (source, window) = match params.floats_of::<4>("screenwindow") {
            Some(&[x0, x1, y0, y1]) => ("screenwindow", [[x0, x1], [y0, y1]]),
            None => {
                let reach = [frame.max(1.0), (1.0 / frame).max(1.0)];
                ("frameaspectratio", reach.map(|r| [-r, r]))
            }
        };
        let [[x0, x1], [y0, y1]] = window;
        if !(x1 > x0 && y1 > y0) {
            params.error_at(source, "the window of the screen is empty or upside down");
            return None;
        }
        let stretch = (x1 - x0) / (y1 - y0) / aspect;
        if !((stretch - 1.0).abs() < SQUARE) {
            let what = format!("pixels that are {stretch} times as wide as high");
            self.refuse_value(params, source, &what, "the aspect of the film's resolution");
            return None;
        }
        Some(window)
    }

    /// The radius of the lens, and the distance of what is sharp.
    fn lens(params: &Parameters<'_>) -> [f64; 2] {
        let radius = params.float_where("lensradius", 0.0, "a finite number from 0 on", |r| {
            r >= 0.0 && r.is_finite()
        });
        let focus = params.float_where("focaldistance", 1e6, "a finite number above 0", |d| {
            d > 0.0 && d.is_finite()
        });
        [radius, focus]
    }

    fn perspective(&self, params: &Parameters<'_>, window: Window) -> Option<Draft> {
        let fov = params.float_where("fov", 90.0, "degrees above 0 and below 180", |fov| {
            fov > 0.0 && fov < 180.0
        });
        let draft = self.through_lens(params, Self::lens(params))?;
        if !params.has("screenwindow") {
            let draft = draft.from(params, "fov", "fov", Value::Float(fov));
            return Some(draft.from(params, "fov", "fov_axis", word("smaller")));
        }
        // ±1 of the screen is seen at half of `fov`.
        let half = float64::tan(fov.to_radians() / 2.0);
        Some(seeing(params, draft, window, half))
    }

    /// A camera that sees by a lens or a point, without its field of view.
    fn through_lens(&self, params: &Parameters<'_>, [radius, focus]: [f64; 2]) -> Option<Draft> {
        let plugin = if radius > 0.0 {
            "thinlens"
        } else {
            "perspective"
        };
        let draft = Draft::of(params, Class::Sensor, plugin);
        // Lengths of the camera's space become those of the world.
        let length = self.scale_of_camera();
        let shrunk = DMat4::from_scale(DVec3::splat(1.0 / length));
        let mut draft = self.posed(
            draft,
            if length == 1.0 {
                DMat4::IDENTITY
            } else {
                shrunk
            },
        )?;
        let (radius, focus) = (radius * length, focus * length);
        if radius > 0.0 {
            draft = draft
                .from(
                    params,
                    "lensradius",
                    "aperture_radius",
                    Value::Float(radius),
                )
                .from(
                    params,
                    "focaldistance",
                    "focus_distance",
                    Value::Float(focus),
                );
        }
        Some(draft)
    }

    fn orthographic(&self, params: &Parameters<'_>, [x, y]: Window) -> Option<Draft> {
        let [radius, focus] = Self::lens(params);
        if radius > 0.0 {
            let draft = self.through_lens(params, [radius, focus])?;
            return Some(seeing(params, draft, [x, y], 1.0 / focus));
        }
        let middle = |[a, b]: [f64; 2]| 0.5 * (a + b);
        // In Mitsuba's camera space x runs to the left.
        let centre = DVec3::new(-middle(x), middle(y), 0.0);
        let half = 0.5 * (x[1] - x[0]);
        let window =
            DMat4::from_translation(centre) * DMat4::from_scale(DVec3::new(half, half, 1.0));
        let draft = Draft::of(params, Class::Sensor, "orthographic");
        self.posed(draft, window)
    }

    /// pbrt looks along (cos 2πu sin πv, cos πv, sin 2πu sin πv) at (u, v) of the film, Etalon along (sin 2πu sin πv, cos πv, −cos 2πu sin πv) of a
    /// space whose x runs to the left; the other mapping is the same in both.
    fn spherical(&self, params: &Parameters<'_>) -> Option<Draft> {
        // What pbrt has for all cameras with a screen.
        params.ignore(&[
            "lensradius",
            "focaldistance",
            "frameaspectratio",
            "screenwindow",
        ]);
        let mappings = ["equalarea", "equirectangular"];
        let mapping = params.choice("mapping", mappings[0], &mappings);
        let local = match mapping == mappings[0] {
            true => DMat4::IDENTITY,
            false => DMat4::from_cols(DVec4::Z, DVec4::Y, DVec4::X, DVec4::W),
        };
        let draft = Draft::of(params, Class::Sensor, "spherical");
        let draft = draft.from(params, "mapping", "mapping", word(mapping));
        self.posed(draft, local)
    }

    /// By how much a CTM scales camera space that scales it evenly and does not move, 1 for any other.
    fn scale_of_camera(&self) -> f64 {
        let placement = &self.scene.camera.placement;
        let Some(inverse) = placement.inverse().filter(|_| !placement.is_animated()) else {
            return 1.0;
        };
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        let lengths = axes.map(|axis| inverse.start.transform_vector3(axis).length());
        let mean = lengths.iter().sum::<f64>() / 3.0;
        let even = |length: &f64| (length / mean - 1.0).abs() < EVEN;
        match lengths.iter().all(even) && (mean - 1.0).abs() > EVEN {
            true => mean,
            false => 1.0,
        }
    }

    /// Adds `to_world`; `local` is within Mitsuba's camera space.
    fn posed(&self, draft: Draft, local: DMat4) -> Option<Draft> {
        // That it has an inverse was seen when the file was read.
        let inverse = self.scene.camera.placement.inverse()?;
        let local = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)) * local;
        let span: Span = draft.span();
        let to_world = self.to_world(&inverse, local, span)?;
        Some(placed(draft, given(to_world.value, span)))
    }
}

/// Adds the field of view of a window, whose ±1 is seen at angles of the tangent `half`; Etalon measures across the whole width.
fn seeing(params: &Parameters<'_>, draft: Draft, window: Window, half: f64) -> Draft {
    let [[x0, x1], [y0, y1]] = window;
    let across = 2.0 * float64::atan2(half * 0.5 * (x1 - x0), 1.0).to_degrees();
    let source = "screenwindow";
    let number = |draft: Draft, name, x| draft.from(params, source, name, Value::Float(x));
    let draft = number(draft, "fov", across).from(params, source, "fov_axis", word("x"));
    let draft = number(draft, "principal_point_offset_x", 0.5 + x0 / (x1 - x0));
    number(draft, "principal_point_offset_y", 0.5 - y1 / (y1 - y0))
}
