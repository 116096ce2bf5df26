//! Replicates that were rendered elsewhere, as references of other renderers are.

use crate::ExactFilm;
use crate::faults::FaultLog;
use crate::layout::Divisor;
use etalon_images::Image;
use glam::UVec2;

impl ExactFilm {
    /// Adds a replicate that was rendered elsewhere: an independent estimate of the whole crop,
    /// of `samples` per pixel, with one channel for each of [`ExactFilm::channels`].
    ///
    /// This is how other renderers' images, one per seed, become a reference with standard
    /// errors and tile means.
    ///
    /// # Errors
    /// If the image has another size or lacks a channel.
    pub fn add_replicate(&mut self, image: &Image, samples: u64) -> Result<(), String> {
        let [width, height] = self.settings().crop_size.to_array();
        let size = [image.width(), image.height()];
        if size != [width, height].map(|n| n as usize) {
            let [w, h] = size;
            return Err(format!(
                "the image has {w} × {h} pixels, not {width} × {height}"
            ));
        }
        let planes = self.channels().iter().map(|name| {
            let plane = image.channel(name);
            plane.ok_or_else(|| format!("the image has no channel `{name}`"))
        });
        let planes: Vec<&[f32]> = planes.collect::<Result<_, String>>()?;
        let mut log = FaultLog::default();
        for i in 0..size[0] * size[1] {
            let sums = self.running.of_pixel(i);
            for ((sum, plane), name) in sums.zip(&planes).zip(self.channels()) {
                if let Err(fault) = sum.add(plane[i]) {
                    let place = [i % size[0], i / size[0]].map(|n| n as u32);
                    let pixel = UVec2::from(place) + self.settings().crop_offset;
                    log.note(self.offence(pixel.as_ivec2(), None, name, fault));
                }
            }
        }
        self.report(log);
        self.finish_replicate(Divisor::Even(1), samples);
        Ok(())
    }
}
