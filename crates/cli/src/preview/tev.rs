//! Sends a picture to `tev`, the viewer of Thomas Müller, while it renders.
//!
//! It listens on a port of its own (14158); pictures go there in bands of rows, each an update of its image.

use etalon_film::{Glance, SAMPLES};
use etalon_images::Image;
use etalon_render::watcher::Watcher;
use std::net::TcpStream;
use std::sync::{Mutex, PoisonError};
use tev_client::{PacketCreateImage, PacketUpdateImage, TevClient};

/// Where `tev` listens.
pub const ADDRESS: &str = "127.0.0.1:14158";

/// Rows of a band.
const ROWS: usize = 64;

/// A viewer that listens.
pub struct Tev {
    /// Without it, it has gone.
    state: Mutex<State>,
    /// The name of the image.
    name: String,
    /// Hears, once, why nothing is sent any more.
    failed: fn(&str),
}

struct State {
    client: Option<TevClient>,
    /// Size and channels of the image that it has.
    made: Option<([usize; 2], Vec<String>)>,
}

impl std::fmt::Debug for Tev {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Tev")
            .field("name", &self.name)
            .finish_non_exhaustive()
    }
}

impl Tev {
    /// Connects to the viewer at `address`, for an image of this name.
    ///
    /// # Errors
    /// One sentence, if there is no listener.
    pub fn connect(address: &str, name: String, failed: fn(&str)) -> Result<Self, String> {
        let socket = TcpStream::connect(address).map_err(|error| {
            format!("no `tev` listens at {address}: {error}; start it first, or name its address with `--tev HOST:PORT`")
        })?;
        let state = State {
            client: Some(TevClient::wrap(socket)),
            made: None,
        };
        Ok(Self {
            state: Mutex::new(state),
            name,
            failed,
        })
    }

    /// Sends a picture.
    pub fn send(&self, image: &Image) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let size = [image.width(), image.height()];
        let channels: Vec<_> = image
            .channels()
            .iter()
            .filter(|c| c.name != SAMPLES)
            .collect();
        let names: Vec<String> = channels
            .iter()
            .map(|channel| channel.name.clone())
            .collect();
        let planes: Vec<&[f32]> = channels
            .iter()
            .map(|channel| channel.samples.as_slice())
            .collect();
        let made = (size, names);
        let is_new = state.made.as_ref() != Some(&made);
        let Some(client) = &mut state.client else {
            return;
        };
        if let Err(error) = sent(client, &self.name, is_new, &made, &planes) {
            state.client = None;
            (self.failed)(&error.to_string());
            return;
        }
        state.made = Some(made);
    }
}

fn sent(
    client: &mut TevClient,
    name: &str,
    is_new: bool,
    ([width, height], names): &([usize; 2], Vec<String>),
    planes: &[&[f32]],
) -> std::io::Result<()> {
    if is_new {
        client.send(PacketCreateImage {
            image_name: name,
            grab_focus: true,
            width: *width as u32,
            height: *height as u32,
            channel_names: names,
        })?;
    }
    for first in (0..*height).step_by(ROWS) {
        let rows = ROWS.min(height - first);
        let pixels = rows * width;
        let mut data = Vec::with_capacity(pixels * planes.len());
        for plane in planes {
            data.extend_from_slice(&plane[first * width..][..pixels]);
        }
        let offsets: Vec<u64> = (0..planes.len())
            .map(|plane| (plane * pixels) as u64)
            .collect();
        client.send(PacketUpdateImage {
            image_name: name,
            grab_focus: false,
            channel_names: names,
            channel_offsets: &offsets,
            channel_strides: &vec![1; planes.len()],
            x: 0,
            y: first as u32,
            width: *width as u32,
            height: rows as u32,
            data: &data,
        })?;
    }
    Ok(())
}

impl Watcher for Tev {
    fn see(&self, glance: Glance) {
        self.send(&glance.image);
    }
}
