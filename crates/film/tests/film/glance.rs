//! What somebody sees who looks on while a picture is rendered.

use etalon_film::{BoxFilter, ExactFilm, FilmSettings, Filter};
use etalon_transport::{Film, Sink, TileSink};
use glam::UVec2;

const SIZE: UVec2 = UVec2::new(9, 6);

fn film() -> ExactFilm {
    let settings = FilmSettings::new(SIZE.x, SIZE.y, Filter::Box(BoxFilter));
    ExactFilm::new(settings, &[]).expect("it is sound")
}

/// Gives every pixel that is wanted one more sample.
fn add(film: &ExactFilm, wanted: impl Fn(u32, u32) -> bool, value: impl Fn(u32, u32) -> f32) {
    let mut tile = film.tile(UVec2::ZERO, SIZE, true);
    for y in 0..SIZE.y {
        for x in (0..SIZE.x).filter(|&x| wanted(x, y)) {
            tile.begin_sample(UVec2::new(x, y), 1.0);
            tile.radiance([value(x, y); 3], 1.0);
        }
    }
}

#[test]
fn nothing_is_seen_before_the_first_sample() {
    assert!(film().glance(4).is_none());
}

/// After a coarse round every pixel shows its neighbour to the upper left.
#[test]
fn a_coarse_round_fills_the_picture() {
    let mut film = film();
    add(
        &film,
        |x, y| x % 4 == 0 && y % 4 == 0,
        |x, y| (10 * y + x) as f32,
    );
    let glance = film.glance(4).expect("there are samples");
    assert_eq!((glance.replicates, glance.samples), (0, 6.0 / 54.0));
    let green = glance.image.channel("G").expect("it has colours");
    for y in 0..SIZE.y {
        for x in 0..SIZE.x {
            let expected = (10 * (y / 4 * 4) + x / 4 * 4) as f32;
            assert_eq!(green[(y * SIZE.x + x) as usize], expected, "{x} {y}");
        }
    }
}

/// With one finished replicate of mean 1 and half of another of mean 4, a pixel shows (1 + 4/2) / 1.5 = 2; looking changes nothing.
#[test]
fn the_running_replicate_counts_by_how_far_it_is() {
    let mut film = film();
    let all = |_: u32, _: u32| true;
    for _ in 0..4 {
        add(&film, all, |_, _| 1.0);
    }
    film.end_replicate(4);
    assert_eq!(
        film.glance(4).map(|g| (g.replicates, g.samples)),
        Some((1, 4.0))
    );
    for _ in 0..2 {
        add(&film, all, |_, _| 4.0);
    }
    let seen = film.glance(4).expect("there are samples");
    assert_eq!((seen.replicates, seen.samples), (1, 6.0));
    assert!(
        seen.image
            .channel("R")
            .expect("it has colours")
            .iter()
            .all(|&x| x == 2.0)
    );
    assert!(seen.image.channel("standard_error.R").is_none());
    for _ in 0..2 {
        add(&film, all, |_, _| 4.0);
    }
    film.end_replicate(4);
    let end = film.glance(4).expect("there are samples");
    assert!(
        end.image
            .channel("R")
            .expect("it has colours")
            .iter()
            .all(|&x| x == 2.5)
    );
    let error = end
        .image
        .channel("standard_error.R")
        .expect("of two replicates");
    assert!(error.iter().all(|&x| x == 1.5), "{error:?}");
}
