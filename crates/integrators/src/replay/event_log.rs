//! What has been said so far, and which walk it belongs to.

use super::{Event, Gathered};
use crate::steps::path_throughput::PathThroughput;
use etalon_spectrum::{SensorWeights, Wavelengths};
use etalon_transport::{
    BsdfSample, ChainRemark, Mixed, Mixture, ShapeId, SurfaceInteraction, TraceEvent,
};
use glam::{Vec3, Vec4};
use std::sync::{Mutex, PoisonError};

/// What has been said so far.
#[derive(Default)]
pub(super) struct EventLog {
    events: Vec<Event>,
    walks: Vec<PathState>,
    met: Vec<Met>,
    /// The direction that a scattering model was asked for last, and where.
    asked: Option<(Vec3, Place)>,
    /// Whether photons are being gathered: they are noted, and not what is asked for their sake.
    gathering: bool,
    /// What the camera's ray counts.
    weight: f32,
}

/// A walk from surface to surface.
struct PathState {
    /// Value and densities; `None` where the estimator drew a direction by itself.
    prefix: Option<PathThroughput>,
    /// Where it goes next.
    direction: Vec3,
}

/// A walk's arrival at a surface.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) walk: usize,
    pub(super) prefix: Option<PathThroughput>,
}

/// A surface that was met.
struct Met {
    position: Vec3,
    shape: ShapeId,
    place: Option<Place>,
}

impl EventLog {
    /// Notes an event.
    pub(super) fn note(&mut self, event: Event) {
        if !self.gathering {
            self.events.push(event);
        }
    }

    /// Everything that happened.
    pub(super) fn take_events(&mut self) -> Vec<Event> {
        core::mem::take(&mut self.events)
    }

    /// Begins a walk that counts so much and goes along a direction.
    pub(super) fn begin(&mut self, value: Vec4, direction: Vec3) -> usize {
        let mut prefix = PathThroughput::START;
        prefix.beta = value;
        let prefix = Some(prefix);
        self.walks.push(PathState { prefix, direction });
        self.walks.len() - 1
    }

    /// Begins a walk of the camera.
    pub(super) fn begin_at_camera(&mut self, weight: f32, direction: Vec3) -> usize {
        self.weight = weight;
        self.begin(Vec4::splat(weight), direction)
    }

    /// The walk that goes along a direction: sampled, or else only asked for.
    pub(super) fn along(&mut self, direction: Vec3) -> Option<Place> {
        let sampled = self.walks.iter().rposition(|w| w.direction == direction);
        let walk = sampled.or_else(|| {
            let (_, place) = self.asked.filter(|(wi, _)| *wi == direction)?;
            self.walks[place.walk] = PathState {
                prefix: None,
                direction,
            };
            Some(place.walk)
        })?;
        let prefix = self.walks[walk].prefix;
        Some(Place { walk, prefix })
    }

    /// A surface was met along a direction.
    pub(super) fn shade(&mut self, vertex: &SurfaceInteraction, direction: Vec3) {
        let place = self.along(direction);
        self.met.push(Met {
            position: vertex.position,
            shape: vertex.shape,
            place,
        });
        self.note(Event::SurfaceInteraction {
            walk: place.map(|place| place.walk),
            vertex: Box::new(*vertex),
            prefix: place.and_then(|place| place.prefix),
        });
    }

    /// The arrival of a walk at a surface.
    pub(super) fn place(&self, vertex: &SurfaceInteraction) -> Option<Place> {
        let mut met = self.met.iter().rev();
        met.find(|met| met.position == vertex.position && met.shape == vertex.shape)
            .and_then(|met| met.place)
    }

    /// A scattering model was asked for a direction.
    pub(super) fn ask(&mut self, place: Option<Place>, wi: Vec3, event: Event) {
        if !self.gathering {
            self.asked = place.map(|place| (wi, place));
            self.events.push(event);
        }
    }

    /// A direction was found that leads on from a place, or none.
    pub(super) fn scatter(&mut self, place: Option<Place>, event: Event) {
        if self.gathering {
            return;
        }
        if let (Some(Place { walk, prefix }), Event::Scattered { sample, .. }) = (place, &event)
            && let Some(sample) = sample
        {
            let direction = sample.wi;
            self.walks[walk] = PathState { prefix, direction };
        }
        self.events.push(event);
    }

    /// What a scattering model was asked last was for a mixture.
    pub(super) fn mix(&mut self, place: Option<Place>, mixture: Mixture) {
        match (mixture.mixed, self.events.last_mut()) {
            (Mixed::Weighed(_), Some(Event::Evaluated { mixture: noted, .. })) => {
                *noted = Some(mixture);
            }
            (
                Mixed::Sampled { sample, .. },
                Some(Event::Evaluated { .. } | Event::Scattered { .. }),
            ) => {
                // In place of what the model said of it alone.
                self.events.pop();
                let place = place.map(|place| place.extended(sample.as_ref()));
                self.scatter(
                    place,
                    Event::Scattered {
                        walk: place.map(|place| place.walk),
                        sample,
                        prefix: place.and_then(|place| place.prefix),
                        mixture: Some(mixture),
                    },
                );
            }
            _ => {}
        }
    }

    /// The estimator remarks something.
    pub(super) fn record(
        &mut self,
        remark: TraceEvent,
        sensor: impl Fn(&Wavelengths) -> SensorWeights,
    ) {
        match remark {
            TraceEvent::Wavelengths(wavelengths) => {
                let event = Event::Wavelengths(wavelengths);
                let drawn = |event: &Event| matches!(event, Event::Wavelengths(_));
                match self.events.iter().rposition(drawn) {
                    Some(place) => self.events[place] = event,
                    None => self.note(event),
                }
            }
            TraceEvent::Gathering { radius, among } => {
                self.gathering = true;
                self.events.push(Event::Photons {
                    radius,
                    among,
                    photons: Vec::new(),
                });
            }
            TraceEvent::Photon(photon) => {
                let rgb = sensor(&photon.wavelengths)
                    .rgb(photon.estimate * self.weight)
                    .to_array();
                if photon.estimate != Vec4::ZERO
                    && let Some(Event::Photons { photons, .. }) = self.events.last_mut()
                {
                    photons.push(Gathered { photon, rgb });
                }
            }
            TraceEvent::Gathered => self.gathering = false,
            TraceEvent::Technique { light, camera } => self.note(Event::Technique(light, camera)),
            TraceEvent::Chain(remark) => {
                if let ChainRemark::Uniform(_)
                | ChainRemark::Begins { .. }
                | ChainRemark::Proposal { .. } = remark
                {
                    // Another path, whose walks are its own.
                    self.walks.clear();
                    self.met.clear();
                    self.asked = None;
                }
                self.note(Event::Chain(remark));
            }
        }
    }
}

impl Place {
    /// Value and densities after a direction was sampled there.
    pub(super) fn extended(mut self, sample: Option<&BsdfSample>) -> Self {
        if let (Some(prefix), Some(sample)) = (&mut self.prefix, sample) {
            prefix.scatter(sample.value, sample.chance.lanes());
        }
        self
    }
}

/// A notebook that many may write to.
#[derive(Default)]
pub(super) struct SharedEventLog(Mutex<EventLog>);

impl SharedEventLog {
    /// Changes the notes.
    pub(super) fn write<T>(&self, change: impl FnOnce(&mut EventLog) -> T) -> T {
        change(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Notes an event.
    pub(super) fn note(&self, event: Event) {
        self.write(|notes| notes.note(event));
    }

    /// Everything that happened.
    pub(super) fn take_events(&self) -> Vec<Event> {
        self.write(EventLog::take_events)
    }
}
