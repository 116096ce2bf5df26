//! Pictures in a browser: while they render (`render --preview`) and when they are finished (`etalon view`).
//!
//! A page on this machine's loopback address asks for the state ([`feed`]) a few times a second and for the numbers of a picture
//! when there are new ones; exposure, zoom and maps are the page's own affair. Nothing is fetched from elsewhere, and requests that name
//! another host are refused. [`tev`] shows the same in Thomas Müller's viewer.

pub mod feed;
mod layers;
mod onlookers;
mod server;
pub mod tev;

pub use feed::Feed;
pub use layers::shown;
pub use onlookers::Onlookers;

use std::sync::Arc;

/// The port that is taken where none is asked for.
pub const PORT: u16 = 8750;

/// Shows a feed on a port of 127.0.0.1 from now on until the program ends: the one that was asked for, or else [`PORT`], or else
/// any that is free. Gives the address of the page.
///
/// # Errors
/// One sentence, if the port cannot be had.
pub fn open(feed: &Arc<Feed>, port: Option<u16>) -> Result<String, String> {
    let server = match port {
        Some(port) => server::listen(port),
        None => server::listen(PORT).or_else(|_| server::listen(0)),
    };
    let (server, port) = server.map_err(|error| {
        let port = port.unwrap_or(PORT);
        format!(
            "nothing can be shown on port {port} of 127.0.0.1: {error}; another one may be free"
        )
    })?;
    server::serve(server, port, feed);
    Ok(format!("http://127.0.0.1:{port}/"))
}
